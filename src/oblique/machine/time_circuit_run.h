// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/machine/time_circuit.h>

// Not installed.
namespace oblique::machine {

/// Draws the signals of a circuit over a run of `until` [s]: gives its functions the ranges of their
/// arguments, and tells how much larger its signals are than what becomes of them. False where one is not
/// finite, or is over too soon to be looked at.
bool look_over_run(TimeCircuit& circuit, double until);

}  // namespace oblique::machine
