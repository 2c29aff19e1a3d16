// SPDX-License-Identifier: MIT
#include <oblique/network/program/loop_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/network/program/near_root.h>

namespace oblique::network {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMostIterations = 100;
constexpr double kSmallestFraction = 1e-9;  ///< of a Newton step, below which the search along it gives up

/// A step below this, of 1 + |z|, that does not bring the residual down is led by the residual's rounding:
/// the terms of an equation may be a hundred million times its derivative. (A Newton step leads downhill, so
/// along a longer one that does not, there is no solution.)
constexpr double kNoise = 1e-8;

/// A way along which another branch may lie: of 1 + |z| where there was no solution before, else of a machine
/// unit, since branches may be as near to each other far from zero.
constexpr double kLongWay = 0.05;

/// Beside this many times the derivatives of an equation, an amplifier's own motion is all there is.
constexpr double kInstant = 1e15;

/// The largest derivative of a residual by an unknown.
double largest_derivative(const LoopCode& loop, const double* slots) {
  double largest = 0;
  for (const MatrixEntry& entry : loop.jacobian) largest = std::max(largest, std::abs(slots[entry.slot]));
  return largest;
}

/// Whether a mode of the amplifiers grows at the solution that the slots hold: the determinant of dg/dz then
/// has another sign than where their own motion outweighs it. Leaves dg/dz factored.
bool runs_away(const LoopCode& loop, const double* slots, LoopMatrix& matrix) {
  const double mass = kInstant * largest_derivative(loop, slots);
  const int rising = matrix.factor(loop, slots, mass) ? matrix.determinant_sign() : 0;
  return matrix.factor(loop, slots) && matrix.determinant_sign() * rising < 0;
}

/// From a root that rests at zero: where the bend of its equation is looked at [machine unit].
constexpr double kBesideNothing = 1e-6;

/// Whether the unknown of a loop of one, which has no root any more near `origin`, is the root of what has
/// come to zero but for the errors of the states: it then rests at zero, where its equation has no
/// derivative. What only its root drives comes to rest there, as the level of a tank that runs dry. The
/// unknown is then zero.
bool is_root_of_nothing(const LoopCode& loop, std::span<const Instruction> body, double* slots,
                        double origin) {
  constexpr double kNothing =
      1e-8;                       // [machine unit]: a hundred absolute tolerances of a run that asks for none
  constexpr double kNear = 0.05;  // [machine unit]
  if (loop.size() != 1 || !(std::abs(origin) < kNear)) return false;
  const auto slope_at = [&](double z) {
    slots[loop.unknown_slots[0]] = z;
    run_tape(body, slots);
    double slope = 0;
    for (const MatrixEntry& entry : loop.jacobian) slope += slots[entry.slot];
    return slope;
  };
  const double bend = slope_at(kBesideNothing) / kBesideNothing;
  if (slope_at(0) != 0) return false;
  const double residual = slots[loop.residual_slots[0]];
  return bend * residual >= 0 && bend != 0 && std::abs(residual) <= kNothing;
}

/// Size of an unknown for relative tests; the floor only keeps a zero from dividing.
double magnitude(double z) {
  return std::abs(z) + std::numeric_limits<double>::min();
}

}  // namespace

LoopWorkspace::LoopWorkspace(std::size_t size)
    : matrix_(size),
      beside_(size),
      step_(eigen_index(size), 1),
      start_(eigen_index(size)),
      origin_(eigen_index(size)),
      target_(eigen_index(size)),
      end_(eigen_index(size)),
      between_(eigen_index(size)),
      held_(size) {}

/// Runs the equations on the unknowns that the slots hold.
void LoopWorkspace::evaluate(std::span<const Instruction> body, double* slots) {
  run_tape(body, slots);
  ++evaluations_;
}

void LoopWorkspace::reset() {
  solved_ = false;
  branch_ = 0;
}

