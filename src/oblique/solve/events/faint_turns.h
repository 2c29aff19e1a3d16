// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/faint_turn.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/readings/event_functions.h>

namespace oblique::solve {

/// Tells turns that are faint. The event function of a switch that reads a decay comes from afar, ever nearer
/// to zero, and never passes it; its states are known to the absolute tolerance, and one of their errors lets
/// it pass. It is then within its error during the whole step in which it passes, and so slow that in all the
/// time that it took to come it would not have moved by more than some errors. So is each half-wave of an
/// oscillation that has decayed, what never came farther than its errors, and what turns back within them: a
/// level that is as high as an amplitude. Not installed.
class FaintTurns {
 public:
  /// `span` is the length of the run [s]. All must outlive this.
  FaintTurns(const network::Program& program, network::Workspace& workspace, double span);

  /// Looks how the event functions of the switches that turn over at `at` come there in a step that began at
  /// `from`.
  void approach(double from, double at, const std::vector<std::pair<std::uint32_t, double>>& turned,
                const Interpolant& solution);

  /// Of the switches that were looked at those that are faint, still announced, and not found before; they
  /// then lie behind. The event functions were evaluated last at t; `last_turn` gives when a switch turned
  /// over last [s].
  std::vector<FaintTurn> due(double t, const Announced& announced, EventFunctions& event_functions,
                             const std::function<double(std::uint32_t)>& last_turn);

  /// Adds what events keep to all signals: the discrete states that they set, but segments of tables, which
  /// meet.
  void add_memories(std::vector<double>& signals) const;
  /// Keeps those of the turns that have an effect on the signals and memories, by their values before and
  /// after.
  void keep(std::vector<FaintTurn> turns, const std::vector<double>& before,
            const std::vector<double>& after);
  /// Whether a turn of a switch was found before.
  bool is_known(std::uint32_t s) const;
  /// Whether an event function has been far from zero, beside its error, in the time `since` it turned over
  /// last [s], and is within what errors may come to together now; not among turns that come ever more
  /// quickly.
  bool comes_from_afar(double event_function, double error, double excursion, double since) const;
  /// The first of each switch.
  const std::vector<FaintTurn>& found() const { return found_; }

 private:
  struct Approach {
    std::uint32_t number = 0;
    double before = 0;     ///< magnitude of the event function where the step began
    double speed = 0;      ///< magnitude of its rate at the turn [1/s]
    double overshoot = 0;  ///< how far it gets if it goes on to slow down as before
  };

  bool evaluate(double t, const Interpolant& solution);
  bool is_faint(const Approach& approach, double error, double excursion, double t, double last_turn) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  double span_;
  std::vector<std::uint32_t> memories_;  ///< see `add_memories`
  std::vector<Approach> approaches_;
  std::vector<double> farthest_;  ///< of each event function: how far from zero it has been
  std::vector<double> states_, rates_, event_functions_, event_function_rates_;
  std::vector<FaintTurn> found_;
};

}  // namespace oblique::solve
