// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/solve/linearisation.h>
#include <oblique/solve/loop_gain.h>
#include <oblique/solve/signal_flow.h>

namespace oblique {

/// A mode with less damping counts as badly damped. At ζ = 0.3 a step overshoots by 37 % and an error takes
/// two swings to die to 2 %; a loop of that damping has a phase margin of about 100° ζ = 30°, the least that
/// textbooks on servomechanisms allow.
inline constexpr double kBadDamping = 0.3;

/// What a mode does.
enum class ModeVerdict {
  grows,         ///< ζ < 0
  undamped,      ///< ζ = 0 to rounding
  badly_damped,  ///< ζ < kBadDamping
  well_damped,
};
ModeVerdict verdict_on(const Mode& mode);

/// A mode at the moment when its damping was the least.
struct WorstMode {
  Mode mode;
  double time = 0;  ///< [s]
};

/// The loop of one servo amplifier at the moment when its phase margin was the least.
struct ServoMargin {
  std::size_t state = 0;
  std::optional<OpenLoops::Margin> margin;  ///< nothing where the gain of the loop never passes 1
  double time = 0;                          ///< [s]
};

/// Eigenvalues of the frozen linearisation along a run. They judge a diagram where it moves slowly beside
/// them: a mode that grows at an instant of a fast motion need not grow for long.
struct StabilityReport {
  std::size_t instants = 0;  ///< at how many moments of the run
  /// Of the modes in which servo amplifiers have the greater share, which is the machine's business, and of
  /// the others, which is the problem's own: the one with the least damping ratio.
  std::optional<WorstMode> servo_mode, problem_mode;
  std::optional<WorstMode> slowest_servo;  ///< the servo mode with the largest real part
  std::optional<double> grows_from;        ///< [s] first instant at which a servo mode grows
  std::vector<ServoMargin> margins;        ///< of every servo amplifier, in the order of the states
  std::vector<std::string> left_out;       ///< what was not looked at and why
};

/// Judges a run by its instants. Groups of more than 200 states that act on each other are left out, and of
/// more than 60 the phase margins, since the work grows with the cube: the report then says so.
StabilityReport judge_stability(const Program& program, const SignalFlow& flow,
                                const std::vector<Instant>& instants);

}  // namespace oblique
