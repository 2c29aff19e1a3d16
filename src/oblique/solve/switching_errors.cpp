// SPDX-License-Identifier: MIT
// The part of Switching that knows how far off the surfaces are.
#include <oblique/solve/switching.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace oblique {
namespace {

constexpr double kSamePlace = 10;  ///< roundings: a surface that is no farther off has not left its place

}  // namespace

/// Within this of zero a surface is where it was.
double Switching::place_size(std::size_t s) const {
  return std::max(kSamePlace * search_.rounding(s), errors_[s]);
}

/// How far the surfaces are off zero by the errors that the solver leaves to the states: the most for some
/// combinations of their signs, where the surfaces were evaluated last.
void Switching::weigh_errors() {
  constexpr std::uint64_t kTrials = 4;
  constexpr double kErrorOfClock = 1e-13;  // it is a straight line to any method
  std::vector<bool> clocks(program_.n_states(), false);
  for (std::size_t c = 0; c < program_.clocks(); ++c) clocks[program_.source_states()[c]] = true;
  std::vector<double> off(program_.n_states(), 0.0), rates(surfaces_.size()), still(surfaces_.size());
  program_.surface_rates(off.data(), still.data(), workspace_);
  std::fill(errors_.begin(), errors_.end(), 0.0);
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::uint64_t signs = 0x9E3779B97F4A7C15 * (trial + 1);
    for (std::size_t i = 0; i < off.size(); ++i) {
      const double own = program_.states()[i].tolerance;
      double least = own > 0 ? own : absolute_tolerance_;
      if (!reach_.empty() && reach_[i] > 0) least = std::min(least, tolerance_ * reach_[i]);
      const double size = std::abs(states_[i]);
      const double error = clocks[i] ? kErrorOfClock * (1 + size) : tolerance_ * size + least;
      off[i] = trial == 0 || (signs >> 63) != 0 ? error : -error;
      signs = 6364136223846793005 * signs + 1442695040888963407;
    }
    program_.surface_rates(off.data(), rates.data(), workspace_);
    for (std::size_t s = 0; s < errors_.size(); ++s) {
      const double error = std::abs(rates[s] - still[s]);
      errors_[s] = std::max(errors_[s], std::isfinite(error) ? error : tolerance_);
    }
  }
  weighed_ = true;
}

}  // namespace oblique
