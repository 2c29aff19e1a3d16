// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/level_rest.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/event_functions.h>

namespace oblique::solve {

/// Comparisons whose own turn stops what they compare, as that of the current of a thyristor which it cuts
/// off. They rest at their level from then on, and no longer hold there; that they do is a matter of the
/// least offset. It is told as soon as it makes a difference: to a rate, or to what an event sets. Not
/// installed.
class RestingComparisons {
 public:
  /// `announced` are the switches that are due; `span` is the length of the run [s]. All must outlive this.
  RestingComparisons(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                     EventFunctions& event_functions, const Announced& announced, EventLog& log, double span);

  /// A new instant, with the event functions evaluated: the units of the switches that are announced have
  /// come to their levels.
  void begin_instant();
  /// Of these, where all is settled and no event is due: puts the first that rests there, as its turn and
  /// what followed have left it, where none of its comparisons holds. True where there was one: events may
  /// follow.
  bool lower(double t, std::span<const double> x);
  /// Looks at (t, x), where no event has been served yet that is due, whether it makes a difference that the
  /// comparisons do not hold which were put so; those that have left their levels do not count any more.
  void look(double t, std::span<const double> x);
  /// Whether a unit is one that was put so.
  bool contains(std::uint32_t unit) const;

 private:
  /// What follows from the positions of all switches.
  struct Sequel {
    std::vector<double> rates;    ///< dx/dt
    std::vector<bool> holds;      ///< of each event
    std::vector<double> changes;  ///< by each action of each event: none where its condition does not hold
  };
  struct Came {
    std::uint32_t unit = 0;
    double event_function = 0;  ///< when the instant began
  };
  struct Resting {
    std::uint32_t unit = 0;
    double since = 0;
    std::vector<double> turned;           ///< where its own turn has put its switches
    std::vector<bool> held, held_turned;  ///< the conditions of the events, as looked at last
  };
  bool holds_at_level(const Came& came) const;
  bool stands_still(std::uint32_t unit);
  void add(std::uint32_t unit, std::vector<double> turned, double t, std::span<const double> x);
  void remove(std::uint32_t unit);
  bool follow(double t, std::span<const double> x, Sequel& sequel);
  /// Both sequels of one that rests: as it is, and with its switches turned.
  bool follow_both(const Resting& of, double t, std::span<const double> x);
  bool rates_differ() const;
  bool comes_otherwise(const Resting& of) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  const SlidingMode& slide_;
  EventFunctions& event_functions_;
  const Announced& announced_;
  EventLog& log_;
  LevelRest level_rest_;
  std::vector<Came> came_;
  std::vector<Resting> resting_;
  Sequel here_, turned_;
  std::vector<double> signals_, derivatives_, rates_, event_functions_turned_;
};

}  // namespace oblique::solve
