// SPDX-License-Identifier: MIT
#include <oblique/machine/circuit_scaling.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/diagram/block_scaling.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/machine/role.h>
#include <oblique/text/nearest_decimal.h>
#include <oblique/text/quantity.h>

namespace oblique::machine {
namespace {

constexpr int kDigits = 14;  ///< of scaled numbers: 0.2 comes out as 0.2

/// The largest number of two digits that brings `peak` to at most 1 machine unit. What is smaller than the
/// static error of any loop is taken for zero.
double largest_factor(double peak) {
  constexpr double kNothing = 1e-9;
  if (peak < kNothing) return 1;
  const double wanted = (1 + diagram::kOverloadTolerance) / peak;
  const double unit = std::pow(10, std::floor(std::log10(wanted)) - 1);
  return text::nearest_decimal(std::floor(wanted / unit * (1 + 1e-12)) * unit, 2);
}

/// Whether its factor is free, but for its range.
bool is_free(Role role) {
  return role == Role::summer || role == Role::inverter || role == Role::integrator ||
         role == Role::open_amplifier || role == Role::function_generator;
}

double rate_of(const CircuitElement& element) {
  return std::abs(parameter_of(*element.block, "rate"));
}

/// Whether an input is compared with a level that no factor moves.
bool has_fixed_level(const CircuitElement& element, std::size_t port) {
  if (element.role == Role::other) return true;
  return element.role == Role::integrator && !element.definition->inputs[port].sum &&
         element.definition->inputs[port].name != "start";
}

class Chooser {
 public:
  Chooser(const Circuit& circuit, const std::vector<double>& peaks, const diagram::MachineProfile& machine)
      : elements_(circuit.elements), machine_(machine), pinned_(elements_.size(), false) {
    for (std::size_t e = 0; e < elements_.size(); ++e) factors_.push_back(start_of(e, peaks[e]));
    for (const CircuitElement& element : elements_) {
      for (std::size_t port = 0; port < element.inputs.size(); ++port) {
        if (!has_fixed_level(element, port)) continue;
        for (const CircuitTerm& term : element.inputs[port].terms) {
          if (term.signal && !is_product(elements_[term.signal->block].role)) pin(term.signal->block);
        }
      }
    }
  }

  CircuitScaling choose(std::optional<double> time) {
    // Each pass settles one more element of the longest chain.
    bool changed = true;
    for (std::size_t pass = 0; changed && pass <= elements_.size(); ++pass) {
      changed = false;
      for (std::size_t e = 0; e < elements_.size(); ++e) changed = relax(e) || changed;
    }
    CircuitScaling scaling{factors_, 1};
    scaling.time = time.value_or(choose_time());
    return scaling;
  }

 private:
  double start_of(std::size_t e, double peak) const {
    if (is_free(elements_[e].role)) return largest_factor(peak);
    // Levels of logic stay 0 and 1.
    if (elements_[e].role == Role::comparator) return std::min(1.0, largest_factor(peak));
    return 1;
  }

  void pin(std::size_t e) {
    pinned_[e] = true;
    factors_[e] = 1;
  }

  double source_factor(const CircuitTerm& term) const {
    return term.signal ? factors_[term.signal->block] : 1;
  }

  /// Lowers the factor of a summer, or takes that of a multiplier from its inputs; whether it has changed.
  bool relax(std::size_t e) {
    const CircuitElement& element = elements_[e];
    if (pinned_[e]) return false;
    double factor = factors_[e];
    if (is_product(element.role)) {
      factor = 1;
      for (const CircuitInput& input : element.inputs) {
        for (const CircuitTerm& term : input.terms) factor *= source_factor(term) / std::abs(term.weight);
      }
    } else if (element.role != Role::comparator && element.role != Role::function_generator) {
      for (std::size_t port = 0; port < element.inputs.size(); ++port) {
        const bool sum = element.definition->inputs[port].sum;
        if (sum && element.role != Role::summer) continue;
        for (const CircuitTerm& term : element.inputs[port].terms)
          factor =
              std::min(factor, (sum ? greatest_gain() : 1) * source_factor(term) / std::abs(term.weight));
      }
    }
    if (std::abs(factor - factors_[e]) <= 1e-12 * factor) return false;
    factors_[e] = text::nearest_decimal(factor, kDigits);
    return true;
  }

