// SPDX-License-Identifier: MIT
#include <oblique/machine/circuit.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <tuple>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/mode_control.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/repeated_comparator.h>

namespace oblique::machine {
namespace {

/// What is left of a difference of equal weights is rounding.
constexpr double kRoundingOfSum = 1e-15;

/// A weight at which a passed-on signal still fits into the range, rounding allowed.
constexpr double kUnit = 1 + 1e-12;

/// "turns, tolerance and load"
std::string listed(const std::vector<std::string>& names) {
  std::string list = fmt::format("{}", fmt::join(names.begin(), names.end() - 1, ", "));
  return list + (list.empty() ? "" : " and ") + names.back();
}

class Reducer {
 public:
  Reducer(const diagram::FlatDiagram& flat, const diagram::BlockLibrary& library, double most_weight)
      : flat_(flat), library_(library), most_weight_(most_weight), blocks_(flat.blocks.size()) {}

  Circuit make() {
    for (const diagram::FlatOutput& output : flat_.outputs)
      circuit_.outputs.push_back(resolve(output.signal));
    for (const diagram::SignalRef signal : mode_signals(flat_.timeline))
      circuit_.mode_sources.push_back(resolve(signal));
    // What an element is fed with may keep further elements, behind it.
    for (std::size_t e = 0; e < order_.size(); ++e) {
      if (circuit_.elements[e].inputs.empty()) connect(e);
    }
    diagnostics_.throw_if_any<RealiseError>();
    put_into_file_order();
    return std::move(circuit_);
  }

 private:
  enum class State { untouched, visiting, reduced, kept };
  struct Block {
    State state = State::untouched;
    CircuitTerm value;  ///< of a reduced or kept block's first output
    std::optional<bool> gives_nothing;
  };
  /// A weighted signal; of the reference without an element.
  using Factor = std::tuple<std::size_t, std::size_t, double>;
  using Sum = std::vector<Factor>;  ///< sorted

  /// A signal as a weight of an element's output or of the reference.
  CircuitTerm resolve(diagram::SignalRef signal) {
    Block& block = blocks_[signal.block];
    if (block.state == State::visiting) keep(signal.block);  // on a loop of its kind: it stays
    if (block.state == State::untouched) {
      block.state = State::visiting;
      const std::optional<CircuitTerm> value = reduced(signal.block);
      if (block.state == State::visiting && value) {
        block.value = *value;
        block.state = State::reduced;
      } else if (block.state == State::visiting) {
        keep(signal.block);
      }
    }
    CircuitTerm value = block.value;
    if (block.state == State::kept) value.signal->output = signal.output;
    return value;
  }

  /// What a block amounts to that need not stay as an element.
  std::optional<CircuitTerm> reduced(std::size_t index) {
    const diagram::FlatBlock& block = flat_.blocks[index];
    switch (block.definition->role) {
      case Role::reference:
        return CircuitTerm{parameter_of(block, "value"), std::nullopt};
      case Role::potentiometer:
      case Role::gain:
        return single(gathered(block, 0), factor_of(block));
      case Role::inverter:
        return has_defaults(block) ? single(gathered(block, 0), -1) : std::nullopt;
      case Role::summer:
        return has_defaults(block) ? passed_on(gathered(block, 0), block.polarity) : std::nullopt;
      case Role::multiplier:
      case Role::squarer:
        return has_defaults(block) ? product(index) : std::nullopt;
      case Role::comparator:
        return compared(index);
      default:
        return std::nullopt;
    }
  }

  double factor_of(const diagram::FlatBlock& block) {
    const std::string_view factor = block.definition->role == Role::gain ? "factor" : "setting";
    if (!has_defaults(block, {factor})) {
      std::vector<std::string> others;
      for (const diagram::ParameterDefinition& parameter : block.definition->parameters) {
        if (parameter.name != factor) others.push_back(parameter.name);
      }
      diagnostics_.add({block.place,
                        fmt::format("{} '{}' has imperfections of its own",
                                    diagram::role_name(block.definition->role), block.path),
                        fmt::format("a {} and nothing else", factor),
                        fmt::format("leave {} out: those of the machine apply", listed(others))});
    }
    return parameter_of(block, factor);
  }

