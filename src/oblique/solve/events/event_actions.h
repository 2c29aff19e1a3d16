// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/event_pace.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/events/switch_settling.h>
#include <oblique/solve/events/uncertain_readings.h>
#include <oblique/solve/readings/event_functions.h>
#include <oblique/solve/readings/independent_units.h>

namespace oblique::solve {

/// Serves events: which have come, what they set, and their Zeno behaviour. Not installed.
class EventActions {
 public:
  /// All must outlive this; `span` is the length of the run [s], and `file` names the diagram in messages.
  EventActions(const network::Program& program, network::Workspace& workspace,
               const EventFunctions& event_functions, const SlidingMode& slide,
               const SwitchSettling& settling, IndependentUnits& independent, EventLog& log, double span,
               const std::string& file);

  /// Where the run ends [s]: Zeno behaviour that would be complete later is none.
  void end_at(double t) { end_ = t; }

  /// A new instant: no event has come at it yet, and the discrete states are as they are before it.
  void begin_instant() {
    came_.assign(came_.size(), false);
    served_.clear();
    jumped_ = false;
    uncertain_.begin_instant(workspace_.discrete_states());
  }

  /// What events have done at one instant.
  struct Effect {
    bool sets_states = false;
    bool jumps = false;               ///< a state has another value now
    bool tables = false;              ///< nothing has come but that tables were moved along
    bool before_start = false;        ///< nothing but what was so before the run
    std::vector<std::size_t> events;  ///< that have been served
  };
  /// Serves all events whose conditions have become true at (t, x), where all event functions were evaluated;
  /// while `starting` only those that come at a start. Nothing where there are none. Throws SolveError.
  std::optional<Effect> serve(double t, std::vector<double>& x, bool starting);

  /// The events that have been served since this instant began, or at the start, in this order.
  const std::vector<std::size_t>& served() const { return served_; }

  /// The run ends at t: tells of events that came ever faster, and then no more.
  void end(double t);

  /// Whether the condition of each event held when it was last looked at: what must be kept to go on later.
  const std::vector<bool>& conditions() const { return held_; }
  void restore(std::vector<bool> conditions) { held_ = std::move(conditions); }

 private:
  /// An event that has come, and whether its own actions have led back to its condition.
  struct Come {
    std::size_t event;
    bool at_once;
  };
  struct Change {
    const network::Event::Action* action;
    double value;
  };

  std::vector<Come> look(double t, std::span<const double> x, bool starting);
  bool is_of_slide(std::size_t event) const;
  bool is_led_by_what_came(std::size_t s);
  bool comes_at_once(std::size_t event, double t, std::span<const double> x);
  bool is_any_to_pile_up(double t) const;
  bool is_zeno(const Come& come, double t);
  void look_for_lost(std::size_t event, double t);
  void add_changes(std::size_t event, const network::SignalEvaluation& here, double t,
                   std::vector<Change>& changes) const;
  void put_in_chain(const std::vector<std::size_t>& events, double t, std::vector<double>& x);

  const network::Program& program_;
  network::Workspace& workspace_;
  const EventFunctions& event_functions_;
  const SlidingMode& slide_;
  const SwitchSettling& settling_;
  IndependentUnits& independent_;
  EventLog& log_;
  double span_;
  double end_ = std::numeric_limits<double>::infinity();  ///< [s] of the run
  const std::string& file_;
  std::vector<bool> held_;           ///< see `conditions`
  std::vector<bool> came_;           ///< of each event that sets states: whether it came at this instant
  std::vector<std::size_t> served_;  ///< see `served`
  bool jumped_ = false;              ///< whether states have at this instant, by what events set
  std::vector<EventPace> paces_;
  bool told_of_lost_ = false;
  double piled_up_ = -std::numeric_limits<double>::infinity();  ///< when one last went over into another [s]
  UncertainReadings uncertain_;
  std::vector<double> signals_;
  std::vector<std::vector<std::uint32_t>>
      movers_;  ///< of each event: the switches by which tables move along
};

}  // namespace oblique::solve