  double greatest_gain() const { return machine_.input_gains.empty() ? 10 : machine_.input_gains.back(); }

  /// What the largest coefficient of an integrator is in the diagram's own time [1/s]; 0 without inputs.
  double speed_of(std::size_t e) const {
    double largest = 0;
    for (std::size_t port = 0; port < elements_[e].inputs.size(); ++port) {
      if (!elements_[e].definition->inputs[port].sum) continue;
      for (const CircuitTerm& term : elements_[e].inputs[port].terms)
        largest = std::max(largest, std::abs(term.weight) * factors_[e] / source_factor(term));
    }
    return largest == 0 ? 0 : largest * rate_of(elements_[e]);
  }

  double choose_time() const {
    if (machine_.rates.empty()) return 1;
    constexpr double kLeastSetting = 0.1, kRounding = 1 + 1e-9;
    const double most = machine_.rates.back() * greatest_gain() * kRounding;
    const double least = machine_.rates.front() *
                         (machine_.input_gains.empty() ? 1 : machine_.input_gains.front()) * kLeastSetting /
                         kRounding;
    std::vector<double> speeds;
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      if (elements_[e].role != Role::integrator) continue;
      if (const double speed = speed_of(e); speed > 0) speeds.push_back(speed);
    }
    if (speeds.empty()) return 1;
    double best = 1, least_cost = std::numeric_limits<double>::infinity();
    constexpr int kDecades = 12;
    for (int decade = -kDecades; decade <= kDecades; ++decade) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double power = std::pow(10.0, std::abs(decade));
        const double time = decade < 0 ? step / power : step * power;
        const double cost = cost_of(time, speeds, least, most);
        if (cost >= least_cost) continue;
        least_cost = cost;
        best = time;
      }
    }
    return best;
  }

  /// In decades: by how much the largest coefficients of integrators are too small, together; what is too
  /// large counts so much that it never is where that can be; and then how far the time is from the
  /// diagram's.
  static double cost_of(double time, const std::vector<double>& speeds, double least, double most) {
    constexpr double kTooLarge = 1e6, kAway = 1e-3;
    double cost = kAway * std::abs(std::log10(time));
    for (const double speed : speeds) {
      cost += kTooLarge * std::max(0.0, std::log10(speed / time / most));
      cost += std::max(0.0, std::log10(least / (speed / time)));
    }
    return cost;
  }

  const std::vector<CircuitElement>& elements_;
  const diagram::MachineProfile& machine_;
  std::vector<bool> pinned_;
  std::vector<double> factors_;
};

class Scaler {
 public:
  Scaler(const CircuitScaling& scaling, double loop_speed, Circuit& circuit, diagram::FlatDiagram& flat)
      : scaling_(scaling), loop_speed_(loop_speed), circuit_(circuit), flat_(flat) {}

  void scale() {
    for (std::size_t e = 0; e < circuit_.elements.size(); ++e) scale(e);
    for (CircuitTerm& term : circuit_.outputs) term.weight /= source_factor(term);
  }

 private:
  double source_factor(const CircuitTerm& term) const {
    return term.signal ? scaling_.signals[term.signal->block] : 1;
  }

