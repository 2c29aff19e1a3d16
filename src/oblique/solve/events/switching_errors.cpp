// SPDX-License-Identifier: MIT
// The part of Switching that knows how far off the surfaces are.
#include <oblique/solve/events/switching.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <oblique/solve/events/driving_states.h>

namespace oblique::solve {
namespace {

constexpr double kSamePlace = 10;  ///< roundings: a surface that is no farther off has not left its place

}  // namespace

/// Within this of zero a surface is where it was.
double Switching::place_size(std::size_t s) const {
  return std::max(kSamePlace * search_.rounding(s), errors_[s]);
}

/// The absolute error that the solver leaves to a state.
double Switching::error_of_state(std::size_t i) const {
  const double own = program_.states()[i].tolerance;
  const double least = own > 0 ? own : absolute_tolerance_;
  return reach_.empty() || reach_[i] == 0 ? least : std::min(least, tolerance_ * reach_[i]);
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
      const double size = std::abs(states_[i]);
      const double error = clocks[i] ? kErrorOfClock * (1 + size) : tolerance_ * size + error_of_state(i);
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

/// The states that are hardly known and move the surface of a switch, itself or by the states that they
/// drive.
std::vector<std::size_t> Switching::states_behind(std::uint32_t s) {
  constexpr double kHardlyKnown = 1e4;  // errors
  constexpr double kPart = 1e-2;        // of the surface's error
  const std::size_t n = program_.n_states();
  std::vector<double> off(n, 0.0), rates(surfaces_.size());
  program_.surface_rates(off.data(), rates.data(), workspace_);
  const double still = rates[s];
  std::vector<bool> moves(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    off[i] = error_of_state(i);
    program_.surface_rates(off.data(), rates.data(), workspace_);
    off[i] = 0;
    moves[i] = std::abs(rates[s] - still) > kPart * errors_[s];
  }
  const std::vector<bool> behind = with_driving_states(program_.jacobian_pattern(), std::move(moves));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < n; ++i) {
    if (behind[i] && std::abs(states_[i]) <= kHardlyKnown * error_of_state(i)) found.push_back(i);
  }
  return found;
}

/// Of the switches that were announced those about which rounding decides; none that was told of before. The
/// surfaces were evaluated last at t.
std::vector<FaintTurn> Switching::faint_turns_at(double t) {
  if (!faint_turns_.any()) return {};
  weigh_errors();
  std::vector<FaintTurn> found;
  for (const std::uint32_t s : faint_turns_.faint([&](std::uint32_t number) {
         return FaintTurns::Past{errors_[number], search_.excursion(number), t - unrest_[number].last};
       })) {
    const bool told =
        std::any_of(faint_.begin(), faint_.end(), [s](const FaintTurn& turn) { return turn.number == s; });
    if (announced_[s] >= 0 && !told) found.push_back({s, t, errors_[s], states_behind(s)});
  }
  faint_turns_.leave();
  return found;
}

}  // namespace oblique::solve