void LoopWorkspace::hold(double t, std::vector<double> unknowns, bool whatever) {
  held_time_ = t;
  if (!unknowns.empty()) held_ = std::move(unknowns);
  held_whatever_ = whatever;
}

/// Puts start + fraction · step into the unknowns' slots; the largest relative change.
double LoopWorkspace::move(const LoopCode& loop, double* slots, double fraction) const {
  double change = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double by = fraction * step_(eigen_index(i), 0);
    slots[loop.unknown_slots[i]] = start_[eigen_index(i)] + by;
    change = std::max(change, std::abs(by) / magnitude(start_[eigen_index(i)]));
  }
  return change;
}

void LoopWorkspace::read(const LoopCode& loop, const double* slots, Eigen::VectorXd& unknowns) const {
  for (std::size_t i = 0; i < loop.size(); ++i) unknowns[eigen_index(i)] = slots[loop.unknown_slots[i]];
}

void LoopWorkspace::write(const LoopCode& loop, double* slots, const Eigen::VectorXd& unknowns) const {
  for (std::size_t i = 0; i < loop.size(); ++i) slots[loop.unknown_slots[i]] = unknowns[eigen_index(i)];
}

LoopFailure LoopWorkspace::solve_loop(const LoopCode& loop, std::span<const Instruction> tape,
                                      double* slots) {
  const auto body = tape.subspan(loop.body.begin, loop.body.end - loop.body.begin);
  const double t = slots[0];
  if (t == held_time_ && solves(loop, body, slots, held_)) return LoopFailure::none;
  if (loop.linear) return solve_linear(loop, body, slots);
  const int how = 4 * branch_ + 2 * (solved_ ? 1 : 0) + (following_ ? 1 : 0);
  if (failed_.repeats(loop, slots, how)) {
    evaluate(body, slots);
    return failure_;
  }
  const auto solve = [&] {
    return loop.has_branches() ? solve_branched(loop, body, slots) : solve_unbranched(loop, body, slots);
  };
  const bool first = !solved_;
  failure_ = solve();
  if (first && failure_ == LoopFailure::singular && pass_guesses_on(loop, body, slots)) failure_ = solve();
  if (failure_ == LoopFailure::none) {
    failed_.forget();
  } else {
    failed_.note(loop, body, slots, origin_, how);
  }
  return failure_;
}

/// At the guesses, of which that of a signal is 0, the equations may be singular for no other reason (an
/// ideal divider by such a signal): each signal is then what its element makes of the others. False where
/// nothing changes.
bool LoopWorkspace::pass_guesses_on(const LoopCode& loop, std::span<const Instruction> body, double* slots) {
  write(loop, slots, origin_);
  evaluate(body, slots);
  read(loop, slots, target_);
  for (std::size_t i = 0; i < loop.size(); ++i) {
    if (loop.natural_scale[i] == 1) target_[eigen_index(i)] -= slots[loop.residual_slots[i]];
  }
  if (!target_.allFinite() || target_ == origin_) return false;
  write(loop, slots, target_);
  return true;
}

