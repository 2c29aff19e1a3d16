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
/// drive, and their magnitudes.
std::vector<std::pair<std::size_t, double>> Switching::states_behind(std::uint32_t s) {
  constexpr double kHardlyKnown = 1e4;  // errors
  constexpr double kPart = 1e-2;        // of the surface's error
  const std::size_t n = program_.n_states();
  std::vector<double> off(n, 0.0), rates(surfaces_.size());
  program_.surface_rates(off.data(), rates.data(), workspace_);
  const double still = rates[s];
  std::vector<bool> behind(n, false);
  std::vector<std::size_t> pending;
  for (std::size_t i = 0; i < n; ++i) {
    off[i] = error_of_state(i);
    program_.surface_rates(off.data(), rates.data(), workspace_);
    off[i] = 0;
    if (!(std::abs(rates[s] - still) > kPart * errors_[s])) continue;
    behind[i] = true;
    pending.push_back(i);
  }
  const SparsePattern& pattern = program_.jacobian_pattern();
  while (!pending.empty()) {
    const auto row = static_cast<std::int64_t>(pending.back());
    pending.pop_back();
    for (std::size_t column = 0; column < n; ++column) {
      const auto begin = pattern.rows.begin() + pattern.column_starts[column];
      const auto end = pattern.rows.begin() + pattern.column_starts[column + 1];
      if (behind[column] || !std::binary_search(begin, end, row)) continue;
      behind[column] = true;
      pending.push_back(column);
    }
  }
  std::vector<std::pair<std::size_t, double>> found;
  for (std::size_t i = 0; i < n; ++i) {
    if (behind[i] && std::abs(states_[i]) <= kHardlyKnown * error_of_state(i))
      found.emplace_back(i, std::abs(states_[i]));
  }
  return found;
}

/// Of the switches that were announced those about which rounding decides; none that was told of before.
std::vector<std::uint32_t> Switching::faint_switches(double t) {
  if (!faint_turns_.any()) return {};
  weigh_errors();
  std::vector<std::uint32_t> found = faint_turns_.faint([&](std::uint32_t s) {
    return FaintTurns::Past{errors_[s], search_.excursion(s), t - unrest_[s].last};
  });
  faint_turns_.leave();
  std::erase_if(found, [this](std::uint32_t s) {
    return announced_[s] < 0 ||
           std::any_of(faint_.begin(), faint_.end(), [s](const FaintTurn& turn) { return turn.number == s; });
  });
  return found;
}

/// Keeps the turns that have an effect; the surfaces were evaluated last where they are, after it.
void Switching::note_faint(const std::vector<std::uint32_t>& faint, const std::vector<double>& errors,
                           const std::vector<double>& before, double t) {
  for (const std::uint32_t s : faint) {
    if (FaintTurns::jumps(before, signals_, errors[s])) faint_.push_back({s, t, errors[s], states_behind(s)});
  }
}

}  // namespace oblique
