// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/edge_values.h>
#include <oblique/solve/events/slide_sides.h>
#include <oblique/solve/readings/independent_units.h>

namespace oblique::solve {

/// Filippov's solution along the switching surfaces of switches that both of their sides drive to.
///
/// A unit of switches that slides is in neither position: dx/dt is the mixture α f₁ + (1 − α) f₀ of what it
/// is with the unit on either side, and so is every signal; never is a switch's own position mixed, which
/// would go wrong through whatever is not linear downstream. Switches whose event functions depend on such a
/// position follow it: they are settled anew on each side. The shares α are those that keep all the event
/// functions where they are (Filippov 1960; the equivalent control of Utkin 1992). Of several units that are
/// coupled all combinations of sides are mixed, each with the product of its shares (Alexander and Seidman
/// 1998); units that are not coupled are each mixed by themselves, and what they do is added. What is
/// independent slides as it would alone: its shares are found, and it begins and ends, by itself.
class SlidingMode {
 public:
  /// All must outlive this; `span` is the length of the run [s].
  SlidingMode(const network::Program& program, network::Workspace& workspace, EdgeValues& edges,
              IndependentUnits& independent, double span);

  bool active() const { return !units_.empty(); }
  /// Ascending.
  const std::vector<std::uint32_t>& units() const { return units_; }
  /// Whether the unit of a switch slides.
  bool holds(std::size_t s) const;
  /// Whether a switch follows one that slides.
  bool follows(std::size_t s) const { return follows_[s]; }
  /// Of each switch: whether it slides or follows.
  std::vector<bool> taken() const;
  /// Whether any of these acts on an algebraic loop, whose solution is then mixed.
  bool mixes(std::size_t loop) const;
  /// Whether the event function of a switch stays at zero along with the slide, though it is not slid along.
  bool rests(std::size_t s) const { return rests_[s]; }
  void let_rest(std::size_t s) { rests_[s] = true; }
  /// Whether a switch slides that holds on neither side: see `begin`.
  bool is_silent(std::size_t s) const { return silent_[s]; }
  /// It has gone its way.
  void let_go(std::size_t s) { rests_[s] = false; }
  /// The first unit that slides on which a switch depends that follows.
  std::uint32_t followed_by(std::size_t s) const;
  /// The switches that follow.
  const std::vector<std::uint32_t>& followers() const { return followers_; }

  /// Begins to slide along the switching surfaces of `units` from (t, x), all other switches where they are:
  /// beside what slides already, which must be independent of them and slides on. The switches `silent` hold
  /// on neither side: of what is flat there, neither it nor its negative is above zero. False, with nothing
  /// changed, where no shares keep them there, now and a moment later.
  bool begin(const std::vector<std::uint32_t>& units, const std::vector<std::uint32_t>& silent, double t,
             std::span<const double> x);
  /// Ends; the positions stay what they were to events.
  void end();
  /// Ends but for `kept`, which must be independent of the others, at (t, x).
  void keep(const std::vector<std::uint32_t>& kept, double t, std::span<const double> x);

  /// As those of Program. False where a loop has no solution on one of the sides.
  bool derivatives(double t, const double* x, double* dxdt);
  bool jacobian(double t, const double* x, double* values);
  /// Whether `derivatives` leaves what slides where it is, for a method whose order the way back, which is
  /// bounded, would break; and by how much a step of `h` seconds is to change the states on that way alone.
  void leave_where_it_is(bool leave) { leaves_ = leave; }
  bool way_back(double t, const double* x, double h, double* change);
  bool signals(double t, const double* x, double* values);

