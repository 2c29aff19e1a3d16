// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/equations.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/assembly/network.h>

namespace oblique::report {
namespace {

using network::Node;
using network::NodeId;
using network::Op;

/// Leaves of what stands in place where it is used several times; more than that has an equation of its own.
constexpr double kShortLeaves = 3;

/// Leaves beyond which a signal has an equation of its own though it is used once.
constexpr double kLongLeaves = 24;

/// A term of a sum: a number times factors over divisors, each as it is printed.
struct Monomial {
  double coefficient = 1;
  std::vector<std::string> factors, divisors;
};

/// A quantity of the circuit: `factor` times what is called `name`.
struct Quantity {
  std::string name;
  double factor = 1;
};

class EquationReader {
 public:
  EquationReader(const diagram::FlatDiagram& diagram, int digits)
      : network_(network::assemble(diagram)), digits_(digits) {
    name_variables(diagram);
    name_signals();
    count_leaves_and_uses(diagram);
    outputs(diagram);
  }

  std::vector<RecoveredEquation> read() {
    std::vector<RecoveredEquation> equations;
    for (std::size_t s = 0; s < network_.states.size(); ++s) {
      const network::State& state = network_.states[s];
      const Quantity& x = variables_[network_.state_variable(s)];
      const bool known = !state.start_node || state.start_constant;
      equations.push_back({fmt::format("der({})", x.name), sum_text(scaled(state.derivative, 1 / x.factor)),
                           known ? number(state.start / x.factor) : ""});
    }
    for (std::size_t u = 0; u < network_.unknowns.size(); ++u) {
      const network::Unknown& unknown = network_.unknowns[u];
      const Quantity& z = variables_[network_.unknown_variable(u)];
      std::vector<Monomial> terms = scaled(unknown.residual, 1 / z.factor);
      if (unknown.torn)
        terms.push_back({1, {z.name}, {}});  // the residual is what the block gives less itself
      equations.push_back(
          {unknown.torn ? z.name : "0", sum_text(merged(std::move(terms))), "", unknown.torn ? "" : z.name});
    }
    for (const auto& [name, node, scale, offset] : outputs_) {
      const bool own = apart_.contains(node);
      if (own) apart_.erase(node);
      std::vector<Monomial> terms = scaled(node, scale);
      if (own) apart_.insert(node);
      if (offset != 0) terms.push_back({offset, {}, {}});
      equations.push_back({name, sum_text(terms), ""});
    }
    while (next_ < queue_.size()) {
      const NodeId node = queue_[next_++];
      apart_.erase(node);
      equations.push_back({names_.at(node).name, sum_text(scaled(node, 1 / names_.at(node).factor)), ""});
      apart_.insert(node);
    }
    return equations;
  }

 private:
  struct Output {
    std::string name;
    NodeId node;
    double scale, offset;
  };

  /// Time, states, unknowns; by the outputs that show them.
  void name_variables(const diagram::FlatDiagram& diagram) {
    variables_.push_back({"t", 1});
    for (const network::State& state : network_.states) variables_.push_back({state.name, 1});
    for (const network::Unknown& unknown : network_.unknowns) variables_.push_back({unknown.name, 1});
    std::set<std::size_t> shown;
    for (const diagram::FlatOutput& output : diagram.outputs) {
      const auto part = multiple_of_variable(node_of(output));
      if (!part || part->factor * output.scale == 0 || output.offset != 0) continue;
      if (shown.insert(part->variable).second)
        variables_[part->variable] = {output.name, 1 / (part->factor * output.scale)};
    }
  }

  struct Multiple {
    std::size_t variable;
    double factor;
  };

  /// What is a number times a state or an unknown, as behind inverters and coefficients.
  std::optional<Multiple> multiple_of_variable(NodeId id) const {
    double factor = 1;
    for (;;) {
      const Node& node = network_.graph[id];
      const auto value = [&](NodeId operand) { return network_.graph[operand].value; };
      if (node.op == Op::variable && node.variable != 0) return Multiple{node.variable, factor};
      if (node.op == Op::negate) {
        factor = -factor;
        id = node.a;
      } else if (node.op == Op::multiply && network_.graph.is_constant(node.a)) {
        factor *= value(node.a);
        id = node.b;
      } else if ((node.op == Op::multiply || node.op == Op::divide) && network_.graph.is_constant(node.b)) {
        factor = node.op == Op::divide ? factor / value(node.b) : factor * value(node.b);
        id = node.a;
      } else {
        return std::nullopt;
      }
    }
  }