  static std::optional<CircuitTerm> single(const CircuitInput& input, double factor) {
    if (input.terms.size() > 1) return std::nullopt;
    if (input.terms.empty()) return CircuitTerm{0, std::nullopt};
    return CircuitTerm{factor * input.terms.front().weight, input.terms.front().signal};
  }

  /// A summer that adds nothing to its one signal is one amplifier too many.
  static std::optional<CircuitTerm> passed_on(const CircuitInput& input, double polarity) {
    const auto value = single(input, polarity);
    return value && value->signal && std::abs(value->weight) > kUnit ? std::nullopt : value;
  }

  /// Whether an input gets nothing at all, by its wires alone.
  bool is_nothing(const diagram::FlatInput& input) {
    return input.constant == 0 &&
           std::all_of(input.terms.begin(), input.terms.end(), [&](const diagram::FlatTerm& term) {
             return term.weight == 0 || gives_nothing(term.signal.block);
           });
  }

  bool gives_nothing(std::size_t index) {
    std::optional<bool>& known = blocks_[index].gives_nothing;
    if (known) return *known;
    known = false;  // a ring of summers gives nothing, too, but is left to them
    return *(known = inputs_give_nothing(flat_.blocks[index]));
  }

  bool inputs_give_nothing(const diagram::FlatBlock& block) {
    const auto is_none = [&](const diagram::FlatInput& input) { return is_nothing(input); };
    switch (block.definition->role) {
      case Role::reference:
        return parameter_of(block, "value") == 0;
      case Role::potentiometer:
      case Role::gain:
      case Role::inverter:
      case Role::summer:
        return has_defaults(block, {"factor", "setting"}) &&
               std::all_of(block.inputs.begin(), block.inputs.end(), is_none);
      case Role::multiplier:
      case Role::squarer:
        return has_defaults(block) && std::any_of(block.inputs.begin(), block.inputs.end(), is_none);
      default:
        return false;
    }
  }

  std::optional<CircuitTerm> product(std::size_t index) {
    // The other factor may be needed by nothing else.
    if (gives_nothing(index)) return CircuitTerm{0, std::nullopt};
    const auto [x, y] = factors(flat_.blocks[index]);
    const auto a = single(x, 1), b = single(y, 1);
    if (a && !a->signal)
      return b ? std::optional(CircuitTerm{a->weight * b->weight, b->signal}) : std::nullopt;
    if (b && !b->signal)
      return a ? std::optional(CircuitTerm{a->weight * b->weight, a->signal}) : std::nullopt;
    // Of factors that differ from others by a constant the product does too.
    Sum one = sum_of(x), other = sum_of(y);
    const double weight = std::get<2>(one.front()) * std::get<2>(other.front());
    for (Sum* const sum : {&one, &other}) {
      const double first = std::get<2>(sum->front());
      for (Factor& factor : *sum) std::get<2>(factor) /= first;
    }
    const auto [found, is_new] = products_.try_emplace(
        one < other ? std::pair(one, other) : std::pair(other, one), std::pair(index, weight));
    if (is_new) return std::nullopt;
    const auto& [formed, of_formed] = found->second;
    if (blocks_[formed].state != State::kept) keep(formed);
    return CircuitTerm{weight / of_formed, blocks_[formed].value.signal};
  }

  /// A comparator of a comparator is one too many, and so is a second one of what is compared already.
  std::optional<CircuitTerm> compared(std::size_t index) {
    const diagram::FlatBlock& block = flat_.blocks[index];
    if (const auto value = repeated(block)) return value;
    if (block.inputs.size() != 1) return std::nullopt;
    const Sum sum = sum_of(gathered(block, 0));
    const auto [found, is_new] = comparators_.try_emplace({block.definition, block.parameters, sum}, index);
    if (is_new || found->second == index) return std::nullopt;
    if (blocks_[found->second].state != State::kept) keep(found->second);
    return blocks_[found->second].value;
  }

  static Sum sum_of(const CircuitInput& input) {
    Sum sum;
    for (const CircuitTerm& term : input.terms)
      sum.push_back(term.signal ? key_of(term)
                                : Factor{std::numeric_limits<std::size_t>::max(), 0, term.weight});
    std::sort(sum.begin(), sum.end());
    return sum;
  }

