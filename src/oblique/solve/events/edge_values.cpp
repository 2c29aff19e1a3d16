// SPDX-License-Identifier: MIT
#include <oblique/solve/events/edge_values.h>

#include <limits>

#include <oblique/solve/events/sliding_mode.h>

namespace oblique::solve {
namespace {

/// Of how far its event function has come: nearer than this to where the values end a switch leaves its side.
constexpr double kSameEdge = 1e-6;

constexpr int kHalvings = 64;    ///< of the way, to the last place that a number can tell
constexpr int kMostNearer = 40;  ///< halvings of the way to where derivatives have a bound

/// How far inside of an edge values are taken [machine unit], and how many times as far they must still be
/// the same.
constexpr double kDepths[] = {1e-15, 1e-13, 1e-11, 1e-9};
constexpr double kFarther = 8;
constexpr double kSame = 1e-3;  ///< of 1 + the value
constexpr double kDepthOfJacobian = 1e-6;

/// How far places are apart from which slopes are taken: of the run, and of 1 + |x|.
constexpr double kApart = 1e-6;

bool are_finite(std::span<const double> values, const std::vector<std::size_t>& which) {
  return std::all_of(which.begin(), which.end(), [&](std::size_t i) { return std::isfinite(values[i]); });
}

}  // namespace

/// How far the event function of each switch is on the side on which the switch stands; none where a loop has
/// no solution.
std::vector<double> EdgeValues::sides(const Place& at) {
  std::vector<double> sides(program_.switches().size());
  if (!program_.event_functions(at.t, at.x.data(), sides.data(), workspace_)) return {};
  for (std::size_t s = 0; s < sides.size(); ++s) {
    if (workspace_.discrete_state(program_.switches()[s].discrete_state) == 0) sides[s] = -sides[s];
  }
  return sides;
}

bool EdgeValues::complete_derivatives(double t, const double* x, std::span<double> dxdt) {
  return complete(Of::values, t, x, dxdt, [&](const Place& at) {
    return program_.derivatives(at.t, at.x.data(), dxdt.data(), workspace_);
  });
}

bool EdgeValues::complete_signals(double t, const double* x, std::span<double> signals) {
  return complete(Of::values, t, x, signals, [&](const Place& at) {
    return program_.signals(at.t, at.x.data(), signals.data(), workspace_).has_value();
  });
}

bool EdgeValues::complete_jacobian(double t, const double* x, std::span<double> jacobian) {
  return complete(Of::jacobian, t, x, jacobian, [&](const Place& at) {
    return program_.jacobian(at.t, at.x.data(), jacobian.data(), workspace_);
  });
}

/// `evaluate` writes `values`, and has written those that are to be filled in.
template <class Function>
bool EdgeValues::complete(Of what, double t, const double* x, std::span<double> values,
                          const Function& evaluate) {
  if (!misses_any(values)) return false;
  const std::vector<double> there(values.begin(), values.end());
  Missing missing;
  const bool found = find(what, {t, {x, x + program_.n_states()}}, values, evaluate, missing);
  std::copy(there.begin(), there.end(), values.begin());
  for (std::size_t k = 0; found && k < missing.which.size(); ++k)
    values[missing.which[k]] = missing.values[k];
  return true;
}

bool EdgeValues::find(Of what, const Place& at, std::span<const double> values, const Evaluate& evaluate,
                      Missing& missing) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) all.push_back(i);
  }
  const auto try_with = [&](const auto& look) {
    missing.which = all;
    return look();
  };
  const bool is_there = stands_ && stood_.t == at.t && stood_.x == at.x;
  if (what == Of::jacobian && (!stands_ || is_there)) return false;
  if (stands_ && !is_there) {
    if (try_with([&] { return find_on_way(what, stood_, at, values, evaluate, missing); })) return true;
    const bool found = what == Of::values && try_with([&] {
                         const auto start = inside_of(what, stood_, values, evaluate, missing);
                         return start && find_on_way(what, *start, at, values, evaluate, missing);
                       });
    if (found) return true;
  }
  return try_with([&] { return inside_of(what, at, values, evaluate, missing).has_value(); });
}