/// Newton's method, which keeps to the side of a pole on which it begins, and from solution to solution to
/// the sign of the determinant of dg/dz, there and on the way, as long as there is such a solution: between
/// two branches lies a fold, or a pole. (Two that lie a period apart have the same sign.)
LoopFailure LoopWorkspace::solve_unbranched(const LoopCode& loop, std::span<const Instruction> body,
                                            double* slots) {
  const bool known = solved_;
  read(loop, slots, origin_);
  const bool has_poles = poles_.needed(loop, body);
  Search search = newton(loop, body, slots, Steps::guarded);
  if (search.failure != LoopFailure::none && has_poles) {
    write(loop, slots, origin_);
    search = newton(loop, body, slots);
  }
  solved_ = search.failure == LoopFailure::none;
  if (!solved_ && find_near_root(loop, slots, origin_[0], [&] { evaluate(body, slots); })) {
    solved_ = known;
    return LoopFailure::none;
  }
  if (!known) {
    if (solved_) branch_ = matrix_.determinant_sign();
    return search.failure;
  }
  if (solved_ && search.even_order) return LoopFailure::none;
  if (!solved_ && (!following_ || search.failure != LoopFailure::diverged)) return search.failure;
  const bool is_near = longest_change(loop, slots) < kLongWay;
  if (solved_ && matrix_.determinant_sign() == search.first_sign &&
      (is_near || keeps_sign(loop, body, slots, origin_, search.first_sign))) {
    if (following_ && matrix_.determinant_sign() != branch_) return solve_beside_fold(loop, body, slots);
    branch_ = matrix_.determinant_sign();
    return LoopFailure::none;
  }
  read(loop, slots, target_);
  write(loop, slots, origin_);
  const Search shorter = newton(loop, body, slots, Steps::parts);
  if (shorter.failure == LoopFailure::none && matrix_.determinant_sign() == shorter.first_sign) {
    branch_ = shorter.first_sign;
    solved_ = true;
    return LoopFailure::none;
  }
  if (following_) {
    solved_ = true;  // where it was
    return LoopFailure::lost;
  }
  write(loop, slots, target_);
  evaluate(body, slots);
  branch_ = 0;
  return LoopFailure::none;
}

/// From next to a fold the sign where the search began may be that of the other branch, on which the slots
/// hold a solution then. The one that is followed lies as far on the other side. Where there is none the sign
/// has changed on the branch itself, on which an unknown has hardly moved; else the solution is to be sought
/// in shorter steps of the time.
LoopFailure LoopWorkspace::solve_beside_fold(const LoopCode& loop, std::span<const Instruction> body,
                                             double* slots) {
  constexpr double kHardly = 1e-3;  // [machine unit]
  read(loop, slots, target_);
  const int sign = matrix_.determinant_sign();
  const double apart = longest_change(loop, slots);
  write(loop, slots, 2 * origin_ - target_);
  const Search search = newton(loop, body, slots, Steps::guarded);
  if (branch_ != 0 && search.failure == LoopFailure::none && matrix_.determinant_sign() == branch_ &&
      longest_change(loop, slots) < 3 * apart + kLongWay)
    return LoopFailure::none;
  if (branch_ != 0 && apart > kHardly) return LoopFailure::lost;
  write(loop, slots, target_);
  evaluate(body, slots);
  branch_ = sign;
  return LoopFailure::none;
}

/// Whether these unknowns solve the loop, as far as an equation tells that has lost its derivative.
bool LoopWorkspace::solves(const LoopCode& loop, std::span<const Instruction> body, double* slots,
                           std::span<const double> unknowns) {
  constexpr double kConsistent =
      1e-7;                            // of the terms of an equation: what is told where a derivative is lost
  constexpr double kRounding = 1e-13;  // [machine unit] of terms without unknowns that take each other away
  for (std::size_t i = 0; i < loop.size(); ++i) slots[loop.unknown_slots[i]] = unknowns[i];
  evaluate(body, slots);
  if (held_whatever_) return true;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double residual = slots[loop.residual_slots[i]];
    double rest = residual, terms = 0;
    for (const MatrixEntry& entry : loop.jacobian) {
      if (entry.row != i) continue;
      const double term = slots[entry.slot] * unknowns[entry.column];
      rest -= term;
      terms += std::abs(term);
    }
    if (!(std::abs(residual) <= kConsistent * (terms + std::abs(rest)) + kRounding)) return false;
  }
  return true;
}

