// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/equations.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/assembly/network.h>
#include <oblique/report/atlas/equation_names.h>
#include <oblique/report/atlas/printed_sum.h>

namespace oblique::report {
namespace {

using network::Node;
using network::NodeId;
using network::Op;

class EquationReader {
 public:
  EquationReader(const diagram::FlatDiagram& diagram, int digits)
      : network_(network::assemble(diagram)), names_(name_equations(network_, diagram)), digits_(digits) {
    for (const NodeId id : names_.apart_outputs) ask(id);
  }

  std::vector<RecoveredEquation> read() {
    std::vector<RecoveredEquation> equations;
    for (std::size_t s = 0; s < network_.states.size(); ++s) {
      const network::State& state = network_.states[s];
      const Quantity& x = names_.variables[network_.state_variable(s)];
      const bool known = !state.start_node || state.start_constant;
      equations.push_back({fmt::format("der({})", x.name), text_of(state.derivative, 1 / x.factor),
                           known ? number_text(state.start / x.factor, digits_) : ""});
    }
    for (std::size_t u = 0; u < network_.unknowns.size(); ++u) {
      const network::Unknown& unknown = network_.unknowns[u];
      const Quantity& z = names_.variables[network_.unknown_variable(u)];
      std::vector<Monomial> terms = scaled(unknown.residual, 1 / z.factor);
      if (unknown.torn)
        terms.push_back({1, {z.name}, {}});  // the residual is what the block gives less itself
      equations.push_back({unknown.torn ? z.name : "0", sum_text(merged(std::move(terms)), digits_), "",
                           unknown.torn ? "" : z.name});
    }
    for (const auto& [name, node, scale, offset] : names_.other_outputs) {
      const bool own = names_.apart.contains(node);
      if (own) names_.apart.erase(node);
      std::vector<Monomial> terms = scaled(node, scale);
      if (own) names_.apart.insert(node);
      if (offset != 0) terms.push_back({offset, {}, {}});
      equations.push_back({name, sum_text(terms, digits_), ""});
    }
    while (next_ < queue_.size()) {
      const NodeId node = queue_[next_++];
      names_.apart.erase(node);
      equations.push_back(
          {names_.signals.at(node).name, text_of(node, 1 / names_.signals.at(node).factor), ""});
      names_.apart.insert(node);
    }
    return equations;
  }

 private:
  /// Gives what stands apart its equation.
  void ask(NodeId id) {
    if (asked_.insert(id).second) queue_.push_back(id);
  }

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
    // A level that another comparison makes is that comparison, or its contrary.
    if (const auto choice = choice_of(found->event_function);
        choice && (choice->high > 0) != (choice->low > 0)) {
      std::string text = switch_text(choice->discrete_state, holds == (choice->high > 0));
      open_.erase(discrete_state);
      return text;
    }
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
    return fmt::format("{} {} {}", sum_text(terms, digits_), relation, number_text(level, digits_));
  }

  /// One of two numbers, as a switch stands.
  struct Choice {
    std::uint32_t discrete_state;
    double high, low;
  };

  std::optional<Choice> choice_of(NodeId id) const {
    const Node& node = network_.graph[id];
    const auto is_number = [&](NodeId operand) { return network_.graph.is_constant(operand); };
    const auto value = [&](NodeId operand) { return network_.graph[operand].value; };
    if (node.op == Op::select && network_.graph[node.a].op == Op::discrete_state && is_number(node.b) &&
        is_number(node.c))
      return Choice{network_.graph[node.a].variable, value(node.b), value(node.c)};
    if ((node.op != Op::add && node.op != Op::subtract) || is_number(node.a) == is_number(node.b))
      return std::nullopt;
    auto choice = choice_of(is_number(node.a) ? node.b : node.a);
    if (!choice) return std::nullopt;
    for (double* const level : {&choice->high, &choice->low})
      *level = network::evaluate(node.op, is_number(node.a) ? value(node.a) : *level,
                                 is_number(node.b) ? value(node.b) : *level);
    return choice;
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
      return {std::pow(base.coefficient, exponent.value),
              {fmt::format("{}^{}", base.factors.front(),
                           exponent.value < 0 ? fmt::format("({})", exponent.value)
                                              : number_text(exponent.value, digits_))},
              {}};
    return {1, {fmt::format("({})^({})", node_text(node.a), node_text(node.b))}, {}};
  }

  /// A node as one term; a sum of several stands in parentheses.
  Monomial monomial(NodeId id) {
    const Node& node = network_.graph[id];
    if (names_.apart.contains(id)) {
      ask(id);
      return {names_.signals.at(id).factor, {names_.signals.at(id).name}, {}};
    }
    switch (node.op) {
      case Op::constant:
        return {node.value, {}, {}};
      case Op::variable:
        return {names_.variables[node.variable].factor, {names_.variables[node.variable].name}, {}};
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
        return {1, {"(" + sum_text(terms, digits_) + ")"}, {}};
      }
      case Op::power:
        return power(node);
      default:
        return {1, {other_text(node)}, {}};
    }
  }

  void add_terms(NodeId id, double coefficient, std::vector<Monomial>& terms) {
    const Node& node = network_.graph[id];
    const bool open = !names_.apart.contains(id);
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

  std::string text_of(NodeId id, double scale) { return sum_text(scaled(id, scale), digits_); }

  std::string node_text(NodeId id) { return text_of(id, 1); }

  network::Network network_;
  EquationNames names_;
  int digits_;
  std::unordered_set<NodeId> asked_;  ///< of what stands apart: that in the queue
  std::vector<NodeId> queue_;
  std::size_t next_ = 0;
  std::set<std::uint32_t> open_;  ///< discrete states whose comparisons are being written
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

std::vector<text::PointTable> recovered_tables(const diagram::FlatDiagram& diagram) {
  return network::assemble(as_operated(diagram)).tables;
}

}  // namespace oblique::report