  /// A comparator of a comparator, as before a switch, is one too many.
  std::optional<CircuitTerm> repeated(const diagram::FlatBlock& block) {
    if (block.inputs.size() != 1) return std::nullopt;
    double offset = 0;
    std::optional<CircuitTerm> compared;
    for (const CircuitTerm& term : gathered(block, 0).terms) {
      if (term.signal && compared) return std::nullopt;
      if (term.signal) compared = term;
      if (!term.signal) offset = term.weight;
    }
    if (!compared) return std::nullopt;
    const diagram::FlatBlock* const source = circuit_.elements[compared->signal->block].block;
    if (source == nullptr || !only_repeats(block, compared->weight, offset, *source)) return std::nullopt;
    return CircuitTerm{1, compared->signal};
  }

  std::pair<CircuitInput, CircuitInput> factors(const diagram::FlatBlock& block) {
    const CircuitInput x = gathered(block, 0);
    return {x, block.inputs.size() > 1 ? gathered(block, 1) : x};  // a squarer has one input
  }

  static Factor key_of(const CircuitTerm& term) {
    return {term.signal->block, term.signal->output, term.weight};
  }

  /// The terms of an input, each signal once.
  CircuitInput gathered(const diagram::FlatBlock& block, std::size_t port) {
    const diagram::FlatInput& input = block.inputs[port];
    CircuitInput gathered;
    gathered.open =
        input.terms.empty() && block.definition->inputs[port].default_value == std::optional(input.constant);
    if (gathered.open && stays_as_it_is(block.definition->role)) return gathered;
    double largest = 0;
    const auto add = [&](CircuitTerm term) {
      if (term.weight == 0) return;
      largest = std::max(largest, std::abs(term.weight));
      const auto same = std::find_if(gathered.terms.begin(), gathered.terms.end(),
                                     [&](const CircuitTerm& t) { return t.signal == term.signal; });
      if (same == gathered.terms.end()) {
        gathered.terms.push_back(term);
      } else {
        same->weight += term.weight;
      }
    };
    add({input.constant, std::nullopt});
    for (const diagram::FlatTerm& term : input.terms) {
      if (term.weight == 0) continue;  // what it comes from may be needed by nothing else
      CircuitTerm value = resolve(term.signal);
      value.weight *= term.weight;
      add(value);
    }
    std::erase_if(gathered.terms,
                  [&](const CircuitTerm& t) { return std::abs(t.weight) <= kRoundingOfSum * largest; });
    return gathered;
  }

  void keep(std::size_t index) {
    const diagram::FlatBlock& block = flat_.blocks[index];
    CircuitElement element;
    element.role = block.definition->role;
    element.path = block.path;
    element.block = &block;
    element.definition = block.definition;
    element.polarity = element.role == Role::summer || element.role == Role::integrator ? block.polarity : 1;
    if (is_coefficient(element.role)) {
      element.role = Role::summer;
      element.block = nullptr;
      element.definition = &element_block(library_, Role::summer);
    } else if (element.role == Role::squarer) {
      element.role = Role::multiplier;
      element.definition = &element_block(library_, Role::multiplier);
      check_parameters(block, *element.definition);
    }
    if (element.role == Role::other) element.logic = logic_ports(block);
    blocks_[index].state = State::kept;
    blocks_[index].value = {1, add(std::move(element), index)};
  }

  /// What a block says of itself is said of the multiplier that it becomes.
  void check_parameters(const diagram::FlatBlock& block, const diagram::BlockDefinition& becomes) {
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      const diagram::ParameterDefinition& own = block.definition->parameters[k];
      if (block.parameters[k] == own.default_value || becomes.find_parameter(own.name)) continue;
      diagnostics_.add({block.place,
                        fmt::format("squarer '{}' sets '{}', which '{}' does not have", block.path, own.name,
                                    becomes.name),
                        fmt::format("parameters of '{}'", becomes.name),
                        "a squarer is a multiplier there: leave it out, or take a block that multiplies"});
    }
  }

  diagram::SignalRef add(CircuitElement element, std::size_t block) {
    circuit_.elements.push_back(std::move(element));
    order_.push_back(block);
    return {circuit_.elements.size() - 1, 0};
  }