  NodeId node_of(const diagram::FlatOutput& output) const {
    return network_.signals[network_.signal_index(output.signal)];
  }

  /// Signals that are no variables, by the blocks that make them.
  void name_signals() {
    for (std::size_t s = 0; s < network_.signals.size(); ++s) {
      const Op op = network_.graph[network_.signals[s]].op;
      if (op != Op::variable && op != Op::constant && op != Op::discrete_state)
        names_.emplace(network_.signals[s], Quantity{network_.signal_names[s], 1});
    }
  }

  /// What stands apart, in an equation of its own.
  void count_leaves_and_uses(const diagram::FlatDiagram& diagram) {
    std::vector<NodeId> roots;
    for (const network::State& state : network_.states) roots.push_back(state.derivative);
    for (const network::Unknown& unknown : network_.unknowns) roots.push_back(unknown.residual);
    for (const diagram::FlatOutput& output : diagram.outputs) roots.push_back(node_of(output));
    std::vector<int> uses(network_.graph.size(), 0);
    std::vector<bool> reached(network_.graph.size(), false);
    for (const NodeId root : roots) reached[root] = true;
    for (auto id = static_cast<NodeId>(network_.graph.size()); id-- > 0;) {
      if (!reached[id]) continue;
      const Node& node = network_.graph[id];
      for (int k = 0; k < network::operand_count(node.op); ++k) {
        reached[node.operand(k)] = true;
        ++uses[node.operand(k)];
      }
    }
    std::vector<double> leaves(network_.graph.size(), 1);
    for (NodeId id = 0; id < network_.graph.size(); ++id) {
      if (!reached[id]) continue;
      const Node& node = network_.graph[id];
      double sum = 0;
      for (int k = 0; k < network::operand_count(node.op); ++k) {
        if (network_.graph[node.operand(k)].op != Op::constant) sum += leaves[node.operand(k)];
      }
      leaves[id] = std::max(1.0, sum);
      const bool long_enough = uses[id] > 1 ? leaves[id] > kShortLeaves : leaves[id] > kLongLeaves;
      if (!names_.contains(id) && uses[id] > 1 && leaves[id] > kLongLeaves)
        names_.emplace(id, Quantity{fmt::format("u{}", ++unnamed_), 1});
      if (!names_.contains(id) || !long_enough) continue;
      apart_.insert(id);
      leaves[id] = 1;
    }
  }

  /// Outputs that show no variable by itself; the first of a signal gives it its name.
  void outputs(const diagram::FlatDiagram& diagram) {
    for (const diagram::FlatOutput& output : diagram.outputs) {
      const NodeId id = node_of(output);
      if (const auto part = multiple_of_variable(id);
          part && output.offset == 0 && variables_[part->variable].name == output.name)
        continue;
      if (apart_.contains(id) && output.offset == 0 && output.scale != 0 && asked_.insert(id).second) {
        names_.at(id) = {output.name, 1 / output.scale};
        queue_.push_back(id);
      } else {
        outputs_.push_back({output.name, id, output.scale, output.offset});
      }
    }
  }

  std::string number(double value) const { return fmt::format("{:.{}g}", value == 0 ? 0.0 : value, digits_); }

  /// What a condition compares: "x - 3*y > 0.2".
  std::string condition_text(NodeId id) {
    const Node& node = network_.graph[id];
    if (node.op == Op::discrete_state) return switch_text(node.variable, true);
    const bool negated = node.op == Op::subtract && network_.graph.is_constant(node.a) &&
                         network_.graph[node.a].value == 1 && network_.graph[node.b].op == Op::discrete_state;
    return negated ? switch_text(network_.graph[node.b].variable, false) : node_text(id);
  }

  /// The comparison that turns a discrete state over, or its contrary; its name where there is none, or where
  /// the comparison itself reads it.
  std::string switch_text(std::uint32_t discrete_state, bool holds) {
    const auto found = std::find_if(
        network_.switches.begin(), network_.switches.end(),
        [&](const network::Switch& candidate) { return candidate.discrete_state == discrete_state; });
    if (found == network_.switches.end() || !open_.insert(discrete_state).second)
      return network_.discrete_states[discrete_state].name;
    std::vector<Monomial> terms = scaled(found->event_function, 1);
    open_.erase(discrete_state);
    double level = 0;
    std::erase_if(terms, [&](const Monomial& term) {
      const bool is_number = term.factors.empty() && term.divisors.empty();
      if (is_number) level -= term.coefficient;
      return is_number;
    });
    // -x > 1 is x < -1
    const bool turned = !terms.empty() && std::signbit(terms.front().coefficient);
    if (turned) {
      level = -level;
      for (Monomial& term : terms) term.coefficient = -term.coefficient;
    }
    const char* const relation = turned ? (holds ? "<" : ">=") : (holds ? ">" : "<=");
    return fmt::format("{} {} {}", sum_text(terms), relation, number(level));
  }

