// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_pace.h>
#include <oblique/solve/events/event_search.h>
#include <oblique/solve/events/faint_turns.h>
#include <oblique/solve/events/positions.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/interruption.h>

namespace oblique::solve {

/// Something that happened between two smooth stretches of a run.
struct EventRecord {
  double time = 0;  ///< [s]
  std::string what;
};

/// The memories of one run: finds the times at which switches turn over, and settles everything there.
///
/// A switch is latched: between events it keeps its position, and the equations go on smoothly past its
/// surface. It turns over where its surface has passed zero by more than rounding. Then all switches,
/// algebraic loops and the events that they set off are settled to a fixed point at that one instant,
/// simultaneous and secondary ones included. Switches that lie on their surfaces go where the solution takes
/// them; where no combination of their positions agrees with where it would take them, they slide (see
/// SlidingMode), unless a surface depends on its own switch: then the other positions of the algebra around
/// it are tried.
class Switching {
 public:
  /// `file` names the diagram in messages; `span` is the length of the run [s], `tolerance` the relative one
  /// of the states, `absolute_tolerance` that of those without one of their own. All must outlive this.
  Switching(const network::Program& program, network::Workspace& workspace, double span, double tolerance,
            double absolute_tolerance, const std::string& file);

  /// Whether there is anything to watch.
  bool active() const { return !program_.switches().empty() || !program_.events().empty(); }

  /// Settles switches and events at the start of the run, and the states that start from signals.
  /// `bring_to_rest` is called whenever something has changed that servo loops may follow; it throws
  /// SolveError where they do not settle. Throws SolveError.
  void start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest);

  /// Settles everything at time t, after the switches that `known_wait` or `search` announced have turned
  /// over. Throws SolveError.
  void settle(double t, std::vector<double>& x);

  /// How long after t the next switch that follows time alone turns over [s]; infinite without one.
  double known_wait(double t, std::span<const double> x);

  /// Ends a run in which something is always due. Throws SolveError.
  [[noreturn]] void throw_endless(double t) const;

  /// The first time after `from` at which a switch turns over, or nothing; all are in place at `from`.
  /// `looks` are times at which to look at least; the search ends at the last.
  std::optional<double> search(double from, std::span<const double> looks, const Interpolant& solution);

  /// dx/dt, its Jacobian and all signals, with what slides held on its surfaces.
  bool derivatives(double t, const double* x, double* dxdt);
  bool jacobian(double t, const double* x, double* values);
  bool signals(double t, const double* x, double* values);

  void limit_looks(double looks) { search_.limit_looks(looks); }
  /// Whoever evaluates or settles then throws Interrupted; but `derivatives` and `jacobian`, which solvers
  /// call that know no exceptions.
  void end_when(const Interruption& interruption) {
    interruption_ = interruption;
    search_.end_when(interruption);
  }
  /// The size [machine unit] down to which each state is known relatively; 0: as its absolute tolerance says.
  void know_states(std::span<const double> reach) { reach_.assign(reach.begin(), reach.end()); }
  /// Where the run ends [s]: what would come later is not told of.
  void end_at(double t) { end_ = t; }

  bool slides() const { return slide_.active(); }
  const network::Workspace& workspace() const { return workspace_; }

  /// The first thousand events, and how many there were.
  const std::vector<EventRecord>& records() const { return records_; }
  long count() const { return count_; }
  /// What could not be seen.
  const std::vector<text::Diagnostic>& warnings() const { return warnings_; }
  /// The first turn of each switch about which rounding has decided.
  const std::vector<FaintTurn>& faint_turns() const { return faint_; }

  /// What must be kept to go on later: whether each condition held.
  const std::vector<bool>& conditions() const { return held_; }
  void restore(std::vector<bool> conditions) {
    held_ = std::move(conditions);
    resumed_ = true;
  }

 private:
  using Units = std::vector<std::uint32_t>;
  static constexpr int kMostRounds = 1000;  ///< of events that set each other off at one instant

  bool is_known(std::size_t s) const { return program_.switches()[s].rate.has_value(); }
  bool known_follow_from_others() const;
  bool is_any_due() const;
  void weigh_errors();
  double error_of_state(std::size_t i) const;
  std::vector<std::size_t> states_behind(std::uint32_t s);
  std::vector<FaintTurn> faint_turns_at(double t);
  double place_size(std::size_t s) const;
  void evaluate(double t, std::span<const double> x);
  bool settle_switches(double t, std::span<const double> x);
  bool turn_by_surfaces(double t, Units& on_surface, std::vector<std::uint32_t>& turned);
  void turn_in_order(double t, std::span<const double> x);
  void decide(Units units, double t, std::span<const double> x);
  void begin_to_settle();
  void note_slides(const Units& before, const Units& repelled, double t);
  void warn_once(std::uint32_t unit, const char* what, const std::string& rest, const char* remedy);
  void warn_of_repulsion(std::uint32_t unit, double t);
  void warn_of_no_side(std::uint32_t unit, double t);
  void take_starts(double t, std::vector<double>& x);
  bool rests_within_limits(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest);
  bool serve_events(double t, std::vector<double>& x, bool starting);
  void turn(std::size_t s, double position, double t);
  void record(double t, std::string what);
  bool piles_up(std::size_t event, double t, bool at_once);
  bool comes_at_once(std::size_t event, double t, std::span<const double> x);
  [[noreturn]] void throw_chatter(const std::string& block, const std::string& what, double t) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  double span_, tolerance_, absolute_tolerance_;
  double end_ = std::numeric_limits<double>::infinity();  ///< [s] of the run
  Interruption interruption_;
  const std::string& file_;
  SlidingMode slide_;
  EventSearch::Thresholds thresholds_;
  EventSearch search_;
  FaintTurns faint_turns_;
  Positions positions_;

  std::vector<double> surfaces_, signals_;
  std::vector<double>
      announced_;              ///< position that a switch takes at the next `settle`; −1: as its surface is
  std::vector<double> reach_;  ///< see `know_states`
  std::vector<double> states_;  ///< where the surfaces were evaluated last
  std::vector<double> errors_;  ///< of the surfaces, where a switch turned over last
  bool weighed_ = false;        ///< whether they are those of `states_`
  std::vector<bool> held_;      ///< whether the condition of each event held when it was last looked at
  std::vector<bool> came_;      ///< of each event that sets states: whether it came at this instant
  std::vector<bool> stays_;     ///< of each switch: whether its surface, at zero, was found to stay there
  std::vector<bool> decided_;   ///< of each unit: by where it drifts, once in a `settle`
  bool set_ = false;            ///< whether events have set states at this instant
  Units slid_;                  ///< what slid when the settling began
  std::vector<bool> rested_;    ///< the surfaces that then stayed at zero along with it
  bool resumed_ = false;        ///< from a state that does not say what slid

  /// How often a switch has turned over without leaving its place.
  struct Unrest {
    double last = 0;
    long turns = 0;
  };
  std::vector<Unrest> unrest_;
  std::vector<EventPace> paces_;
  bool chained_;  ///< whether a known switch depends on the position of another
  std::vector<EventRecord> records_;
  long count_ = 0;
  std::vector<text::Diagnostic> warnings_;
  std::vector<FaintTurn> faint_;
};

}  // namespace oblique::solve