  void connect(std::size_t index) {
    const diagram::FlatBlock& block = flat_.blocks[order_[index]];
    std::vector<CircuitInput> inputs;
    const Role role = block.definition->role;
    if (is_product(role)) {
      auto [x, y] = factors(block);
      inputs = {std::move(x), std::move(y)};
    } else {
      for (std::size_t k = 0; k < block.inputs.size(); ++k) inputs.push_back(gathered(block, k));
    }
    if (is_coefficient(role)) {
      for (CircuitTerm& term : inputs.front().terms) term.weight *= factor_of(block);
    }
    const auto& ports = circuit_.elements[index].definition->inputs;
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (ports[k].sum) continue;
      const bool too_much =
          inputs[k].terms.size() > 1 ||
          (inputs[k].terms.size() == 1 && std::abs(inputs[k].terms.front().weight) > most_weight_ * kUnit);
      if (too_much) scale(index, ports[k].name, inputs[k]);
    }
    circuit_.elements[index].inputs = std::move(inputs);
  }

  /// Puts an amplifier before an input that takes one signal of weight 1, one for all that take the same.
  void scale(std::size_t index, const std::string& port, CircuitInput& input) {
    const bool is_one = input.terms.size() == 1 && input.terms.front().signal;
    double sign = 1;
    if (is_one && input.terms.front().weight < 0) {
      sign = -1;
      input.terms.front().weight *= sign;
    }
    const Sum key = sum_of(input);
    if (const auto found = scalers_.find(key); found != scalers_.end()) {
      input.terms = {{sign, found->second}};
      return;
    }
    CircuitElement scaler;
    scaler.path = is_one ? circuit_.elements[input.terms.front().signal->block].path + ".scaled"
                         : circuit_.elements[index].path + "." + port;
    scaler.definition = &element_block(library_, Role::summer);
    scaler.inputs = {std::move(input)};
    const diagram::SignalRef signal = add(std::move(scaler), order_[index]);
    scalers_.emplace(key, signal);
    input = {false, {{sign, signal}}};
  }

  /// The elements were found from the outputs backwards.
  void put_into_file_order() {
    std::vector<std::size_t> sorted(order_.size());
    std::iota(sorted.begin(), sorted.end(), std::size_t{0});
    std::stable_sort(sorted.begin(), sorted.end(), [&](std::size_t a, std::size_t b) {
      // a scaler stands before the element that asked for it
      return std::pair(order_[a], circuit_.elements[a].block != nullptr) <
             std::pair(order_[b], circuit_.elements[b].block != nullptr);
    });
    std::vector<std::size_t> place(sorted.size());
    std::vector<CircuitElement> elements;
    for (std::size_t k = 0; k < sorted.size(); ++k) {
      place[sorted[k]] = k;
      elements.push_back(std::move(circuit_.elements[sorted[k]]));
    }
    const auto move = [&](CircuitTerm& term) {
      if (term.signal) term.signal->block = place[term.signal->block];
    };
    for (CircuitElement& element : elements) {
      for (CircuitInput& input : element.inputs) std::for_each(input.terms.begin(), input.terms.end(), move);
    }
    std::for_each(circuit_.outputs.begin(), circuit_.outputs.end(), move);
    std::for_each(circuit_.mode_sources.begin(), circuit_.mode_sources.end(), move);
    circuit_.elements = std::move(elements);
  }

  const diagram::FlatDiagram& flat_;
  const diagram::BlockLibrary& library_;
  double most_weight_;
  std::vector<Block> blocks_;
  Circuit circuit_;
  std::vector<std::size_t> order_;  ///< of each element the flat block that asked for it
  /// With the flat blocks that form them, and the weights of these.
  std::map<std::pair<Sum, Sum>, std::pair<std::size_t, double>> products_;
  std::map<Sum, diagram::SignalRef> scalers_;
  /// With the flat blocks that they are, by kind, parameters and what they compare.
  std::map<std::tuple<const diagram::BlockDefinition*, std::vector<double>, Sum>, std::size_t> comparators_;
  text::Diagnostics diagnostics_;
};

}  // namespace

Circuit reduce(const diagram::FlatDiagram& flat, const diagram::BlockLibrary& library, double most_weight) {
  return Reducer(flat, library, most_weight).make();
}

}  // namespace oblique::machine