  std::string call(std::string_view name, const Node& node) {
    std::string text = fmt::format("{}(", name);
    for (int k = 0; k < network::operand_count(node.op); ++k)
      text += (k == 0 ? "" : ", ") + node_text(node.operand(k));
    return text + ")";
  }

  /// What is neither a sum nor a product.
  std::string other_text(const Node& node) {
    switch (node.op) {
      case Op::discrete_state: {
        const std::string comparison = switch_text(node.variable, true);
        return comparison == network_.discrete_states[node.variable].name ? comparison
                                                                          : "(" + comparison + ")";
      }
      case Op::select:
        return fmt::format("if({}, {}, {})", condition_text(node.a), node_text(node.b), node_text(node.c));
      case Op::less:
        return fmt::format("({} < {})", node_text(node.a), node_text(node.b));
      case Op::less_equal:
        return fmt::format("({} <= {})", node_text(node.a), node_text(node.b));
      case Op::equal:
        return fmt::format("({} == {})", node_text(node.a), node_text(node.b));
      case Op::table_value:
        return fmt::format("table{}({})", network_.graph[node.c].value + 1, node_text(node.a));
      default:
        break;
    }
    const auto operation = network::smooth_operation(node.op);
    return call(operation ? text::info_of(*operation).name : "part", node);
  }

  Monomial power(const Node& node) {
    const Node& exponent = network_.graph[node.b];
    const Monomial base = monomial(node.a);
    const bool whole = exponent.op == Op::constant && exponent.value == std::floor(exponent.value);
    if (whole && base.factors.size() == 1 && base.divisors.empty())
      return {
          std::pow(base.coefficient, exponent.value),
          {fmt::format("{}^{}", base.factors.front(),
                       exponent.value < 0 ? fmt::format("({})", exponent.value) : number(exponent.value))},
          {}};
    return {1, {fmt::format("({})^({})", node_text(node.a), node_text(node.b))}, {}};
  }

  /// A node as one term; a sum of several stands in parentheses.
  Monomial monomial(NodeId id) {
    const Node& node = network_.graph[id];
    if (apart_.contains(id)) {
      if (asked_.insert(id).second) queue_.push_back(id);
      return {names_.at(id).factor, {names_.at(id).name}, {}};
    }
    switch (node.op) {
      case Op::constant:
        return {node.value, {}, {}};
      case Op::variable:
        return {variables_[node.variable].factor, {variables_[node.variable].name}, {}};
      case Op::multiply:
      case Op::divide: {
        Monomial product = monomial(node.a);
        Monomial other = monomial(node.b);
        const bool divides = node.op == Op::divide;
        product.coefficient =
            divides ? product.coefficient / other.coefficient : product.coefficient * other.coefficient;
        auto& up = divides ? other.divisors : other.factors;
        auto& down = divides ? other.factors : other.divisors;
        product.factors.insert(product.factors.end(), up.begin(), up.end());
        product.divisors.insert(product.divisors.end(), down.begin(), down.end());
        return product;
      }
      case Op::negate:
      case Op::add:
      case Op::subtract: {
        std::vector<Monomial> terms = scaled(id, 1);
        if (terms.empty()) return {0, {}, {}};
        if (terms.size() == 1) return std::move(terms.front());
        return {1, {"(" + sum_text(terms) + ")"}, {}};
      }
      case Op::power:
        return power(node);
      default:
        return {1, {other_text(node)}, {}};
    }
  }

  void add_terms(NodeId id, double coefficient, std::vector<Monomial>& terms) {
    const Node& node = network_.graph[id];
    const bool open = !apart_.contains(id);
    if (open && (node.op == Op::add || node.op == Op::subtract)) {
      add_terms(node.a, coefficient, terms);
      add_terms(node.b, node.op == Op::add ? coefficient : -coefficient, terms);
    } else if (open && node.op == Op::negate) {
      add_terms(node.a, -coefficient, terms);
    } else if (open && node.op == Op::multiply && network_.graph.is_constant(node.a)) {
      add_terms(node.b, coefficient * network_.graph[node.a].value, terms);
    } else if (open && node.op == Op::multiply && network_.graph.is_constant(node.b)) {
      add_terms(node.a, coefficient * network_.graph[node.b].value, terms);
    } else if (open && node.op == Op::divide && network_.graph.is_constant(node.b)) {
      add_terms(node.a, coefficient / network_.graph[node.b].value, terms);
    } else {
      Monomial term = monomial(id);
      term.coefficient *= coefficient;
      terms.push_back(std::move(term));
    }
  }

