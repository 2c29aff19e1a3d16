// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/readings/thresholds.h>

namespace oblique::solve {

/// Comparisons whose own turn stops what they compare, as that of the current of a thyristor which it cuts
/// off. They rest at their level from then on, and no longer hold there; that they do is a matter of the
/// least offset. It is told as soon as it makes a difference: to a rate, or to what an event sets. Not
/// installed.
class RestingComparisons {
 public:
  /// All must outlive this.
  RestingComparisons(const network::Program& program, network::Workspace& workspace,
                     const Thresholds& thresholds, EventLog& log);

  bool any() const { return !resting_.empty(); }
  /// A unit has come to rest at (t, x) by its own turn, which put its switches into the positions `turned`,
  /// in the order of the unit.
  void add(std::uint32_t unit, std::vector<double> turned, double t, std::span<const double> x);
  /// A unit has left its level.
  void remove(std::uint32_t unit);
  /// Looks at all at (t, x), before events are served there.
  void look(double t, std::span<const double> x);
  std::vector<std::uint32_t> units() const;

 private:
  /// What follows from the positions of all switches.
  struct Sequel {
    std::vector<double> rates;    ///< dx/dt
    std::vector<bool> holds;      ///< of each event
    std::vector<double> changes;  ///< by each action of each event: none where its condition does not hold
  };
  struct Resting {
    std::uint32_t unit = 0;
    double since = 0;
    std::vector<double> turned;
    std::vector<bool> held, held_turned;  ///< the conditions of the events, as looked at last
  };
  bool follow(double t, std::span<const double> x, Sequel& sequel);
  /// Both sequels of one that rests: as it is, and with its switches turned.
  bool follow_both(const Resting& of, double t, std::span<const double> x);
  bool rates_differ() const;
  bool comes_otherwise(const Resting& of) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  const Thresholds& thresholds_;
  EventLog& log_;
  std::vector<Resting> resting_;
  Sequel here_, turned_;
  std::vector<double> signals_, event_functions_;
};

}  // namespace oblique::solve
