// SPDX-License-Identifier: MIT
#include <oblique/solve/events/rate_probe.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/events/kept_unknowns.h>
#include <oblique/solve/events/position_limits.h>

namespace oblique::solve {
namespace {

constexpr double kRoundingOfState = 1e-14;  ///< of it: what some steps of a solver leave
/// Of the time in which what is fast answers: as long as this it goes straight on.
constexpr double kStraight = 0.1;

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

}  // namespace

RateProbe::RateProbe(const network::Program& program, network::Workspace& workspace, double span)
    : program_(program),
      workspace_(workspace),
      span_(span),
      rates_(program.switches().size()),
      later_(program.switches().size()),
      noise_(program.switches().size()),
      derivatives_(program.n_states()),
      moved_(program.n_states()),
      moved_derivatives_(program.n_states()),
      event_functions_(program.switches().size()) {}

void RateProbe::begin(const network::Evaluation& here, double least) {
  here.derivatives(derivatives_.data());
  here.event_function_rates(derivatives_.data(), rates_.data());
  fastest_ = fastest_of(derivatives_, std::max(least, std::numeric_limits<double>::min()));
}

bool RateProbe::look(std::span<const std::uint32_t> switches, double t, std::span<const double> x) {
  const KeptUnknowns kept(program_, workspace_);
  find_noise(t, x);
  step_ = std::min(kProbe / fastest_, kProbe * span_);
  for (const std::uint32_t s : switches) step_ = std::min(step_, straight(s));
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step_ * derivatives_[i];
  const auto later = program_.event_functions(t + step_, moved_.data(), event_functions_.data(), workspace_);
  if (!later) return false;
  later->derivatives(moved_derivatives_.data());
  later->event_function_rates(moved_derivatives_.data(), later_.data());
  return true;
}

double RateProbe::straight(std::size_t s) const {
  return noise_[s] > 0 ? kStraight * kRoundingOfState / noise_[s] : std::numeric_limits<double>::infinity();
}

void RateProbe::find_noise(double t, std::span<const double> x) {
  std::fill(noise_.begin(), noise_.end(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i)
    moved_[i] = x[i] * (1 + (i % 2 == 0 ? 1 : -1) * kRoundingOfState);
  const auto moved = program_.event_functions(t, moved_.data(), event_functions_.data(), workspace_);
  if (!moved) return;
  moved->derivatives(moved_derivatives_.data());
  moved->event_function_rates(moved_derivatives_.data(), noise_.data());
  for (std::size_t s = 0; s < noise_.size(); ++s)
    noise_[s] = std::isfinite(noise_[s]) ? std::abs(noise_[s] - rates_[s]) : 0;
}

bool is_decisive(const ProbedRate& probed, const RateScale& beside) {
  const double size = std::abs(probed.rate);
  return size > probed.noise && size > kNoRate * beside.rate && size > kRounding * beside.fastest &&
         !is_about_to_turn(probed.rate, probed.later, probed.step);
}

int side_of(const ProbedRate& probed, const RateScale& beside) {
  const double rate = probed.rate, later = probed.later;
  if (!leaves_rounding(rate, beside.span) && !leaves_rounding(later, beside.span)) return 0;
  if (is_decisive(probed, beside)) return sign_of(rate);
  const bool moves = std::abs(later) > probed.noise && std::abs(later) > kNoLaterRate * beside.later &&
                     std::abs(later) > 10 * kRounding * beside.fastest &&
                     beside.later > std::numeric_limits<double>::min();
  return moves ? sign_of(later) : 0;
}

}  // namespace oblique::solve