  /// `scale` times a node, as a sum without two terms alike.
  std::vector<Monomial> scaled(NodeId id, double scale) {
    std::vector<Monomial> terms;
    add_terms(id, scale, terms);
    return merged(std::move(terms));
  }

  static std::vector<Monomial> merged(std::vector<Monomial> terms) {
    std::vector<Monomial> kept;
    std::map<std::pair<std::vector<std::string>, std::vector<std::string>>, std::size_t> places;
    for (Monomial& term : terms) {
      auto key = std::pair(term.factors, term.divisors);
      std::sort(key.first.begin(), key.first.end());
      std::sort(key.second.begin(), key.second.end());
      const auto [place, is_new] = places.emplace(std::move(key), kept.size());
      if (is_new) {
        kept.push_back(std::move(term));
      } else {
        kept[place->second].coefficient += term.coefficient;
      }
    }
    std::erase_if(kept, [](const Monomial& term) { return term.coefficient == 0; });
    in_reading_order(kept);
    return kept;
  }

  /// Short products first and numbers last; none with a minus at the head of a sum, if another can be there.
  static void in_reading_order(std::vector<Monomial>& terms) {
    const auto rank = [](const Monomial& term) {
      const std::size_t n = term.factors.size() + term.divisors.size();
      return std::pair(n == 0 ? std::numeric_limits<std::size_t>::max() : n, std::signbit(term.coefficient));
    };
    std::stable_sort(terms.begin(), terms.end(),
                     [&](const Monomial& a, const Monomial& b) { return rank(a) < rank(b); });
    const auto plus = std::find_if(terms.begin(), terms.end(),
                                   [](const Monomial& term) { return !std::signbit(term.coefficient); });
    if (plus != terms.end()) std::rotate(terms.begin(), plus, plus + 1);
  }

  std::string product_text(const std::vector<std::string>& factors) const {
    std::string text;
    std::set<std::string> done;
    for (const std::string& factor : factors) {
      if (!done.insert(factor).second) continue;
      const auto times = std::count(factors.begin(), factors.end(), factor);
      const bool is_power = factor.find('^') != std::string::npos;  // x^3^2 is x^9
      text +=
          (text.empty() ? "" : "*") +
          (times == 1 ? factor : fmt::format(fmt::runtime(is_power ? "({})^{}" : "{}^{}"), factor, times));
    }
    return text;
  }

  std::string sum_text(const std::vector<Monomial>& terms) const {
    if (terms.empty()) return "0";
    std::string text;
    for (const Monomial& term : terms) {
      const bool minus = std::signbit(term.coefficient);
      const double size = std::abs(term.coefficient);
      text += text.empty() ? (minus ? "-" : "") : (minus ? " - " : " + ");
      const std::string product = product_text(term.factors);
      if (product.empty()) {
        text += number(size);
      } else {
        text += number(size) == "1" ? product : number(size) + "*" + product;
      }
      if (term.divisors.size() == 1) text += "/" + term.divisors.front();
      if (term.divisors.size() > 1) text += "/(" + product_text(term.divisors) + ")";
    }
    return text;
  }

  std::string node_text(NodeId id) { return sum_text(scaled(id, 1)); }

  network::Network network_;
  int digits_;
  std::vector<Quantity> variables_;
  std::unordered_map<NodeId, Quantity> names_;
  std::unordered_set<NodeId> apart_;  ///< of `names_`: those with an equation of their own
  std::unordered_set<NodeId> asked_;  ///< of these: those in the queue
  std::vector<NodeId> queue_;
  std::size_t next_ = 0;
  std::vector<Output> outputs_;
  std::set<std::uint32_t> open_;  ///< discrete states whose comparisons are being written
  int unnamed_ = 0;
};

}  // namespace

diagram::FlatDiagram as_operated(diagram::FlatDiagram diagram) {
  diagram = diagram::without_saturation(std::move(diagram));
  diagram.timeline = {};
  for (diagram::FlatBlock& block : diagram.blocks) block.group = 0;
  return diagram;
}

std::vector<RecoveredEquation> recovered_equations(const diagram::FlatDiagram& diagram, int digits) {
  return EquationReader(as_operated(diagram), digits).read();
}

}  // namespace oblique::report
