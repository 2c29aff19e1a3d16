// SPDX-License-Identifier: MIT
#include <oblique/solve/events/event_location.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/time_resolution.h>

namespace oblique::solve {
namespace {

/// An edge that comes as soon as this [of the time] ends a segment in any case, so that what it ends keeps
/// its length.
constexpr double kNear = 1e-9;
/// Of what is compared: a shorter wait than the time can show is what rounding has left of the instant. One
/// that is nearly all of what is compared has begun just now: its length is known, though the time does not
/// show it.
constexpr double kWhole = 0.1;

}  // namespace

EventLocation::EventLocation(const network::Program& program, network::Workspace& workspace,
                             SlidingMode& slide, EventFunctions& event_functions, double span,
                             const std::string& file)
    : program_(program),
      workspace_(workspace),
      event_functions_(event_functions),
      search_(program, workspace, slide, event_functions.thresholds(), span, file),
      announced_(program.switches().size()),
      let_pass_(program.switches().size()) {}

void EventLocation::let_pass(bool pass) {
  for (const std::size_t s : due_) let_pass_[s] = pass;
}

bool EventLocation::lets_pass() const {
  return std::find(let_pass_.begin(), let_pass_.end(), true) != let_pass_.end();
}

std::optional<double> EventLocation::known_wait(double t, std::span<const double> x, Of which) {
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
    if (which == Of::let_pass && !let_pass_[s]) continue;
    const double compared = event_functions_.here().compared_size(s) / std::abs(*rate);
    const bool is_time = wait > time_resolution(t) || wait > kWhole * compared;
    const bool keeps_length = is_time && wait <= kNear * std::abs(t);
    if (which == Of::ends_of_segments && let_pass_[s] && !keeps_length) continue;
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
  slide_changes_ = found->slide_changes;
  return found;
}

void EventLocation::withdraw_early(double t) {
  due_.clear();
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (!event_functions_.known_rate(s)) continue;
    if (!is_due(s, t)) announced_[s].reset();
    if (announced_[s]) due_.push_back(s);
  }
}

/// Whether what follows the time alone is as near to zero as the time shows.
bool EventLocation::is_due(std::size_t s, double t) const {
  const auto rate = event_functions_.known_rate(s);
  return rate && std::abs(event_functions_[s]) <= off_at_zero(t, *rate);
}

void EventLocation::withdraw_past(double t, bool all) {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if ((all || event_functions_.is_off_zero(s)) && !is_due(s, t)) announced_[s].reset();
  }
}

}  // namespace oblique::solve
