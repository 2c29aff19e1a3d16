// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// Something that happened between two smooth stretches of a run.
struct EventRecord {
  double time = 0;  ///< [s]
  std::string what;
};

/// The states at a time within the last step of a solver.
using StatesAt = std::function<void(double t, std::span<double> x)>;

/// The memories of one run: finds the times at which switches turn over, and settles everything there.
///
/// A switch is latched: between events it keeps its position, and the equations go on smoothly past its
/// surface. It turns over where its surface has passed zero by more than rounding. Then all switches,
/// algebraic loops and the events that they set off are settled to a fixed point at that one instant,
/// simultaneous and secondary ones included. A surface that both positions of a switch push back to is slid
/// along: the position then lies between 0 and 1 so that the surface stays at zero (Filippov's solution, by
/// the equivalent control of Utkin).
class Switching {
 public:
  /// `file` names the diagram in messages; `span` is the length of the run [s]. All must outlive this.
  Switching(const Program& program, Workspace& workspace, double span, const std::string& file);

  /// Whether there is anything to watch.
  bool active() const { return !program_.switches().empty() || !program_.events().empty(); }

  /// Settles switches and events at the start of the run, and the states that start from signals.
  /// `bring_to_rest` is called whenever something has changed that servo loops may follow. Throws SolveError.
  void start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest);

  /// Settles everything at time t, after the switches that `next_known_time` or `search` announced have
  /// turned over. Throws SolveError.
  void settle(double t, std::vector<double>& x);

  /// The next time after t at which a switch that follows time alone turns over; infinite without one.
  double next_known_time(double t, std::span<const double> x);

  /// The first time in (from, to] at which a switch turns over, or nothing; all are in place at `from`.
  std::optional<double> search(double from, double to, const StatesAt& states_at);

  /// dx/dt and its Jacobian with a sliding switch held on its surface.
  bool derivatives(double t, const double* x, double* dxdt);
  bool jacobian(double t, const double* x, double* values);

  /// Puts a sliding switch into its place at (t, x), for those who look at signals there.
  void place_sliding(double t, std::span<const double> x);

  /// The first thousand events, and how many there were.
  const std::vector<EventRecord>& records() const { return records_; }
  long count() const { return count_; }

  /// What must be kept to go on later: whether each condition held.
  const std::vector<bool>& conditions() const { return held_; }
  void restore(std::vector<bool> conditions) { held_ = std::move(conditions); }

 private:
  /// Values of all that is watched at one time: above 0 where it must turn over.
  struct Look {
    double time = 0;
    std::vector<double> overdue;
  };

  double tiny(std::size_t s, double t) const;
  bool is_known(std::size_t s) const;
  void look(double t, const StatesAt& states_at, Look& at);
  std::optional<double> first_in(const Look& from, const Look& to, const StatesAt& states_at);
  double locate(Look from, Look to, const StatesAt& states_at);
  bool finds_peak(const Look& from, const Look& middle, const Look& to, const StatesAt& states_at,
                  Look& found);

  void evaluate(double t, std::span<const double> x);
  bool settle_switches(double t, std::span<const double> x);
  bool decide(double t, std::span<const double> x);
  bool decide_on_surface(std::size_t s, double t, std::span<const double> x);
  void try_all_positions(double t, std::span<const double> x, const std::vector<std::size_t>& found);
  double drift(std::size_t s, double position, double t, std::span<const double> x);
  bool serve_events(double t, std::vector<double>& x, bool starting);
  double sliding_position(double t, std::span<const double> x);
  void leave_sliding(double t, std::span<const double> x);
  void turn(std::size_t s, double position, double t);
  void record(double t, std::string what);
  void keep_pace(std::size_t event, double t);
  [[noreturn]] void throw_chatter(const std::string& block, const std::string& what, double t) const;

  const Program& program_;
  Workspace& workspace_;
  double span_;
  const std::string& file_;

  std::vector<double> surfaces_;
  std::vector<double> signals_;
  std::vector<double> states_, moved_, slopes_, slopes_there_;  ///< scratch, of the size of x
  std::vector<double>
      announced_;           ///< position that a switch takes at the next `settle`; −1: as its surface is
  std::vector<bool> held_;  ///< whether the condition of each event held when it was last looked at
  std::optional<std::size_t> sliding_;
  std::vector<bool> on_surface_;  ///< decided by where it drifts, once in a `settle`

  struct Window {
    double begin = 0;
    long turns = 0;
  };
  std::vector<Window> switch_windows_;
  /// How quickly an event comes again: ever faster is how it piles up (Zeno).
  struct Pace {
    double last = 0;
    double interval = 0;
    int shorter = 0;  ///< how often in a row the interval has become shorter
  };
  std::vector<Pace> paces_;
  std::vector<EventRecord> records_;
  long count_ = 0;
};

}  // namespace oblique
