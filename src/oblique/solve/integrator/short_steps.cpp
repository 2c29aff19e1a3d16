// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/short_steps.h>

namespace oblique::solve {

bool ShortSteps::take_back(double from, std::span<const double> x, std::span<const double> sample_times,
                           double end) {
  const auto missed = hidden_.find(from, sample_times, solver_);
  if (!missed) return false;
  limit_ = hidden_.longest_step();
  short_until_ = *missed + limit_;
  const bool is_far = hidden_.seen_until() - from > limit_;
  seen_until_ = is_far ? hidden_.seen_until() : kNone;
  if (is_far) end = seen_until_;
  solver_.restart(from, x, end, end - from);
  solver_.limit_step(is_far ? kNone : limit_);
  return true;
}

void ShortSteps::advance(double t, std::span<const double> x, double end) {
  if (t >= seen_until_) {
    seen_until_ = kNone;
    solver_.restart(t, x, end, end - t);
    solver_.limit_step(limit_);
  }
  if (limit_ < kNone && t > short_until_) {
    limit_ = limit_ > span_ ? kNone : 2 * limit_;
    solver_.limit_step(limit_);
  }
}

}  // namespace oblique::solve