/// One LU. Where the equations are singular for a moment, and are solved by what solved them before, that is
/// the solution: it passes there smoothly. (For longer than a moment they determine nothing.)
LoopFailure LoopWorkspace::solve_linear(const LoopCode& loop, std::span<const Instruction> body,
                                        double* slots) {
  read(loop, slots, origin_);
  for (const std::uint32_t slot : loop.unknown_slots) slots[slot] = 0;  // the step rounds as its start does
  evaluate(body, slots);
  for (const std::uint32_t slot : loop.residual_slots) {
    if (!std::isfinite(slots[slot])) return LoopFailure::not_finite;
  }
  if (!matrix_.factor(loop, slots)) {
    if (!solved_) return LoopFailure::singular;
    held_time_ = slots[0];
    std::copy(origin_.begin(), origin_.end(), held_.begin());
    held_whatever_ = false;
    solved_ = false;
    return solves(loop, body, slots, held_) ? LoopFailure::none : LoopFailure::singular;
  }
  solved_ = true;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    step_(eigen_index(i), 0) = -slots[loop.residual_slots[i]];
    start_[eigen_index(i)] = 0;
  }
  if (matrix_.residual_norm(loop, slots) == 0) return LoopFailure::none;
  matrix_.solve(step_);
  move(loop, slots, 1);
  evaluate(body, slots);
  return step_.allFinite() ? LoopFailure::none : LoopFailure::not_finite;
}

/// Newton's method from what the slots hold, damped where the residual would grow.
LoopWorkspace::Search LoopWorkspace::newton(const LoopCode& loop, std::span<const Instruction> body,
                                            double* slots, Steps steps) {
  constexpr double kShort = 0.01;  // of |z|: a step that is not looked at for poles, and taken whole
  constexpr double kPart = 0.25;
  Search search;
  evaluate(body, slots);
  double last_change = std::numeric_limits<double>::infinity();
  bool small = false;
  int halvings = 0;
  constexpr int kFewestHalvings = 5;
  const auto ended = [&](LoopFailure failure) {
    search.failure = failure;
    return search;
  };
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    for (const std::uint32_t slot : loop.residual_slots) {
      if (!std::isfinite(slots[slot])) return ended(LoopFailure::not_finite);
    }
    // Singular where it started: the loop itself. Singular on the way: a search that found no solution.
    if (!matrix_.factor(loop, slots))
      return ended(iteration == 0 ? LoopFailure::singular : LoopFailure::diverged);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      step_(eigen_index(i), 0) = -slots[loop.residual_slots[i]];
      start_[eigen_index(i)] = slots[loop.unknown_slots[i]];
    }
    if (iteration == 0) search.first_sign = matrix_.determinant_sign();
    const double norm = matrix_.residual_norm(loop, slots);
    if (norm == 0) return search;
    matrix_.solve(step_);
    small = (step_.col(0).array().abs() < kNoise * (1 + start_.array().abs())).all();

    double fraction = 1;
    double change = move(loop, slots, fraction);
    if (steps == Steps::parts && change > kShort) {
      fraction = kPart;
      change = move(loop, slots, fraction);
    }
    evaluate(body, slots);
    // Steps at the level of rounding are not judged by the residual, which is noise there.
    const auto leaps = [&] {
      if (steps == Steps::any || !(change > kShort)) return false;
      return (poles_.needed(loop, body) && !poles_.has_values(loop, body, slots, start_)) ||
             (steps == Steps::parts && !keeps_sign(loop, body, slots, start_, search.first_sign));
    };
    while (change > 1e-13 &&
           (!(matrix_.residual_norm(loop, slots) < (1 - 1e-4 * fraction) * norm) || leaps())) {
      search.damped = search.damped || !small;
      fraction /= 2;
      if (fraction < kSmallestFraction) {
        if (!small) return ended(LoopFailure::diverged);
        move(loop, slots, 0);
        evaluate(body, slots);
        return search;
      }
      change = move(loop, slots, fraction);
      evaluate(body, slots);
    }
    halvings = change > 0.4 * last_change && change < 0.6 * last_change ? halvings + 1 : 0;
    search.even_order = halvings > kFewestHalvings;
    const bool stagnates = change < 1e-10 && change > last_change / 2;
    if (change < 2 * kEpsilon || stagnates) return search;
    last_change = change;
  }
  // rounding that a step now and then makes smaller
  return ended(small ? LoopFailure::none : LoopFailure::diverged);
}

