// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/circuit.h>

// Not installed.
namespace oblique::machine {

/// The scale factors of a circuit: an element shows `signals` times what it stands for, and 1 s of the
/// diagram takes `time` seconds of the machine.
struct CircuitScaling {
  std::vector<double> signals;    ///< of each element
  std::vector<double> residuals;  ///< of each open amplifier, what is at its inputs; `signals` of the others
  double time = 1;
};

/// The factors with which a circuit uses most of the machine unit. `peaks` are the largest magnitudes of the
/// elements over the run of `until` seconds, unscaled. Nothing depends on the units of the diagram.
///
/// - Amplifiers and function generators take the largest factor of two digits with which their peak stays
///   within the machine unit, so that more than nine tenths of it are used; comparators by their levels. What
///   is less than a billionth of what its inputs could make of it is nothing. A summer takes less where an
///   input would be weighted more than the machine's greatest gain: that is amplified noise. In logarithms
///   these are bounds on differences, whose greatest solution is found by relaxation.
/// - The residual of an open amplifier is scaled so that its largest weight lies between 1 and the greatest
///   gain, and the gain of the amplifier with it.
/// - A multiplier is fed by weights of ±1, and has the product of the factors there.
/// - What is compared with a fixed level keeps its signals: the input `set` of an integrator, the clock of a
///   counter; and so do levels that come out. What else a block without a role carries has one factor.
/// - `time`, unless given, is the 1-2-5 step next to 1 with which no integrator needs an input weighted more
///   than the greatest gain at the greatest time factor, potentiometers before integrators are as far as may
///   be set to a tenth or more, and integrators are slow beside the bandwidth of their amplifiers.
CircuitScaling choose_scaling(const Circuit& circuit, const std::vector<double>& peaks, double until,
                              const diagram::MachineProfile& machine, std::optional<double> time);

/// Brings a circuit into its scale: weights, and the parameters of the blocks of `flat`, which it was reduced
/// from. Servo amplifiers besides are slower by `loop_speed` (at most 1). With ideal elements the outputs are
/// what they were.
void apply_scaling(const CircuitScaling& scaling, double loop_speed, Circuit& circuit,
                   diagram::FlatDiagram& flat);

}  // namespace oblique::machine
