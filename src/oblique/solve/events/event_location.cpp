// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_location.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/time_resolution.h>

namespace oblique::solve {

EventLocation::EventLocation(const network::Program& program, network::Workspace& workspace,
                             SlidingMode& slide, EventFunctions& event_functions, double span,
                             const std::string& file)
    : program_(program),
      workspace_(workspace),
      event_functions_(event_functions),
      search_(program, workspace, slide, event_functions.thresholds(), span, file),
      announced_(program.switches().size()) {}

std::optional<double> EventLocation::known_wait(double t, std::span<const double> x) {
  if (announced_.empty()) return std::nullopt;
  std::optional<double> next;
  std::vector<std::optional<double>> waits(announced_.size());
  event_functions_.evaluate(t, x, announced_);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = event_functions_.known_rate(s);
    if (!rate) continue;
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    if (closed ? *rate >= 0 : *rate <= 0) continue;
    const double wait = event_functions_.is_off_zero(s) ? std::max(0.0, -event_functions_[s] / *rate) : 0;
    if (!std::isfinite(wait)) continue;
    waits[s] = wait;
    next = std::min(next.value_or(wait), wait);
  }
  withdraw_all();
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (waits[s] && *waits[s] <= *next + time_resolution(t + *next))
      announced_[s] = 1 - workspace_.discrete_state(program_.switches()[s].discrete_state);
  }
  return next;
}

std::optional<EventSearch::Found> EventLocation::search(double from, std::span<const double> sample_times,
                                                        const Interpolant& solution) {
  auto found = search_.search(from, sample_times, solution);
  if (!found) return std::nullopt;
  withdraw_all();
  for (const auto& [s, position] : found->turned) announced_[s] = position;
  return found;
}

void EventLocation::withdraw_early(double t) {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = event_functions_.known_rate(s);
    if (rate && std::abs(event_functions_[s]) > 8 * time_resolution(t) * std::abs(*rate))
      announced_[s].reset();
  }
}

void EventLocation::withdraw_past(bool all) {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (all || event_functions_.is_off_zero(s)) announced_[s].reset();
  }
}

}  // namespace oblique::solve
