// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/hidden_motion.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::solve {
namespace {

/// Errors above this many tolerances are not what an accepted step leaves between its points.
constexpr double kMostErrors = 100;

/// A state rests that moves by less than this part of what the equations say there.
constexpr double kRests = 0.1;
/// What moves a state at rest is looked at again where it is so many times as much as ever before; what is
/// less than so many roundings of the state, or than this [machine unit], is nothing.
constexpr double kMore = 10, kRoundings = 1e-15, kNothing = 1e-100;

}  // namespace

HiddenMotion::HiddenMotion(OdeSystem& system, double relative_tolerance,
                           std::vector<double> absolute_tolerances)
    : system_(system),
      relative_(relative_tolerance),
      absolute_(std::move(absolute_tolerances)),
      x_(system.size()),
      rates_(system.size()),
      derivatives_(system.size()),
      pushes_(system.size(), 0) {}

/// Whether a state that rests at t is moved there, over a part of the step, more than it ever was. How little
/// that is does not matter: the rest may be one out of which it grows.
bool HiddenMotion::is_pushed(double part) {
  bool pushed = false;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double push = part * std::abs(derivatives_[i]);
    if (!(part * std::abs(rates_[i]) < kRests * push) || push < kRoundings * std::abs(x_[i]) + kNothing ||
        push < kMore * pushes_[i])
      continue;
    pushes_[i] = push;
    pushed = true;
  }
  return pushed;
}

bool HiddenMotion::misses(double t, double part, const Interpolant& solution) {
  solution.states_at(t, x_);
  solution.rates_at(t, rates_);
  if (!system_.derivatives(t, x_.data(), derivatives_.data())) return true;
  if (is_pushed(part)) return true;
  bool suspicious = false;
  const auto error = [&](std::size_t i) {
    return part * std::abs(rates_[i] - derivatives_[i]) /
           (kMostErrors * (relative_ * std::abs(x_[i]) + absolute_[i]));
  };
  for (std::size_t i = 0; i < x_.size() && !suspicious; ++i) suspicious = error(i) > 1;
  if (!suspicious) return false;
  // A state that is pulled back at once errs by less.
  const network::SparsePattern& pattern = system_.pattern();
  jacobian_.resize(pattern.entries());
  if (!system_.jacobian(t, x_.data(), jacobian_.data())) return true;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    double own = 0;
    for (auto k = pattern.column_starts[i]; k < pattern.column_starts[i + 1]; ++k) {
      if (pattern.rows[static_cast<std::size_t>(k)] == static_cast<std::int64_t>(i))
        own = std::abs(jacobian_[static_cast<std::size_t>(k)]);
    }
    if (error(i) > 1 + part * own) return true;
  }
  return false;
}

std::optional<double> HiddenMotion::find(double from, std::span<const double> sample_times,
                                         const Interpolant& solution) {
  double before = from;
  for (std::size_t k = 0; k + 1 < sample_times.size(); ++k) {
    const double part = sample_times[k] - before;
    if (misses(sample_times[k], part, solution)) {
      longest_ = std::min(part, sample_times[k + 1] - sample_times[k]);
      seen_until_ = before;
      return sample_times[k];
    }
    before = sample_times[k];
  }
  return std::nullopt;
}

}  // namespace oblique::solve
