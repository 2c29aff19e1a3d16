// SPDX-License-Identifier: MIT
#include <oblique/solve/events/faint_turns.h>

#include <algorithm>
#include <cmath>

namespace oblique::solve {

FaintTurns::FaintTurns(const network::Program& program, network::Workspace& workspace, double span)
    : program_(program),
      workspace_(workspace),
      span_(span),
      farthest_(program.switches().size(), 0.0),
      states_(program.n_states()),
      rates_(program.n_states()),
      surfaces_(program.switches().size()) {}

void FaintTurns::approach(double from, double at, const std::vector<std::pair<std::uint32_t, double>>& turned,
                          const Interpolant& solution) {
  approaches_.clear();
  for (const auto& [s, position] : turned) {
    if (!program_.switches()[s].rate) approaches_.push_back({s});  // the others follow the time alone
  }
  if (approaches_.empty() || states_.empty()) return leave();
  solution.states_at(from, states_);
  if (!program_.surfaces(from, states_.data(), surfaces_.data(), workspace_)) return leave();
  for (Approach& a : approaches_) a.before = std::abs(surfaces_[a.number]);
  solution.states_at(at, states_);
  solution.rates_at(at, rates_);
  if (!program_.surfaces(at, states_.data(), surfaces_.data(), workspace_)) return leave();
  program_.surface_rates(rates_.data(), surfaces_.data(), workspace_);
  for (Approach& a : approaches_) a.speed = std::abs(surfaces_[a.number]);
}

std::vector<std::uint32_t> FaintTurns::faint(const std::function<Past(std::uint32_t)>& past) {
  constexpr double kAfar = 1e3, kSlow = 10;  // errors
  constexpr double kPileUp = 1e-4;  // of the run: turns that come more quickly may be those of a ball
  std::vector<std::uint32_t> found;
  for (const Approach& a : approaches_) {
    const Past p = past(a.number);
    farthest_[a.number] = std::max(farthest_[a.number], p.excursion);
    const bool has_decayed = p.excursion <= kSlow * p.error && p.since >= kPileUp * span_;
    const bool decays = p.excursion >= kAfar * p.error && a.speed * p.since <= kSlow * p.error;
    if (a.before <= p.error && farthest_[a.number] >= kAfar * p.error && (decays || has_decayed))
      found.push_back(a.number);
  }
  return found;
}

bool FaintTurns::jumps(const std::vector<double>& before, const std::vector<double>& after, double error) {
  constexpr double kTimes = 1e4, kLeast = 1e-6;  // of the errors; of 1 + the signal
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double jump = std::abs(after[i] - before[i]);
    if (jump > kTimes * error && jump > kLeast * (1 + std::abs(before[i]))) return true;
  }
  return false;
}

}  // namespace oblique::solve
