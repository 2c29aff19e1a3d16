// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/disturbance_growth.h>
#include <oblique/solve/stability/linearisation.h>
#include <oblique/solve/stability/loop_gain.h>
#include <oblique/solve/stability/signal_flow.h>

namespace oblique::solve {

/// A mode with less damping counts as badly damped. At ζ = 0.3 a step overshoots by 37 % and an error takes
/// two swings to die to 2 %; a loop of that damping has a phase margin of about 100° ζ = 30°, the least that
/// textbooks on servomechanisms allow.
inline constexpr double kBadDamping = 0.3;

/// What a mode does.
enum class ModeVerdict {
  grows,         ///< ζ < 0
  undamped,      ///< ζ = 0 to rounding, of the number or of the eigenvalue
  badly_damped,  ///< ζ < kBadDamping
  well_damped,
};
ModeVerdict verdict_on(const Mode& mode);

/// A mode at the moment when it was the worst.
struct WorstMode {
  Mode mode;
  double time = 0;  ///< [s]
  /// What the mode would be on an ideal machine; nothing for one that comes from the machine, and where there
  /// is no machine in it.
  std::optional<std::complex<double>> ideal_pole = {};
};

/// The same, but an oscillator that is undamped on an ideal machine stays so while the real one changes its
/// amplitude by no more than a millionth a radian.
ModeVerdict verdict_on(const WorstMode& worst);

/// What is judged of the whole closed system.
enum class StabilityVerdict {
  no_feedback,         ///< no state acts back on itself between events
  stable,              ///< every mode decays, and small disturbances of a system that varies do too
  stable_when_frozen,  ///< every mode decays at each instant; what the changes do between them is not known
  undamped,            ///< a mode neither decays nor grows, none grows
  grows,               ///< the problem itself grows
  grows_at_times,      ///< a mode of the problem grows at some instants, small disturbances not throughout
  servos_unstable,     ///< a mode grows that the problem does not have: the machine's
  not_told,
};

/// The loop of one servo amplifier at the moment when its phase margin was the least.
struct ServoMargin {
  std::size_t state = 0;
  std::optional<OpenLoops::Margin> margin;  ///< nothing where the gain of the loop never passes 1
  double time = 0;                          ///< [s]
};

/// Eigenvalues of the frozen linearisation of the closed system along a run. Alone they judge a diagram where
/// it moves slowly beside them: a mode that grows at an instant of a fast motion need not grow for long, and
/// a system that varies may grow although no frozen mode does. So the growth of small disturbances along the
/// run stands beside them.
struct StabilityReport {
  std::size_t instants = 0;  ///< at how many moments of the run
  StabilityVerdict verdict = StabilityVerdict::not_told;
  /// Whether all modes are known, or proven to decay where a large group was only searched for them.
  bool proven = true;
  /// The mode with the largest real part of all, and whether it comes from the machine.
  std::optional<WorstMode> rightmost;
  bool rightmost_is_servo = false;
  std::size_t growing = 0;  ///< most eigenvalues right of the axis at one instant; of a large group: found
  bool switches = false;    ///< whether there are switches, which may bring back what the modes do not show
  bool varies = false;      ///< whether the derivatives change along the run
  std::optional<DisturbanceGrowth> growth;  ///< along the run, where it varies and was followed
  /// Of the modes that come from the machine (the problem does not have them on an ideal one, see
  /// IdealMachine), and of those that are the problem's own: the one with the least damping ratio.
  std::optional<WorstMode> servo_mode, problem_mode;
  std::optional<WorstMode> slowest_servo;  ///< the servo mode with the largest real part
  std::optional<double> grows_from;        ///< [s] first instant at which a servo mode grows
  std::vector<ServoMargin> margins;        ///< of every amplifier of a servo loop, in the order of the states
  std::vector<std::string> left_out;       ///< what was not looked at and why
};

/// Judges a run by its instants. Groups of more than 200 states that act on each other are searched for their
/// rightmost modes (see rightmost_modes), at three instants; dense ones at fewer instants the larger they
/// are. Phase margins are sought in groups of up to 60 states. What is left out the report says. `growth` is
/// that along the run, where it is known. Without `margins`, which take most of the time, the verdict and the
/// modes are the same.
StabilityReport judge_stability(const network::Program& program, const SignalFlow& flow,
                                const std::vector<Instant>& instants,
                                const std::optional<DisturbanceGrowth>& growth = {}, bool margins = true);

}  // namespace oblique::solve