LoopFailure LoopWorkspace::solve_branched(const LoopCode& loop, std::span<const Instruction> body,
                                          double* slots) {
  constexpr double kNoWay =
      1e-6;  // of 1 + |z|: the guess is this solution, to the digits that it is written with
  read(loop, slots, origin_);
  const auto accept = [&] {
    branch_ = matrix_.determinant_sign();
    solved_ = true;
    return LoopFailure::none;
  };
  const auto rests = [&] {  // at a root of even order, where it has lost its derivative
    return std::all_of(loop.residual_slots.begin(), loop.residual_slots.end(),
                       [&](std::uint32_t slot) { return slots[slot] == 0; });
  };
  const auto is_on_branch =
      [&](const Search& found) {  // at a root of even order the sign is that of rounding
        return (found.even_order || matrix_.determinant_sign() == branch_) &&
               (longest_change(loop, slots) < kLongWay || keeps_sign(loop, body, slots, origin_, branch_));
      };
  Search search = newton(loop, body, slots);
  const bool straight = search.failure == LoopFailure::none && !search.damped;
  if (solved_) {
    if (straight && is_on_branch(search)) return LoopFailure::none;
    if (search.failure == LoopFailure::singular && rests()) return LoopFailure::none;
    if (search.failure != LoopFailure::none && is_root_of_nothing(loop, body, slots, origin_[0]))
      return LoopFailure::none;
  } else if (straight && way(loop, slots) < kLongWay) {
    if (way(loop, slots) < kNoWay || !runs_away(loop, slots, matrix_)) return accept();
  }
  write(loop, slots, origin_);
  if (relax(loop, body, slots)) {
    read(loop, slots, target_);
    search = newton(loop, body, slots);
    if (search.failure == LoopFailure::none) {
      if (!following_ || !solved_) return accept();
      return is_on_branch(search) ? LoopFailure::none : LoopFailure::lost;
    }
    write(loop, slots, target_);
    evaluate(body, slots);
    if (search.failure == LoopFailure::singular && rests() && solved_) return LoopFailure::none;
  }
  if (following_ && solved_) return LoopFailure::lost;
  write(loop, slots, origin_);
  search = newton(loop, body, slots);
  if (search.failure == LoopFailure::none) return accept();
  // A run that begins at a root that rests at zero, as one goes on from a state that was kept there.
  if (origin_[0] != 0 || !is_root_of_nothing(loop, body, slots, 0)) return search.failure;
  slots[loop.unknown_slots[0]] = kBesideNothing;
  evaluate(body, slots);
  if (!matrix_.factor(loop, slots)) return search.failure;
  accept();
  slots[loop.unknown_slots[0]] = 0;
  evaluate(body, slots);
  return LoopFailure::none;
}

/// The largest change of an unknown since the search began, of 1 + |z|.
double LoopWorkspace::way(const LoopCode& loop, const double* slots) const {
  double longest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double from = origin_[eigen_index(i)];
    longest = std::max(longest, std::abs(slots[loop.unknown_slots[i]] - from) / (1 + std::abs(from)));
  }
  return longest;
}

/// The largest change of an unknown since the search began.
double LoopWorkspace::longest_change(const LoopCode& loop, const double* slots) const {
  double longest = 0;
  for (std::size_t i = 0; i < loop.size(); ++i)
    longest = std::max(longest, std::abs(slots[loop.unknown_slots[i]] - origin_[eigen_index(i)]));
  return longest;
}

/// Whether the determinant of dg/dz has this sign along the straight line from other unknowns: between two
/// branches of which it is that lies one of which it is not.
bool LoopWorkspace::keeps_sign(const LoopCode& loop, std::span<const Instruction> body, double* slots,
                               const Eigen::VectorXd& from, int sign) {
  // No simple fractions: a leap over some periods of a sine would show its one side at all of them.
  constexpr int kPlaces = 8;
  constexpr double kGolden = 0.6180339887498949;
  read(loop, slots, end_);
  bool keeps = true;
  for (int place = 1; place <= kPlaces && keeps; ++place) {
    between_ = from + (end_ - from) * std::fmod(place * kGolden, 1);
    write(loop, slots, between_);
    evaluate(body, slots);
    keeps = beside_.factor(loop, slots) && beside_.determinant_sign() == sign;
  }
  write(loop, slots, end_);
  evaluate(body, slots);
  return keeps;
}

