// SPDX-License-Identifier: MIT
#include <oblique/machine/scaled_realisation.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/machine/circuit.h>
#include <oblique/machine/circuit_scaling.h>
#include <oblique/machine/element_library.h>
#include <oblique/machine/element_writer.h>
#include <oblique/machine/fixed_levels.h>
#include <oblique/machine/mode_control.h>
#include <oblique/machine/own_drains.h>
#include <oblique/machine/signal_ranges.h>
#include <oblique/machine/tabulated_functions.h>
#include <oblique/solve/solve_error.h>
#include <oblique/text/nearest_decimal.h>

namespace oblique::machine {
namespace {

/// The machine without any errors, so that a diagram written for it says all of its own.
diagram::MachineProfile without_errors(diagram::MachineProfile machine) {
  machine.errors.clear();
  return machine;
}

/// Elements without a role that are still there, and do not say what they take of a machine's, have no place
/// on any.
void check_elements(const Circuit& circuit, const diagram::MachineProfile& machine) {
  std::map<std::string, std::vector<const CircuitElement*>> others;  // by the names of their blocks
  for (const CircuitElement& element : circuit.elements) {
    if (element.role == Role::other && !element.logic) others[element.definition->name].push_back(&element);
  }
  text::Diagnostics diagnostics;
  for (const auto& [block, elements] : others) {
    std::vector<std::string> names;
    for (const CircuitElement* const element : elements) names.push_back("'" + element->path + "'");
    diagnostics.add(
        {elements.front()->block->place,
         fmt::format("the machine {} has no {}, which {} {}, and no circuit of its elements for it",
                     machine.title, block, fmt::join(names, ", "), names.size() == 1 ? "is" : "are"),
         "amplifiers, potentiometers, multipliers, comparators, and functions of one signal",
         "build it of these"});
  }
  diagnostics.throw_if_any<RealiseError>();
}

std::string names_of(const std::vector<TabulatedFunction>& functions) {
  std::vector<std::string> names;
  names.reserve(functions.size());
  for (const TabulatedFunction& function : functions) names.push_back("'" + function.path + "'");
  return fmt::format("{}", fmt::join(names, ", "));
}

/// The time of the run, and of what is expected and was published of it, on the machine.
diagram::Diagram in_machine_time(diagram::Diagram diagram, double time) {
  if (time == 1) return diagram;
  constexpr int kDigits = 15;  // 3 times 0.2 s are 0.6 s
  const auto moved = [time](double moment) { return text::nearest_decimal(moment * time, kDigits); };
  diagram.run.until = moved(diagram.run.until);
  if (diagram.run.max_step) diagram.run.max_step = moved(*diagram.run.max_step);
  const auto move = [&](diagram::Expectation& expectation) {
    if (expectation.kind == diagram::Expectation::Kind::period) {
      expectation.value = moved(expectation.value);
      expectation.within = moved(expectation.within);
    }
    if (expectation.kind != diagram::Expectation::Kind::at_time) return;
    expectation.time = moved(expectation.time);
    expectation.text = diagram::expectation_key(expectation);
  };
  std::for_each(diagram.expectations.begin(), diagram.expectations.end(), move);
  if (diagram.published) {
    for (diagram::PublishedValue& value : diagram.published->values) move(value.expected);
  }
  return diagram;
}

/// The peaks of all signals of a diagram by name.
std::unordered_map<std::string, double> peaks_of(const diagram::FlatDiagram& flat,
                                                 const diagram::RunSettings& run) {
  std::unordered_map<std::string, double> peaks;
  const std::vector<SignalRange> ranges = signal_ranges(flat, run);
  std::size_t signal = 0;
  for (const diagram::FlatBlock& block : flat.blocks) {
    double& peak = peaks[block.path];
    for (std::size_t k = 0; k < block.definition->outputs.size(); ++k)
      peak = std::max(peak, ranges[signal++].peak());
  }
  return peaks;
}

}  // namespace

class MachineScaling::State {
 public:
  State(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
        const diagram::MachineProfile& machine, const ScalingOptions& options)
      : diagram_(diagram),
        library_(library),
        elements_(element_library(library)),
        machine_(machine),
        time_(options.time) {
    const diagram::FlatDiagram own = diagram::flatten_on_ideal_elements(diagram, library);
    flat_ = in_circuits();
    wire_drains(flat_);
    const bool has_functions = std::any_of(flat_.blocks.begin(), flat_.blocks.end(), [&](const auto& block) {
      return may_be_tabulated(block.definition->role, machine);
    });
    if (has_functions) {
      functions_ = tabulate_functions(flat_, elements_, machine, signal_ranges(flat_, diagram.run),
                                      diagram.run.until, options.segments);
    }
    prepare_modes(flat_, own, elements_, machine);
    circuit_ = reduce(flat_, elements_, most_weight_of_one(machine));
    check_elements(circuit_, machine);
    const Realisation unscaled = write_elements(diagram, flat_, elements_, without_errors(machine), circuit_);
    const auto peaks = [&] {
      try {
        return peaks_of(diagram::flatten_on_ideal_elements(unscaled.diagram, library_), diagram.run);
      } catch (const solve::SolveError& error) {
        if (functions_.empty()) throw;
        throw RealiseError(
            text::Diagnostic{{diagram.file, {}},
                             fmt::format("with straight lines in the place of {} it does not run: {}",
                                         names_of(functions_), error.diagnostics().front().what),
                             {},
                             text::Remedy{"more lines or fewer (", text::Setting{"segments"},
                                          "), or a servo amplifier elsewhere than about a function"}});
      }
    }();
    for (const std::string& element : unscaled.elements) peaks_.push_back(peaks.at(element));
    check_levels(circuit_, peaks_);
    ideal_peaks_ = peaks_;
  }

