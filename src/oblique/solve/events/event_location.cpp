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
                             SlidingMode& slide, SwitchSurfaces& surfaces, double span,
                             const std::string& file)
    : program_(program),
      workspace_(workspace),
      surfaces_(surfaces),
      search_(program, workspace, slide, surfaces.thresholds(), span, file),
      announced_(program.switches().size()) {}

std::optional<double> EventLocation::known_wait(double t, std::span<const double> x) {
  if (announced_.empty()) return std::nullopt;
  std::optional<double> next;
  std::vector<std::optional<double>> waits(announced_.size());
  surfaces_.evaluate(t, x, announced_);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = surfaces_.known_rate(s);
    if (!rate) continue;
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    if (closed ? *rate >= 0 : *rate <= 0) continue;
    const double wait = surfaces_.is_off_zero(s) ? std::max(0.0, -surfaces_[s] / *rate) : 0;
    if (!std::isfinite(wait)) continue;
    waits[s] = wait;
    next = std::min(next.value_or(wait), wait);
  }
  withdraw_all();
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (waits[s] && *waits[s] <= *next + time_resolution(t + *next))
      announced_[s] = 1 - workspace_.memory(program_.switches()[s].memory);
  }
  return next;
}

std::optional<EventSearch::Found> EventLocation::search(double from, std::span<const double> looks,
                                                        const Interpolant& solution) {
  auto found = search_.search(from, looks, solution);
  if (!found) return std::nullopt;
  withdraw_all();
  for (const auto& [s, position] : found->turned) announced_[s] = position;
  return found;
}

void EventLocation::withdraw_early(double t) {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = surfaces_.known_rate(s);
    if (rate && std::abs(surfaces_[s]) > 8 * time_resolution(t) * std::abs(*rate)) announced_[s].reset();
  }
}

void EventLocation::withdraw_past(bool all) {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (all || surfaces_.is_off_zero(s)) announced_[s].reset();
  }
}

}  // namespace oblique::solve
