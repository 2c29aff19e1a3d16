// SPDX-License-Identifier: MIT
#include <oblique/machine/circuit_scaling.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <oblique/diagram/block_scaling.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/machine/fixed_levels.h>
#include <oblique/machine/input_weight.h>
#include <oblique/machine/role.h>
#include <oblique/text/nearest_decimal.h>
#include <oblique/text/quantity.h>

namespace oblique::machine {
namespace {

constexpr int kDigits = 14;  ///< of scaled numbers: 0.2 comes out as 0.2

/// The largest number of two digits that brings `peak` to at most `most` machine units; 1 for no signal.
double largest_factor(double peak, double most = 1 + diagram::kOverloadTolerance) {
  const double wanted = most / peak;
  if (!std::isnormal(wanted)) return 1;
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

/// The factor of what a term carries, where the elements have these.
double factor_of(const CircuitTerm& term, const std::vector<CircuitElement>& elements,
                 const std::vector<double>& factors) {
  return term.signal && !has_fixed_level(elements, *term.signal) ? factors[term.signal->block] : 1;
}

/// The largest weight of a residual in the scale of the machine, its amplifier's output being scaled by
/// `out`.
double largest_weight(const CircuitElement& element, double out, const std::vector<CircuitElement>& elements,
                      const std::vector<double>& factors) {
  double largest = 0;
  for (const CircuitInput& input : element.inputs) {
    for (const CircuitTerm& term : input.terms)
      largest = std::max(largest, std::abs(term.weight) * out / factor_of(term, elements, factors));
  }
  return largest;
}

/// The rate of an integrator [1/s] above which its amplifier is slow: with 2π bandwidth its ten-thousandth,
/// by which an oscillation is late each radian.
double quick_rate(const diagram::MachineProfile& machine) {
  constexpr double kLate = 1e-4;
  for (const diagram::BlockFigure& error : machine.errors) {
    if (error.role == Role::integrator && error.parameter == "bandwidth")
      return kLate * 2 * std::numbers::pi * error.value;
  }
  return std::numeric_limits<double>::infinity();
}

class Chooser {
 public:
  Chooser(const Circuit& circuit, const std::vector<double>& peaks, double until,
          const diagram::MachineProfile& machine)
      : elements_(circuit.elements),
        peaks_(peaks),
        until_(until),
        machine_(machine),
        quick_(quick_rate(machine)),
        pinned_(elements_.size(), false) {
    for (std::size_t e = 0; e < elements_.size(); ++e) factors_.push_back(start_of(e));
    for (const CircuitElement& element : elements_) {
      for (std::size_t port = 0; port < element.inputs.size(); ++port) {
        if (!has_fixed_level(element, port)) continue;
        for (const CircuitTerm& term : element.inputs[port].terms) {
          if (term.signal && !is_product(elements_[term.signal->block].role) &&
              !has_fixed_level(elements_, *term.signal))
            pin(term.signal->block);
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
    CircuitScaling scaling{factors_, {}, 1};
    for (std::size_t e = 0; e < elements_.size(); ++e) scaling.residuals.push_back(residual_of(e));
    scaling.time = time.value_or(choose_time());
    return scaling;
  }

 private:
  double start_of(std::size_t e) const {
    const CircuitElement& element = elements_[e];
    if (element.role == Role::comparator) return largest_factor(level_of(e));
    if (element.logic && !element.logic->scales) return 1;
    if (!is_free(element.role) && !element.logic) return 1;
    // What is left of terms that cancel is rounding, errors of the run and what servo amplifiers of a gain of
    // a million leave over, whatever the units.
    constexpr double kNothing = 1e-7;
    const double reach = reach_of(element);
    const double factor = largest_factor(peaks_[e] < kNothing * reach ? reach : peaks_[e]);
    // A potentiometer at the reference sets the start, which leaves no room for an error of the run.
    if (element.role != Role::integrator || !element.definition->find_parameter("initial")) return factor;
    const double initial = std::abs(parameter_of(*element.block, "initial"));
    return initial > 0 ? std::min(factor, largest_factor(initial, 1)) : factor;
  }

  /// The larger level of a comparator, also where the run never has it.
  double level_of(std::size_t e) const {
    double level = 0;
    for (const std::string_view name : {"low", "high"}) {
      if (elements_[e].definition->find_parameter(name))
        level = std::max(level, std::abs(parameter_of(*elements_[e].block, name)));
    }
    return level > 0 ? level : peaks_[e];
  }

  /// How far its inputs could drive a summer, or an integrator until the end of the run; 0 for other
  /// elements.
  double reach_of(const CircuitElement& element) const {
    if (element.role == Role::open_amplifier || element.role == Role::function_generator || element.logic)
      return 0;
    double reach = 0;
    for (std::size_t port = 0; port < element.inputs.size(); ++port) {
      const bool integrated = element.role == Role::integrator && element.definition->inputs[port].sum;
      for (const CircuitTerm& term : element.inputs[port].terms) {
        const double peak = term.signal ? peaks_[term.signal->block] : 1;
        reach += std::abs(term.weight) * peak * (integrated ? until_ * rate_of(element) : 1);
      }
    }
    return reach;
  }

  /// The factor of a residual: that of the output, unless its largest weight then is none between 1 and the
  /// greatest gain. The zero of a residual is the same in any scale.
  double residual_of(std::size_t e) const {
    const CircuitElement& element = elements_[e];
    if (element.role != Role::open_amplifier || !element.definition->find_parameter("gain"))
      return factors_[e];
    const double largest = largest_weight(element, factors_[e], elements_, factors_);
    if (!std::isnormal(largest)) return factors_[e];
    return factors_[e] * std::clamp(largest, 1.0, std::max(1.0, greatest_gain())) / largest;
  }

  void pin(std::size_t e) {
    pinned_[e] = true;
    factors_[e] = 1;
  }

  double source_factor(const CircuitTerm& term) const { return factor_of(term, elements_, factors_); }

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
        if (has_fixed_level(element, port)) continue;
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

  /// The coefficients of an integrator in the diagram's own time [1/s].
  std::vector<double> speeds_of(std::size_t e) const {
    std::vector<double> speeds;
    for (std::size_t port = 0; port < elements_[e].inputs.size(); ++port) {
      if (!elements_[e].definition->inputs[port].sum) continue;
      for (const CircuitTerm& term : elements_[e].inputs[port].terms)
        speeds.push_back(std::abs(term.weight) * factors_[e] / source_factor(term) * rate_of(elements_[e]));
    }
    return speeds;
  }

  double choose_time() const {
    std::vector<std::vector<double>> speeds;  // of each integrator
    for (std::size_t e = 0; e < elements_.size(); ++e) {
      if (elements_[e].role == Role::integrator) speeds.push_back(speeds_of(e));
      if (!speeds.empty() && speeds.back().empty()) speeds.pop_back();
    }
    if (speeds.empty()) return 1;
    // Where the time factors are not published, k0 = 1/s is taken for one of them, and what is a hundred
    // times slower for too slow.
    constexpr double kSlow = 0.01;
    const bool is_slow = std::all_of(speeds.begin(), speeds.end(), [](const std::vector<double>& of_one) {
      return *std::max_element(of_one.begin(), of_one.end()) < kSlow;
    });
    if (machine_.rates.empty() && !is_slow) return 1;
    double best = 1, least_cost = std::numeric_limits<double>::infinity();
    constexpr int kDecades = 12;
    for (int decade = -kDecades; decade <= kDecades; ++decade) {
      for (const double step : {1.0, 2.0, 5.0}) {
        const double power = std::pow(10.0, std::abs(decade));
        const double time = decade < 0 ? step / power : step * power;
        const double cost = cost_of(time, speeds);
        if (cost >= least_cost) continue;
        least_cost = cost;
        best = time;
      }
    }
    return best;
  }

  /// In decades: by how much the settings before the inputs of integrators are below a tenth of the least
  /// gain, together, each integrator having the time factor that it gets (`choose_rate`), and by how much
  /// they are too fast for their amplifiers; a coefficient that is too large for the greatest time factor
  /// counts so much that it never is where that can be; and then how far the time is from the diagram's.
  double cost_of(double time, const std::vector<std::vector<double>>& speeds) const {
    constexpr double kTooLarge = 1e6, kAway = 0.02, kLeastSetting = 0.1, kRounding = 1 + 1e-9;
    const std::vector<double> rates = machine_.rates.empty() ? std::vector<double>{1} : machine_.rates;
    const double most = rates.back() * greatest_gain() * kRounding;
    const double least =
        (machine_.input_gains.empty() ? 1 : machine_.input_gains.front()) * kLeastSetting / kRounding;
    double cost = kAway * std::abs(std::log10(time));
    for (const std::vector<double>& of_one : speeds) {
      const double largest = *std::max_element(of_one.begin(), of_one.end()) / time;
      cost += kTooLarge * std::max(0.0, std::log10(largest / most));
      cost += std::max(0.0, std::log10(largest / quick_));
      const double rate = choose_rate(std::min(largest, most), 1, rates, machine_.input_gains);
      for (const double speed : of_one) cost += std::max(0.0, std::log10(least * rate * time / speed));
    }
    return cost;
  }

  const std::vector<CircuitElement>& elements_;
  const std::vector<double>& peaks_;
  double until_;
  const diagram::MachineProfile& machine_;
  double quick_;  ///< [1/s]
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
    for (CircuitTerm& term : circuit_.mode_sources) term.weight /= source_factor(term);
    for (diagram::FlatPhase& phase : flat_.timeline.phases) phase.duration *= scaling_.time;
  }

 private:
  double source_factor(const CircuitTerm& term) const {
    return factor_of(term, circuit_.elements, scaling_.signals);
  }

  void scale(std::size_t e) {
    CircuitElement& element = circuit_.elements[e];
    const double out = scaling_.signals[e];
    diagram::FlatBlock* const block =
        element.block == nullptr
            ? nullptr
            : &flat_.blocks[static_cast<std::size_t>(element.block - flat_.blocks.data())];
    std::vector<double> inputs(element.inputs.size(), scaling_.residuals[e]);
    if (element.role == Role::comparator || element.role == Role::function_generator ||
        element.role == Role::multiplier) {
      for (std::size_t port = 0; port < inputs.size(); ++port)
        inputs[port] = unit_weight(element.inputs[port]);
    }
    for (std::size_t port = 0; port < inputs.size(); ++port) {
      const double factor = has_fixed_level(element, port) ? 1 : inputs[port];
      for (CircuitTerm& term : element.inputs[port].terms)
        term.weight = text::nearest_decimal(term.weight * factor / source_factor(term), kDigits);
    }
    if (block == nullptr) return;
    if (element.role == Role::comparator) {
      scale_comparator(*block, inputs, out);
    } else if (element.role == Role::open_amplifier) {
      scale_open_amplifier(*block, scaling_.residuals[e], out);
    } else {
      for (std::size_t k = 0; k < block->parameters.size(); ++k) {
        if (block->definition->parameters[k].points)
          scale_points(block->points[k], inputs.empty() ? 1 : inputs.front(), out);
        scale_parameter(*block, k, out);
      }
      block->tolerance *= out;
    }
    block->choose_behaviour();
  }

  /// An amplifier of gain μ whose output y counts s times and its residual r = −y/μ counts ρ times has the
  /// gain μ s/ρ; what is added to the residual goes with it. Its capacitor keeps T_c (1 + μ), the time in
  /// which the amplifier integrates the residual; for μ = ∞ that is T_c μ.
  void scale_open_amplifier(diagram::FlatBlock& block, double residual, double out) const {
    double change = 1;  // of T_c
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      const std::string& parameter = block.definition->parameters[k].name;
      double& value = block.parameters[k];
      if (parameter == "gain" && std::isinf(value)) {
        change = residual / out;
      } else if (parameter == "gain") {
        const double scaled = text::nearest_decimal(value * out / residual, kDigits);
        change = (1 + value) / (1 + scaled);
        value = scaled;
      } else {
        scale_parameter(
            block, k, parameter == "offset" || parameter == "drift" || parameter == "noise" ? residual : out);
      }
      if (parameter == "bandwidth") value *= loop_speed_;
    }
    if (const auto capacitor = block.definition->find_parameter("capacitor"))
      block.parameters[*capacitor] *= change;
    block.tolerance *= out;
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
    constexpr double kRounding = 1e-15;  // of a machine unit: a sine of π is nothing to be set
    if (signals == 1 && seconds == 0 && std::abs(value) < kRounding) value = 0;
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

CircuitScaling choose_scaling(const Circuit& circuit, const std::vector<double>& peaks, double until,
                              const diagram::MachineProfile& machine, std::optional<double> time) {
  return Chooser(circuit, peaks, until, machine).choose(time);
}

void apply_scaling(const CircuitScaling& scaling, double loop_speed, Circuit& circuit,
                   diagram::FlatDiagram& flat) {
  Scaler(scaling, loop_speed, circuit, flat).scale();
}

}  // namespace oblique::machine