  ScaledRealisation realise(double loop_speed) const {
    const CircuitScaling scaling = choose_scaling(circuit_, peaks_, diagram_.run.until, machine_, time_);
    diagram::FlatDiagram flat = flat_;
    Circuit circuit = circuit_;
    for (CircuitElement& element : circuit.elements) {
      if (element.block != nullptr)
        element.block = flat.blocks.data() + (element.block - flat_.blocks.data());
    }
    apply_scaling(scaling, loop_speed, circuit, flat);
    for (std::size_t k = 0; k < flat.outputs.size(); ++k) {
      // What was a machine unit of the diagram's is none of the machine's.
      const bool scaled = circuit.outputs[k].weight != circuit_.outputs[k].weight;
      if (scaled && flat.outputs[k].unit == "machine unit") flat.outputs[k].unit = "1";
    }
    Realisation written =
        write_elements(in_machine_time(diagram_, scaling.time), flat, elements_, machine_, circuit);
    ScaledRealisation result{std::move(written.diagram), scaling.time, {}, {}};
    for (std::size_t e = 0; e < written.elements.size(); ++e)
      result.scales.push_back({written.elements[e], 1 / scaling.signals[e], peaks_[e] * scaling.signals[e]});
    for (const TabulatedFunction& function : functions_)
      result.functions.push_back(
          {function.path, function.block, function.segments, function.low, function.high, function.error});
    return result;
  }

