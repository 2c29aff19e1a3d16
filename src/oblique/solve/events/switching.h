// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/edge_values.h>
#include <oblique/solve/events/event_actions.h>
#include <oblique/solve/events/event_location.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/faint_turns.h>
#include <oblique/solve/events/loop_jumps.h>
#include <oblique/solve/events/resting_comparisons.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/events/switch_settling.h>
#include <oblique/solve/events/wrong_sides.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/interruption.h>
#include <oblique/solve/readings/event_functions.h>
#include <oblique/solve/readings/independent_units.h>

namespace oblique::solve {

/// The discrete states of one run: finds the times at which switches turn over, and settles everything there.
///
/// A switch is latched: between events it keeps its position, and the equations go on smoothly past its
/// event function. It turns over where its event function has passed zero by more than rounding
/// (EventLocation finds the time). Then all switches, algebraic loops (SwitchSettling) and the events that
/// they set off (EventActions) are settled to a fixed point at that one instant, simultaneous and secondary
/// ones included. Switches that lie on their switching surfaces go where the solution takes them; where no
/// combination of their positions agrees with where it would take them, they slide (SlidingMode), unless an
/// event function depends on its own switch: then the other positions of the algebra around it are tried.
/// EventLog keeps what is reported. Not installed.
class Switching {
 public:
  /// `file` names the diagram in messages; `span` is the length of the run [s], `tolerance` the relative one
  /// of the states, `absolute_tolerance` that of those without one of their own. All must outlive this.
  Switching(const network::Program& program, network::Workspace& workspace, double span, double tolerance,
            double absolute_tolerance, const std::string& file);

  /// Whether there is anything to watch.
  bool active() const { return !program_.switches().empty() || !program_.events().empty(); }

  /// Puts the switches of an algebraic loop where these unknowns ask for them, before the start.
  void place_loop(std::size_t loop, const std::vector<double>& unknowns, double t,
                  std::span<const double> x) {
    loop_jumps_.place(loop, unknowns, t, x);
  }
  /// Lets the amplifiers of a loop whose branch has ended at (t, x) go to where a switch on it, as a limit,
  /// lets them rest; false where there is no such place.
  bool go_past_branch_end(std::size_t lost, double t, std::span<const double> x) {
    return loop_jumps_.go_past_branch_end(lost, t, x);
  }
  /// Of each algebraic loop: whether its elements would leave the solution at (t, x). (See LoopJumps.)
  std::vector<bool> loops_that_run_away(double t, std::span<const double> x) {
    return loop_jumps_.run_away(t, x);
  }

  /// Settles switches and events at the start of the run, and the states that start from signals.
  /// `bring_to_rest` is called whenever something has changed that servo loops may follow; it throws
  /// SolveError where they do not settle. With `loops_go` the algebraic loops without amplifiers, and those
  /// of amplifiers that would run away from between their limits, go to where their elements take them from
  /// the guesses; else they stay where Newton's method finds them. Throws SolveError.
  void start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest, bool loops_go);

  /// Settles everything at time t, after the switches that `known_wait` or `search` announced have turned
  /// over. Throws SolveError.
  void settle(double t, std::vector<double>& x);

  /// How long after t the next switch that follows time alone turns over [s]; nothing where none does.
  std::optional<double> known_wait(double t, std::span<const double> x,
                                   EventLocation::Of which = EventLocation::Of::all) {
    return location_.known_wait(t, x, which);
  }
  /// Whether the switches that followed time alone and turned over last act on nothing, as far as is known:
  /// no smooth segment of the run then ends where they turn over.
  void let_pass(bool pass) { location_.let_pass(pass); }
  bool lets_pass() const { return location_.lets_pass(); }

  /// Ends a run in which something is always due. Throws SolveError.
  [[noreturn]] void throw_endless(double t) const;

  /// The first time after `from` at which a switch turns over, or nothing; all are in place at `from`.
  /// `sample_times` are times at which to look at least; the search ends at the last.
  std::optional<double> search(double from, std::span<const double> sample_times,
                               const Interpolant& solution);

  /// All event functions at (t, x), and what else follows there. Throws SolveError.
  const network::Evaluation& evaluate(double t, std::span<const double> x);

  /// Where the smooth segment lies that begins now [s]. What has no value on an edge of it, where rounding
  /// decides whether √(1 − t) is still real, and 0 · ln 0 is nothing, is taken a moment inside.
  void lies_between(double begin, double end) {
    begin_ = begin;
    end_ = end;
  }

  /// The solver stands at (t, x): what has no value beyond the edge of a branch has that of its last place
  /// inside.
  void stand_at(double t, std::span<const double> x) { edges_.stand_at(t, x); }

