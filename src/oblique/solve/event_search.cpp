// SPDX-License-Identifier: MIT
// The part of Switching that finds out when a switch turns over.
#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/solve_error.h>
#include <oblique/solve/switching.h>

namespace oblique {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Nearer than this no two times are told apart.
double resolution(double t) {
  return 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
}

/// Where the parabola through (0, a), (½, b), (1, c) has its top: nothing if that is no maximum inside.
std::optional<double> top_of_parabola(double a, double b, double c) {
  const double curvature = a - 2 * b + c;
  if (!(curvature < 0)) return std::nullopt;
  const double at = 0.5 - (c - a) / (4 * curvature);
  if (at <= 0 || at >= 1) return std::nullopt;
  return at;
}

}  // namespace

double Switching::next_known_time(double t, std::span<const double> x) {
  double next = kInfinity;
  std::vector<double> times(announced_.size(), kInfinity);
  if (!announced_.empty()) evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = program_.known_rate(s, workspace_);
    if (!rate) continue;
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    if (closed ? *rate >= 0 : *rate <= 0) continue;
    times[s] = std::max(t, t - surfaces_[s] / *rate);
    next = std::min(next, times[s]);
  }
  std::fill(announced_.begin(), announced_.end(), -1.0);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (times[s] < kInfinity && times[s] <= next + resolution(next)) {
      announced_[s] = 1 - workspace_.memory(program_.switches()[s].memory);
    }
  }
  return next;
}

/// Of every switch by how much its surface has passed zero against its position; the last two tell of a slide
/// that ends at either side.
void Switching::look(double t, const StatesAt& states_at, Look& at) {
  at.time = t;
  states_at(t, states_);
  double slide = 0;
  if (sliding_) {
    slide = sliding_position(t, states_);
    workspace_.set_memory(program_.switches()[*sliding_].memory, std::clamp(slide, 0.0, 1.0));
  }
  evaluate(t, states_);
  at.overdue.resize(surfaces_.size() + 2);
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    at.overdue[s] = (closed ? -surfaces_[s] : surfaces_[s]) - tiny(s, t);
    if (is_known(s) || sliding_ == s) at.overdue[s] = -kInfinity;
  }
  at.overdue[surfaces_.size()] = sliding_ ? -slide : -kInfinity;
  at.overdue[surfaces_.size() + 1] = sliding_ ? slide - 1 : -kInfinity;
}

std::optional<double> Switching::search(double from, double to, const StatesAt& states_at) {
  constexpr double kFewestLooks = 1000;  // over the run: the solver's steps are long where the states are
                                         // smooth, whatever is made of them
  double interval = span_ / kFewestLooks;
  for (const Switch& s : program_.switches()) interval = std::min(interval, s.check_interval);
  constexpr double kMostLooks = 1e6;
  const auto looks = static_cast<int>(std::clamp(std::ceil((to - from) / interval), 1.0, kMostLooks));
  Look left, right;
  look(from, states_at, left);
  // Where the solver starts anew a surface may still lie within rounding of zero on the wrong side.
  for (double& value : left.overdue) value = std::min(value, 0.0);
  for (int k = 1; k <= looks; ++k) {
    look(k == looks ? to : from + (to - from) * k / looks, states_at, right);
    if (const auto found = first_in(left, right, states_at)) return found;
    std::swap(left, right);
  }
  return std::nullopt;
}

std::optional<double> Switching::first_in(const Look& from, const Look& to, const StatesAt& states_at) {
  const auto any = [](const Look& at) {
    return std::any_of(at.overdue.begin(), at.overdue.end(), [](double value) { return value > 0; });
  };
  Look middle;
  look((from.time + to.time) / 2, states_at, middle);
  if (any(middle)) return locate(from, middle, states_at);
  Look peak;
  if (finds_peak(from, middle, to, states_at, peak)) return locate(from, peak, states_at);
  if (any(to)) return locate(middle, to, states_at);
  return std::nullopt;
}

/// Whether a surface passes zero and comes back between two looks: its top, near which it may do so, is
/// sought along parabolas.
bool Switching::finds_peak(const Look& from, const Look& middle, const Look& to, const StatesAt& states_at,
                           Look& found) {
  constexpr double kNear = 0.25;  // of the way that the surface covers in the step
  constexpr int kMostTries = 8;
  for (std::size_t s = 0; s < from.overdue.size(); ++s) {
    double a = from.overdue[s], b = middle.overdue[s], c = to.overdue[s];
    if (!std::isfinite(a) || !std::isfinite(b) || !std::isfinite(c) || c > 0) continue;
    double left = from.time, right = to.time;
    for (int tried = 0; tried < kMostTries; ++tried) {
      const auto top = top_of_parabola(a, b, c);
      if (!top) break;
      const double height = b - (c - a) * (c - a) / (8 * (a - 2 * b + c));
      const double way = std::max({a, b, c}) - std::min({a, b, c});
      if (height < -kNear * way) break;
      const double at = left + *top * (right - left);
      look(at, states_at, found);
      if (found.overdue[s] > 0) return true;
      // The next parabola lies around the top, a quarter as wide.
      const double half = (right - left) / 8;
      const double centre = found.overdue[s];
      left = std::max(from.time, at - half);
      right = std::min(to.time, at + half);
      Look side;
      look(left, states_at, side);
      a = side.overdue[s];
      look(right, states_at, side);
      c = side.overdue[s];
      b = centre;
      if (at - left != right - at) break;
    }
  }
  return false;
}

/// The first time at which something is overdue, between a time where nothing is and one where something is:
/// by secants, halved where these are slow. Announces what turns over there.
double Switching::locate(Look from, Look to, const StatesAt& states_at) {
  Look middle;
  bool halve = false;
  while (to.time - from.time > resolution(to.time)) {
    double at = kInfinity;
    for (std::size_t s = 0; s < to.overdue.size(); ++s) {
      if (to.overdue[s] <= 0 || !std::isfinite(from.overdue[s])) continue;
      const double part = from.overdue[s] / (from.overdue[s] - to.overdue[s]);
      at = std::min(at, from.time + part * (to.time - from.time));
    }
    const double half = from.time + (to.time - from.time) / 2;
    if (halve || !(at > from.time && at < to.time)) at = half;
    // A little beyond the secant's zero, so that the bracket closes from both sides.
    if (!halve) at = std::min(at + 0.01 * (at - from.time) * (to.time - at) / (to.time - from.time), to.time);
    if (!(at > from.time && at < to.time)) break;
    const double width = to.time - from.time;
    look(at, states_at, middle);
    const bool over =
        std::any_of(middle.overdue.begin(), middle.overdue.end(), [](double v) { return v > 0; });
    std::swap(over ? to : from, middle);
    halve = to.time - from.time > width / 2;
  }
  std::fill(announced_.begin(), announced_.end(), -1.0);
  const std::size_t n = surfaces_.size();
  for (std::size_t s = 0; s < n; ++s) {
    if (to.overdue[s] > 0) announced_[s] = 1 - workspace_.memory(program_.switches()[s].memory);
  }
  if (sliding_ && to.overdue[n] > 0) announced_[*sliding_] = 0;
  if (sliding_ && to.overdue[n + 1] > 0) announced_[*sliding_] = 1;
  return to.time;
}

}  // namespace oblique