  double make_room(const ScaledRealisation& realised, std::int64_t most_steps) {
    auto peaks = peaks_by_name(realised.diagram, most_steps);
    // What goes beyond the unit by an inverter's own error is the signal that it inverts.
    const diagram::FlatDiagram flat = diagram::flatten(realised.diagram, library_);
    for (const diagram::FlatBlock& block : flat.blocks) {
      if (block.definition->role != diagram::Role::inverter || block.inputs.front().terms.empty()) continue;
      double& inverted = peaks.at(flat.blocks[block.inputs.front().terms.front().signal.block].path);
      inverted = std::max(inverted, peaks.at(block.path));
    }
    double excess = 0;
    for (std::size_t e = 0; e < realised.scales.size(); ++e) {
      const double peak = peaks.at(realised.scales[e].signal);
      if (peak <= 1 + diagram::kOverloadTolerance) continue;
      excess = std::max(excess, peak - 1);
      if (is_product(circuit_.elements[e].role)) {
        std::vector<bool> seen(peaks_.size(), false);
        give_factors_room(e, peak, seen);
      } else {
        give_room(e, peak * realised.scales[e].unit);
      }
    }
    return excess;
  }

 private:
  /// The diagram with circuits of elements in the place of blocks that no machine has. What it may say of a
  /// block is here what the circuit allows.
  diagram::FlatDiagram in_circuits() const {
    try {
      return diagram::flatten_on_ideal_elements(diagram_, elements_);
    } catch (const diagram::DiagramError& error) {
      text::Diagnostics told;
      for (text::Diagnostic diagnostic : error.diagnostics()) {
        diagnostic.remedy = fmt::format("the elements of {} make no other one", machine_.title);
        told.add(std::move(diagnostic));
      }
      told.throw_if_any<RealiseError>();
      throw;
    }
  }

  /// What is to go twice as far as on ideal elements is not what the diagram computes: it gets no room.
  void give_room(std::size_t e, double wanted) {
    constexpr double kMost = 2;
    peaks_[e] = std::max(peaks_[e], std::min(wanted, kMost * ideal_peaks_[e]));
  }

  /// The scale of a product is that of its factors, so that these get `by` times the room.
  void give_factors_room(std::size_t product, double by, std::vector<bool>& seen) {
    for (const CircuitInput& input : circuit_.elements[product].inputs) {
      for (const CircuitTerm& term : input.terms) {
        if (!term.signal || seen[term.signal->block]) continue;
        const std::size_t factor = term.signal->block;
        seen[factor] = true;
        if (circuit_.elements[factor].role == Role::comparator) continue;  // has its levels and no more
        if (is_product(circuit_.elements[factor].role)) {
          give_factors_room(factor, by, seen);
        } else {
          give_room(factor, by * peaks_[factor]);
        }
      }
    }
  }

  /// Where no amplifier saturates: a peak that is cut off tells no scale.
  std::unordered_map<std::string, double> peaks_by_name(const diagram::Diagram& diagram,
                                                        std::int64_t most_steps) const {
    diagram::RunSettings run = diagram.run;
    run.max_steps = std::min(run.max_steps, most_steps);
    return peaks_of(diagram::without_saturation(diagram::flatten(diagram, library_)), run);
  }

  const diagram::Diagram& diagram_;
  const diagram::BlockLibrary& library_;
  diagram::BlockLibrary elements_;
  const diagram::MachineProfile& machine_;
  std::optional<double> time_;
  diagram::FlatDiagram flat_;  ///< unscaled, as `circuit_`, which refers to it
  std::vector<TabulatedFunction> functions_;
  Circuit circuit_;
  std::vector<double> peaks_;        ///< of each element, unscaled
  std::vector<double> ideal_peaks_;  ///< the same without room
};

MachineScaling::MachineScaling(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                               const diagram::MachineProfile& machine, const ScalingOptions& options)
    : state_(std::make_unique<State>(diagram, library, machine, options)) {}

MachineScaling::~MachineScaling() = default;

ScaledRealisation MachineScaling::realise(double loop_speed) const {
  return state_->realise(loop_speed);
}

double MachineScaling::make_room(const ScaledRealisation& realised, std::int64_t most_steps) {
  return state_->make_room(realised, most_steps);
}

ScaledRealisation realise_scaled(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine, const ScalingOptions& options) {
  return MachineScaling(diagram, library, machine, options).realise();
}

}  // namespace oblique::machine