  /// dx/dt, its Jacobian and all signals, with what slides held on its switching surfaces.
  bool derivatives(double t, const double* x, double* dxdt);
  bool jacobian(double t, const double* x, double* values);
  /// See SlidingMode; nothing for what stands.
  void leave_slides_where_they_are(bool leave) { slide_.leave_where_it_is(leave); }
  bool way_back(double t, const double* x, double h, double* change);
  bool signals(double t, const double* x, double* values);

  /// A step of this length [s] has led to where events are searched for next, by a method that damps what is
  /// fast, or not; 0: there has been none.
  void take_step(double length, bool damps = true) {
    event_functions_.take_steps(length, slide_.units());
    wrong_sides_.take_step(damps);
  }

  /// The solution within a step that ends at t, by which to look at it: with its errors damped where an event
  /// function is so small that these would tell its side. `solution` must last as long as that is used.
  const Interpolant& looked_at(double t, const Interpolant& solution);

  void limit_samples(double samples) { location_.limit_samples(samples); }
  /// Whoever evaluates or settles then throws Interrupted; but `derivatives` and `jacobian`, which solvers
  /// call that know no exceptions.
  void end_when(const Interruption& interruption);
  /// The size [machine unit] down to which each state is known relatively; 0: as its absolute tolerance says.
  void know_states(std::span<const double> reach) { event_functions_.know_states(reach); }
  /// Where the run ends [s]: what would come later is not told of.
  void end_at(double t) { actions_.end_at(t); }
  /// The run has ended at t.
  void end(double t) {
    actions_.end(t);
    log_.look_along(slide_, t);
  }

  bool slides() const { return slide_.active(); }
  /// Whether what slides mixes the solution of an algebraic loop.
  bool mixes(std::size_t loop) const { return slide_.mixes(loop); }
  /// Marks the states that the event functions read of what slides at (t, x).
  void mark_held(double t, const double* x, std::vector<bool>& held);
  const network::Workspace& workspace() const { return workspace_; }

  const EventLog& log() const { return log_; }
  /// The first turn of each switch about which rounding has decided.
  const std::vector<FaintTurn>& faint_turns() const { return faint_turns_.found(); }

  /// What must be kept to go on later: whether each condition held, and whether each switch slides or rests
  /// at zero along with what does.
  const std::vector<bool>& conditions() const { return actions_.conditions(); }
  /// The events that came when everything was settled last, in this order.
  const std::vector<std::size_t>& served() const { return actions_.served(); }
  std::vector<bool> sliding() const;
  /// `resume` is to follow. Empty `sliding`: it is not known.
  void restore(std::vector<bool> conditions, std::vector<bool> sliding) {
    actions_.restore(std::move(conditions));
    settling_.restore(std::move(sliding));
  }
  /// Goes on from what was restored, at time t. Throws SolveError.
  void resume(double t, std::vector<double>& x);

 private:
  template <class Evaluate>
  bool inside(double t, std::span<const double> values, const Evaluate& evaluate) const;
  std::vector<SlidingMode::Doubt> doubts_of_slide(double t, std::span<const double> x);
  std::optional<EventActions::Effect> serve_events(double t, std::vector<double>& x, bool starting);
  void settle_switches(double t, std::span<const double> x);
  void put_on_levels(double t, std::vector<double>& x);
  void stand_rows(std::span<double> entries) const;
  std::vector<double> readings(double t, std::span<const double> x);
  bool look_at_hidden(double t, const Interpolant& solution);
  void look_at_miss(const EventSearch::NearMiss& miss, const Interpolant& solution);
  template <class Put>
  void each_due(const Put& put) const;
  void put_what_is_due();
  template <class Action>
  void let_loops_go(double t, std::span<const double> x, const Action& action);
  void record_slides(const std::vector<std::uint32_t>& before, const std::vector<SlidingMode::Doubt>& doubts,
                     double t, std::span<const double> x);
  void record_turns(const std::vector<double>& before, double t);

  const network::Program& program_;
  network::Workspace& workspace_;
  const std::string& file_;
  double tolerance_;
  Interruption interruption_;
  EventLog log_;
  EdgeValues edges_;
  IndependentUnits independent_;
  SlidingMode slide_;
  EventFunctions event_functions_;
  EventLocation location_;
  SwitchSettling settling_;
  RestingComparisons resting_;
  WrongSides wrong_sides_;
  EventActions actions_;
  FaintTurns faint_turns_;
  LoopJumps loop_jumps_;
  std::vector<std::optional<std::size_t>> lone_states_;  ///< of each unit
  std::vector<std::size_t> still_;                       ///< states that stand as long as what slides does
  double begin_ = -std::numeric_limits<double>::infinity(), end_ = std::numeric_limits<double>::infinity();
  std::vector<std::uint32_t> marked_;  ///< the units of the slide whose states were marked last
  int hops_ = 0;                       ///< of tables, one after the other at one instant
};

}  // namespace oblique::solve