/// Lets the amplifiers run, each at −g, while the rest of the loop follows without delay, until they rest:
/// implicit Euler steps, short at first so that they go where the amplifiers go, then ever longer until they
/// are Newton's method. False where the amplifiers do not come to rest; the slots then hold where they were
/// last.
bool LoopWorkspace::relax(const LoopCode& loop, std::span<const Instruction> body, double* slots) {
  constexpr double kMostChange = 0.2;  // of 1 + |z|, in a step
  constexpr double kSmallChange = 0.02;
  constexpr double kLongest = 1e18;   // of a step, in time constants of the fastest loop
  constexpr double kShortest = 1e-9;  // of the first step
  constexpr double kAtRest = 1e-12;
  constexpr double kFarAway = 1e6;  // [machine unit]
  constexpr int kMostSteps = 1000;
  const std::size_t n = loop.size();
  const bool all_held = std::find(loop.held_by_amplifier.begin(), loop.held_by_amplifier.end(), false) ==
                        loop.held_by_amplifier.end();
  const auto finite = [&] {
    return std::all_of(loop.residual_slots.begin(), loop.residual_slots.end(),
                       [&](std::uint32_t slot) { return std::isfinite(slots[slot]); });
  };
  evaluate(body, slots);
  if (!finite()) return false;
  // Where a branch ends, derivatives are near zero, and say nothing about how fast the amplifiers move later.
  const auto natural_step = [&] {
    double rate = largest_derivative(loop, slots);
    for (std::size_t i = 0; i < n; ++i) {
      const double z = std::abs(slots[loop.unknown_slots[i]]);
      if (loop.held_by_amplifier[i])
        rate = std::max(rate, std::abs(slots[loop.residual_slots[i]]) / (1 + z) / kMostChange);
    }
    return rate > 0 ? 1 / rate : 1;
  };
  double h = natural_step();
  if (!(h > 0)) return false;
  double unit = h, shortest = kShortest * h, last = 1;
  for (int step = 0; step < kMostSteps && h > shortest; ++step) {
    read(loop, slots, target_);
    // The determinant changes its sign across the step where the amplifiers run away from rest.
    const int rising = all_held ? 1
                       : matrix_.factor(loop, slots, kInstant * largest_derivative(loop, slots))
                           ? matrix_.determinant_sign()
                           : 0;
    bool good = rising != 0 && matrix_.factor(loop, slots, 1 / h) && matrix_.determinant_sign() == rising;
    double change = 0;
    if (good) {
      for (std::size_t i = 0; i < n; ++i) step_(eigen_index(i), 0) = -slots[loop.residual_slots[i]];
      matrix_.solve(step_);
      change = (step_.col(0).array().abs() / (1 + target_.array().abs())).maxCoeff();
      start_ = target_ + step_.col(0);
      good = change < kMostChange;
    }
    if (good) {
      write(loop, slots, start_);
      evaluate(body, slots);
      good = finite();
    }
    if (!good) {
      write(loop, slots, target_);
      evaluate(body, slots);
      h /= 4;
      continue;
    }
    if (h >= kLongest * unit && change < kAtRest && (change >= last || change < kEpsilon)) return true;
    if (start_.cwiseAbs().maxCoeff() > kFarAway) return false;
    last = change;
    const double natural = natural_step();
    unit = std::min(unit, natural);
    shortest = kShortest * natural;
    if (change < kSmallChange) {
      h *= 10;
    } else if (change < kMostChange / 2) {
      h *= 2;
    }
  }
  return false;
}

}  // namespace oblique::network
