// SPDX-License-Identifier: MIT
#pragma once

#include <limits>
#include <span>
#include <utility>

#include <oblique/solve/integrator/hidden_motion.h>
#include <oblique/solve/integrator/solver.h>

namespace oblique::solve {

/// Takes a step back that has hidden something, and goes there again: by steps of any length as far as the
/// step had seen everything, then by steps that are short enough to see it, and from behind it on by longer
/// and longer ones. Not installed.
class ShortSteps {
 public:
  /// `span` is the length of the run [s]. The solver must outlive this.
  ShortSteps(HiddenMotion hidden, Solver& solver, double span)
      : hidden_(std::move(hidden)), solver_(solver), span_(span) {}

  /// Whether the step from `from`, where the states were x, has hidden something at one of `sample_times`:
  /// the solver then stands at `from` again, and will not pass `end`.
  bool take_back(double from, std::span<const double> x, std::span<const double> sample_times, double end);

  /// A step has led to (t, x), and nothing has happened there; the solver will not pass `end`.
  void advance(double t, std::span<const double> x, double end);

  /// The longest step that it allows now [s].
  double limit() const { return seen_until_ < kNone ? kNone : limit_; }

  /// The solver has begun anew behind an event.
  void restart() { seen_until_ = kNone; }

 private:
  static constexpr double kNone = std::numeric_limits<double>::infinity();

  HiddenMotion hidden_;
  Solver& solver_;
  double span_;                ///< [s]
  double limit_ = kNone;       ///< of a step [s]
  double short_until_ = 0;     ///< [s]
  double seen_until_ = kNone;  ///< [s] where short steps begin, while the solver is on its way there
};

}  // namespace oblique::solve
