// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/event_log.h>
#include <oblique/solve/events/event_pace.h>
#include <oblique/solve/events/positions.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/event_functions.h>

namespace oblique::solve {

/// Settles all switches, and the algebraic loops between them, to a fixed point at one instant.
///
/// A switch whose event function is off zero goes where that asks for it, again and again until none does.
/// Those that lie on their switching surfaces then go, together, where the solution takes them, or slide (see
/// Positions): once in a settling, for it ends nowhere else. Those that go on turning over depend on their
/// own positions, and all combinations of these are tried. Not installed.
class SwitchSettling {
 public:
  /// `announced` are the switches that are due, by time or by a crossing that was located; `span` is the
  /// length of the run [s]. All must outlive this.
  SwitchSettling(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
                 IndependentUnits& independent, EventFunctions& event_functions, const Announced& announced,
                 EventLog& log, double span);

  /// Tells, where all has been settled at the start, whether a switch could as well stand on its other side.
  void tell_of_open(double t, std::span<const double> x);
  /// A new instant after the start, with the event functions evaluated: events have set no states at it yet.
  void begin_instant();
  /// Begins to settle: what lies on its switching surface is decided anew, and what slides is looked at as if
  /// it came there now.
  void begin();
  /// The same at (t, x), where switches are due that were announced: what slides independently of these
  /// slides on.
  void begin_beside_slides(double t, std::span<const double> x);
  /// The same after `events` at this instant, that have set states, which may have jumped with that: what
  /// slides slides on where they do not act on it.
  void begin_after_events(const std::vector<std::size_t>& events, bool set_states, bool jumped, double t,
                          std::span<const double> x);
  /// All switches to a fixed point; true where any turned over. Throws SolveError where there is none.
  bool settle(double t, std::span<const double> x);
  /// The instant is settled; before it these units slid.
  void end(const std::vector<std::uint32_t>& slid);
  /// What slides is about to be settled anew at t, where it ends or what follows it turns over. Throws
  /// SolveError where that comes again and again at one place: what follows turns over on one side, and on
  /// the other back.
  void watch_followers(double t);
  /// A switch that was announced has not turned over: its event function may touch zero within the errors of
  /// the states until it has left these behind.
  void let_touch(std::size_t s);
  /// What slides is settled anew in the next settling: these switches did, or rested at zero along with it;
  /// any may have where that is not known and `sliding` is empty.
  void restore(std::vector<bool> sliding);
  /// Of a run that goes on with the event functions evaluated: those that are within the errors of the states
  /// stay where they are until they have left these behind. On which side they lie, rounding decides.
  void keep_positions_within_errors();

  /// Whether an event function, at zero, was found to stay there.
  bool stays(std::size_t s) const { return stays_[s]; }
  /// When a switch turned over last [s]; 0 where it has not.
  double last_turn(std::size_t s) const { return unrest_[s].last; }
  /// Where a switch has been let touch since: how far off zero its event function was at first.
  std::optional<double> touch(std::size_t s) const { return unrest_[s].touch; }

 private:
  using Units = std::vector<std::uint32_t>;

  bool known_follow_from_others() const;
  double position(std::size_t s) const {
    return workspace_.discrete_state(program_.switches()[s].discrete_state);
  }
  double place_size(std::size_t s) const;
  double near_size(std::size_t s) const;
  bool is_near(std::size_t s) const;
  bool waits(std::size_t s, double event_function, double t);
  bool is_put_on_zero(std::size_t s, double event_function, double t) const;
  bool is_announced(std::uint32_t unit) const;
  void turn(std::size_t s, double position, double t);
  void watch_pace(std::size_t s, double t);
  double known_position(std::size_t s, double event_function, double rate, double t) const;
  bool turn_by_event_functions(double t, std::span<const double> x, Units& at_zero,
                               std::vector<std::uint32_t>& turned);
  void turn_in_order(double t, std::span<const double> x);
  void add_preferred(std::uint32_t unit, double t, std::vector<double>& preferred) const;
  bool is_at_level(std::uint32_t unit) const;
  void begin(const Units& kept, double t, std::span<const double> x);
  void add_corners(Units& units) const;
  void decide(Units units, double t, std::span<const double> x);
  bool decide_in_order(const Units& units, double t, std::span<const double> x);
  bool decide_together(const Units& units, double t, std::span<const double> x);
  std::vector<std::uint32_t> members_of(const Units& units) const;
  bool choose_beside_slide(const Units& units, const std::vector<double>& preferred, const Units& may_stop,
                           double t, std::span<const double> x);
  bool choose_restless(const Units& switches, const Units& left, double t, std::span<const double> x);
  void note_choice(double t, std::span<const double> x);
  SolveError no_position(std::uint32_t s, double t) const;

  const network::Program& program_;
  network::Workspace& workspace_;
  SlidingMode& slide_;
  IndependentUnits& independent_;
  EventFunctions& event_functions_;
  const Announced& announced_;
  EventLog& log_;
  double span_;
  Positions positions_;
  bool chained_;  ///< whether a known switch depends on the position of another
  std::vector<std::vector<std::size_t>> setters_;  ///< of each unit, see `find_setters`

  std::vector<bool> stays_;    ///< see `stays`
  std::vector<bool> decided_;  ///< of each unit: by where it drifts, once since `begin`
  bool starting_ = true;       ///< until the first instant after the start
  bool resumes_ = false;       ///< whether the next instant is a start, too
  bool set_ = false;           ///< whether events have set states at this instant
  Units slid_;                 ///< what slid when the settling began
  std::vector<bool> rested_;   ///< the event functions that then stayed at zero along with it
  /// Until the next settling begins: see `restore`, and the units to be kept where they are.
  std::vector<bool> restored_, kept_;

  std::vector<double> before_instant_, rates_before_;  ///< the event functions, and the size of their rates
  std::vector<double> derivatives_;

  /// How often a switch has turned over without leaving its place.
  struct Unrest {
    double last = 0;
    long turns = 0;
    std::optional<double> touch;  ///< since it turned over last it was announced so far off, and did not
    EventPace pace;
    std::optional<double> piles_up;  ///< [s] its turns, which have come ever faster
    long beyond = 0;                 ///< turns after that, within the errors of the states
  };
  std::vector<Unrest> unrest_;
  double followers_turned_ = 0;  ///< see `watch_followers` [s]
  int followers_turns_ = 0;      ///< at one place
};

}  // namespace oblique::solve