  void scale(std::size_t e) {
    CircuitElement& element = circuit_.elements[e];
    const double out = scaling_.signals[e];
    diagram::FlatBlock* const block =
        element.block == nullptr
            ? nullptr
            : &flat_.blocks[static_cast<std::size_t>(element.block - flat_.blocks.data())];
    std::vector<double> inputs(element.inputs.size(), out);
    if (element.role == Role::comparator || element.role == Role::function_generator ||
        element.role == Role::multiplier || element.role == Role::other) {
      for (std::size_t port = 0; port < inputs.size(); ++port)
        inputs[port] = element.role == Role::other ? 1 : unit_weight(element.inputs[port]);
    }
    for (std::size_t port = 0; port < inputs.size(); ++port) {
      const double factor = has_fixed_level(element, port) ? 1 : inputs[port];
      for (CircuitTerm& term : element.inputs[port].terms)
        term.weight = text::nearest_decimal(term.weight * factor / source_factor(term), kDigits);
    }
    if (block == nullptr) return;
    if (element.role == Role::comparator) {
      scale_comparator(*block, inputs, out);
    } else {
      for (std::size_t k = 0; k < block->parameters.size(); ++k) {
        if (element.role == Role::function_generator && block->definition->parameters[k].points)
          scale_points(block->points[k], inputs.empty() ? 1 : inputs.front(), out);
        scale_parameter(*block, k, out);
      }
      block->tolerance *= out;
    }
    if (element.role == Role::open_amplifier) {
      for (std::size_t k = 0; k < block->parameters.size(); ++k) {
        if (block->definition->parameters[k].name == "bandwidth") block->parameters[k] *= loop_speed_;
      }
    }
    block->choose_behaviour();
  }

  /// The factor of an input with which its largest weight becomes 1.
  double unit_weight(const CircuitInput& input) const {
    double largest = 0;
    for (const CircuitTerm& term : input.terms)
      largest = std::max(largest, std::abs(term.weight) / source_factor(term));
    return largest == 0 ? 1 : 1 / largest;
  }

  /// A voltage goes with the signal, a time with the time: as its unit says.
  void scale_parameter(diagram::FlatBlock& block, std::size_t k, double factor) const {
    const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
    const auto unit = text::parse_unit(parameter.unit);
    if (!unit || parameter.points || parameter.formula) return;
    double& value = block.parameters[k];
    if (value == 0 || !std::isfinite(value)) return;
    const int signals = block.saturation == k ? 0 : unit->exponents[text::Unit::signal];
    const int seconds = unit->exponents[text::Unit::time];
    if (signals == 0 && (seconds == 0 || scaling_.time == 1)) return;
    value =
        text::nearest_decimal(value * std::pow(factor, signals) * std::pow(scaling_.time, seconds), kDigits);
  }

  /// Its switching points go with the input, its levels with the output.
  void scale_comparator(diagram::FlatBlock& block, const std::vector<double>& inputs, double out) const {
    const diagram::BlockScalingRules rules(block);
    const diagram::BlockScaling by_inputs = rules.from_inputs(inputs);
    const diagram::BlockScaling by_two = rules.from_inputs(std::vector<double>(inputs.size(), 2));
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      const bool follows_input = by_two.parameters[k] != 1;
      scale_parameter(block, k, follows_input ? by_inputs.parameters[k] : out);
    }
  }

  static void scale_points(text::PointTable& points, double x, double y) {
    for (double& value : points.x) value = text::nearest_decimal(value * x, kDigits);
    for (double& value : points.y) value = text::nearest_decimal(value * y, kDigits);
  }

  const CircuitScaling& scaling_;
  double loop_speed_;
  Circuit& circuit_;
  diagram::FlatDiagram& flat_;
};

}  // namespace

CircuitScaling choose_scaling(const Circuit& circuit, const std::vector<double>& peaks,
                              const diagram::MachineProfile& machine, std::optional<double> time) {
  return Chooser(circuit, peaks, machine).choose(time);
}

void apply_scaling(const CircuitScaling& scaling, double loop_speed, Circuit& circuit,
                   diagram::FlatDiagram& flat) {
  Scaler(scaling, loop_speed, circuit, flat).scale();
}

}  // namespace oblique::machine