/// Looks for those missing on the way to where they are: for the last values of those that there are where it
/// begins. False where there are none, or no switch leaves its side where they end.
bool EdgeValues::find_on_way(Of what, const Place& from, const Place& to, std::span<const double> values,
                             const Evaluate& evaluate, Missing& missing) {
  if (from.t == to.t && from.x == to.x) return false;
  const auto keep = [&] {
    missing.values.clear();
    for (const std::size_t i : missing.which) missing.values.push_back(values[i]);
  };
  const auto on_way = [&](double part) {
    Place place{from.t + part * (to.t - from.t), from.x};
    for (std::size_t i = 0; i < place.x.size(); ++i) place.x[i] += part * (to.x[i] - from.x[i]);
    return place;
  };
  const auto has = [&](double part) {
    if (!evaluate(on_way(part)) || !are_finite(values, missing.which)) return false;
    keep();
    return true;
  };
  if (!evaluate(from)) return false;
  std::erase_if(missing.which, [&](std::size_t i) { return !std::isfinite(values[i]); });
  if (missing.which.empty()) return false;
  keep();
  double end = 1;  // where they are missing again
  if (what == Of::jacobian) {
    double part = 0.5;
    for (int k = 0; k < kMostNearer && !has(part); ++k) part /= 2;
  } else {
    double part = 0;
    for (int k = 0; k < kHalvings; ++k) {
      const double middle = part + (end - part) / 2;
      if (!(middle > part && middle < end)) break;
      (has(middle) ? part : end) = middle;
    }
  }
  const std::vector<double> before = sides(from), after = sides(on_way(end));
  for (std::size_t s = 0; s < after.size() && s < before.size(); ++s) {
    const double same = kSameEdge * before[s];
    if (before[s] > 0 && after[s] <= same && (what == Of::jacobian || after[s] >= -same)) return true;
  }
  return false;
}

/// Within what of zero the event function of each switch is on the edge: the errors of the states, and
/// rounding.
std::vector<double> EdgeValues::widths(const Place& at) {
  constexpr double kPart = 1e-13;  // of what is compared
  std::vector<double> widths(program_.switches().size());
  const auto there = program_.event_functions(at.t, at.x.data(), widths.data(), workspace_);
  if (!there) return widths;
  for (std::size_t s = 0; s < widths.size(); ++s) {
    const double size = there->compared_size(s);
    widths[s] = std::max(SlidingMode::drift(), std::isfinite(size) ? kPart * size : 0);
  }
  return widths;
}

/// Of each unit of switches on whose edge a place lies: the way from there on which its event function goes
/// inside, of 1 for 1.
std::vector<EdgeValues::Way> EdgeValues::ways_inside(const Place& at) {
  const std::vector<double> here = sides(at), near = widths(at);
  std::vector<Way> ways;
  std::vector<bool> known(program_.switch_structure().members.size(), false);
  for (std::size_t s = 0; s < here.size(); ++s) {
    const std::uint32_t unit = program_.switch_structure().unit[s];
    if (known[unit] || !(std::abs(here[s]) <= near[s])) continue;
    known[unit] = true;
    ways.push_back({s, here[s], 0, std::vector<double>(at.x.size())});
  }
  if (ways.empty()) return ways;
  const auto slopes = [&](const Place& moved, double by, const auto& store) {
    const std::vector<double> there = sides(moved);
    for (Way& way : ways) {
      const double slope = there.empty() ? 0 : (there[way.s] - way.side) / by;
      store(way, std::isfinite(slope) ? slope : 0);
    }
  };
  Place moved{at.t + kApart * span_, at.x};
  slopes(moved, kApart, [](Way& way, double slope) { way.time = slope; });
  moved.t = at.t;
  for (std::size_t i = 0; i < at.x.size(); ++i) {
    const double by = kApart * (1 + std::abs(at.x[i]));
    moved.x[i] = at.x[i] + by;
    slopes(moved, by, [i](Way& way, double slope) { way.states[i] = slope; });
    moved.x[i] = at.x[i];
  }
  for (Way& way : ways) {
    double square = way.time * way.time;
    for (const double slope : way.states) square += slope * slope;
    if (square == 0) continue;
    way.time *= span_ / square;
    for (double& slope : way.states) slope /= square;
  }
  return ways;
}

/// A place a little inside of the edge on which one lies, where those missing have values that are still the
/// same farther inside: a limit.
std::optional<EdgeValues::Place> EdgeValues::inside_of(Of what, const Place& at,
                                                       std::span<const double> values,
                                                       const Evaluate& evaluate, Missing& missing) {
  const std::vector<Way> ways = ways_inside(at);
  if (ways.empty()) return std::nullopt;
  const auto inside = [&](double depth) {
    Place place = at;
    for (const Way& way : ways) {
      const double by = std::max(depth - way.side, 0.0);
      place.t += by * way.time;
      for (std::size_t i = 0; i < place.x.size(); ++i) place.x[i] += by * way.states[i];
    }
    return place;
  };
  const std::vector<std::size_t> all = missing.which;
  const std::span<const double> depths =
      what == Of::jacobian ? std::span(&kDepthOfJacobian, 1) : std::span(kDepths);
  for (const double depth : depths) {
    if (!evaluate(inside(kFarther * depth))) continue;
    const std::vector<double> farther(values.begin(), values.end());
    const Place place = inside(depth);
    if (!evaluate(place)) continue;
    missing.which.clear();
    missing.values.clear();
    for (const std::size_t i : all) {
      const double same =
          what == Of::jacobian ? std::numeric_limits<double>::infinity() : kSame * (1 + std::abs(values[i]));
      if (!(std::abs(farther[i] - values[i]) <= same)) continue;
      missing.which.push_back(i);
      missing.values.push_back(values[i]);
    }
    if (!missing.which.empty()) return place;
  }
  return std::nullopt;
}

}  // namespace oblique::solve
