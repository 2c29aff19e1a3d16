// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>
#include <oblique/solve/stability/signal_flow.h>

namespace oblique::solve {

/// How the derivatives of a loop depend on the signals.
enum class LoopKind {
  linear,      ///< not at all
  varying,     ///< on signals from outside the loop: its gain changes along the run
  non_linear,  ///< on its own signals
};

/// What feedback makes of one unknown: the output of a servo amplifier or the unknown of an algebraic loop,
/// with the rest of its loop closed and all other states held. Where a loop closes through lags or
/// integrators only, these belong to it, and L(0) is what it has when they have come to rest: infinite
/// behind an integrator.
struct LoopUnknown {
  std::string signal;  ///< path
  /// L(0), positive for negative feedback, at the instant when its magnitude was the least (see OpenLoops).
  /// For a servo amplifier μ ∂r/∂x; infinite for an ideal one; −k for a signal that comes back k-fold.
  double least_gain = 0;
  double least_time = 0;  ///< [s]
  double greatest_gain = 0;
  /// δx/x = −1/L(0) = −1/(μ ∂r/∂x), the static error that the finite gain leaves, in magnitude, where it was
  /// the greatest. Nothing for an unknown without an amplifier: such a loop is exact.
  std::optional<double> static_error;
  int sign = 0;                      ///< of L(0) when the run starts
  std::vector<double> sign_changes;  ///< [s] where L(0) changes its sign, between instants by a straight line
};

/// A feedback loop: of servo amplifiers that act on each other, or an algebraic one.
struct LoopReport {
  bool algebraic = false;
  std::vector<std::string> members;  ///< paths of the blocks on it, in file order
  LoopKind kind = LoopKind::linear;
  std::vector<LoopUnknown> unknowns;
  /// −1/Re of the slowest pole of the loop, all states outside it held, when it was the longest [s].
  /// Nothing for algebraic loops and loops that did not settle everywhere.
  std::optional<double> time_constant;
};

/// Explains every loop by its derivatives at the instants of a run: servo loops in the order of the signals,
/// then algebraic ones. An amplifier that is brought to rest and has no feedback around it is no loop.
std::vector<LoopReport> explain_loops(const network::Program& program, const SignalFlow& flow,
                                      const std::vector<Instant>& instants);

}  // namespace oblique::solve