  /// Evaluates all sides and the shares at (t, x), those that take back what integration has let the event
  /// functions drift off, or those that keep them where they are. False as above, or where no shares are
  /// found.
  bool evaluate(double t, std::span<const double> x, bool takes_back = true);
  /// Puts what follows the units on each side where it belongs there, after another switch has turned over.
  bool settle_sides(double t, std::span<const double> x);
  // As the last `evaluate` left them:
  /// Of each unit, that of its upper side: outside 0 and 1 where the slide is over.
  const std::vector<double>& shares() const { return shares_; }
  /// Whether all of them are between 0 and 1, or hardly beyond.
  bool goes_on() const;
  /// Of a unit how much more its upper side drives up than its lower one does, while the others of one that
  /// is coupled stay where they are, over the most by which they have ever driven together: above 0 they
  /// drive apart, and nothing holds it on the switching surface. Nothing where that tells nothing.
  std::optional<double> repulsion(std::size_t unit) const;
  /// Of a unit that nothing couples and that rests on the one side to which the other drives: whether that is
  /// the upper one.
  std::optional<bool> rests_above(std::size_t unit) const;
  /// Shows events that read them a unit that nothing couples, and what follows it, on one of its sides: what
  /// rests is there from when it begins.
  void show(std::size_t unit, bool above);
  /// Of such a unit whose event function reads this state alone: whether the side on which it rests leads it
  /// back to the switching surface from just beside it, as an amplifier beyond its limit comes back.
  bool comes_back(std::size_t unit, std::size_t state, double t, std::span<const double> x);
  /// Puts the switches of what rests on one side there, where nothing moves; or back to where they were.
  void put_at_rest(bool rests);
  /// How fast the side that drives a unit most moves its event function; 0 of one that is coupled.
  double fastest_drive(std::size_t unit) const { return drives(unit).stronger(); }
  /// Whether both sides of a unit that nothing couples drive to the switching surface, and neither hardly.
  bool is_held(std::size_t unit) const;
  /// What is uncertain where a unit would leave the switching surface here.
  enum class Doubt {
    none,
    of_side,     ///< both sides drive away from it
    of_whether,  ///< one drives away from it, and the other rests there
    of_time,     ///< what the sides differ by hardly moves the event function any more
  };
  Doubt doubt(std::size_t unit) const;
  /// Rounding of it.
  static constexpr double kNoRepulsion = 1e-8;
  /// Sides that drive together or apart by less than this part of what they drove together do neither: a
  /// magnitude in the event function may be about to turn over.
  static constexpr double kNoDrive = 1e-6;
  /// d(event function)/dt of every switch in the mixture.
  void mixed_rates(std::span<double> rates) const;
  /// Whether the event function of a switch moves on some side, but in the mixture by no more than this part
  /// of that.
  bool holds_still(std::size_t s, double part) const;
  /// The largest of all dx/dt in the mixture.
  double fastest() const;
  /// Whether a switch that follows is in one position on one side and in the other on another.
  bool is_torn(std::size_t s) const;
  /// The first two units that do something to a state together that is not the sum of what each does: with
  /// which shares of the time both are above is not said by their own shares, which are taken as independent.
  std::optional<std::pair<std::uint32_t, std::uint32_t>> act_together() const;
  /// Whether a switch jumps and rests with the slide though its sides move what it compares: as often as what
  /// slides turns over, so would this one.
  bool turns_along(std::uint32_t s) const;
  /// How far from zero an event function that has been slid along may have drifted [as the event function].
  static double drift() { return 1e-7; }
  /// By how much more than where they bend the event functions of units jump between the sides: those that
  /// depend on a position that jumps, where that makes no difference as long as they slide. Nothing where
  /// none does.
  std::optional<double> largest_jump() const;
  std::size_t sides() const { return sides_.size(); }
  /// By how much a follower's event function has passed zero against its position on a side.
  double crossed(std::size_t side, std::size_t follower) const;

 private:
  /// What a slide goes on by.
  struct Kept {
    std::vector<std::uint32_t> units;
    std::vector<double> shares;  ///< of each of them
    std::vector<bool> rests;     ///< of each switch
    std::vector<bool> silent;    ///< the same
  };
  void resume(const Kept& kept, double t, std::span<const double> x);
  bool make(std::vector<std::uint32_t> units, const Kept& kept, double t, std::span<const double> x);
  bool attracts(double t, std::span<const double> x);
  bool lift_followers();
  void find_followers();
  bool settle(SlideSide& side, double t, std::span<const double> x);
  bool is_within_drift(const network::Evaluation& here, std::uint32_t s, double event_function) const;
  bool move_tables_along(double t, std::span<const double> x, bool& still);
  void load(const SlideSide& side);
  void load_base();
  bool is_seen(std::size_t unit) const;
  bool evaluate(SlideSide& side, double t, std::span<const double> x);
  bool take_common_rates(double t, std::span<const double> x);
  bool find_shares(double most_back);
  bool find_only_share(std::size_t unit, double most_back);
  void find_drives_of_coupled();
  /// Of a unit that nothing couples, the rates of its event function on its two sides.
  struct Drives {
    double above = 0, below = 0;
    double apart() const { return above - below; }
    double weaker() const;
    double stronger() const;
  };
  const SlideSide& upper_side(std::size_t unit) const;
  const SlideSide* upper_side_alone(std::size_t unit) const;
  Drives drives(std::size_t unit) const;
  double drive_apart(std::size_t unit) const;
  std::optional<double> grip(std::size_t unit) const;
  bool lasts(double t, std::span<const double> x);

  const network::Program& program_;
  network::Workspace& workspace_;
  EdgeValues& edges_;
  IndependentUnits& independent_;
  double span_;
  std::vector<std::uint32_t> units_;
  std::vector<std::vector<std::size_t>> parts_;  ///< of `units_`: see IndependentUnits::parts_of
  std::vector<bool> slides_on_;                  ///< of each unit: it has begun to slide
  std::vector<bool> may_jump_;  ///< of each unit: its event function depends on another that jumps, or see
  std::vector<bool> bends_;     ///< it depends on what follows the unit itself
  std::vector<bool> follows_, rests_;
  std::vector<bool> silent_;  ///< of each switch: see `begin`
  std::vector<bool> lifted_;  ///< of each switch: while it follows, it holds at zero
  std::vector<std::uint32_t> followers_;
  std::vector<std::uint32_t> segments_;  ///< the discrete states of tables whose ends are followers
  bool leaves_ = false;                  ///< see `leave_where_it_is`
  SlideSides sides_;
  std::vector<std::pair<std::uint32_t, double>> base_;  ///< positions that events see
  std::vector<double> shares_;
  std::vector<double> drives_of_coupled_;  ///< of each unit, see `drive_apart`; 0 of one that is not coupled
  // Of each unit of the program the most in all slides of the run:
  std::vector<double> strongest_;  ///< drive together
  std::vector<double> firmest_;    ///< grip
  std::vector<double> scratch_, moved_, signals_;
};

}  // namespace oblique::solve
