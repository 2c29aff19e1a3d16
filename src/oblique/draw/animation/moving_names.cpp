// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/moving_names.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

/// Where the middle of a name of this size may stand about its point [px], near and liked places first.
std::vector<Vector2d> places_around(const Vector2d& half) {
  constexpr std::array<double, 5> kDistances{8, 13, 19, 27, 38};  // [px] between the point and the name
  constexpr int kDirections = 24;
  constexpr double kFirst = 45;  // [°]
  std::vector<Vector2d> places;
  for (const double distance : kDistances) {
    for (int k = 0; k < kDirections; ++k) {
      const double angle = (kFirst + 360.0 * k / kDirections) * std::numbers::pi / 180;
      const Vector2d way(std::cos(angle), -std::sin(angle));
      const Vector2d beside = (std::numbers::sqrt2 * way).cwiseMax(-1).cwiseMin(1);
      places.emplace_back(distance * way + beside.cwiseProduct(half));
    }
  }
  return places;
}

/// Costs of the places, one row a moment: what a name covers, and a little for being far.
using Costs = std::vector<std::vector<double>>;

/// The price of going from one place to another between two moments: slow ways are cheap, and a leap costs
/// as much as it is to cover a link for two moments.
double price_of_way(const Vector2d& from, const Vector2d& to) {
  constexpr double kOfSquare = 0.02, kOfLeap = 100;
  return std::min(kOfSquare * (to - from).squaredNorm(), kOfLeap);
}

/// The places, one a moment from `begin` on, whose costs and ways are together the least; where `fixed` is
/// given, both the first and the last are that.
std::vector<std::size_t> cheapest_way(const Costs& costs, const std::vector<Vector2d>& places,
                                      const std::optional<std::size_t>& fixed) {
  const std::size_t n = places.size();
  constexpr double kNever = std::numeric_limits<double>::infinity();
  std::vector<std::vector<double>> price(n, std::vector<double>(n));
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) price[a][b] = price_of_way(places[a], places[b]);
  }
  std::vector<double> sums = costs.front();
  for (std::size_t a = 0; a < n; ++a) {
    if (fixed && a != *fixed) sums[a] = kNever;
  }
  std::vector<std::vector<std::size_t>> came_from(costs.size(), std::vector<std::size_t>(n));
  for (std::size_t k = 1; k < costs.size(); ++k) {
    std::vector<double> next(n, kNever);
    for (std::size_t to = 0; to < n; ++to) {
      for (std::size_t from = 0; from < n; ++from) {
        const double sum = sums[from] + price[from][to] + costs[k][to];
        if (sum >= next[to]) continue;
        next[to] = sum;
        came_from[k][to] = from;
      }
    }
    sums = std::move(next);
  }
  std::vector<std::size_t> way(costs.size());
  way.back() =
      fixed ? *fixed : static_cast<std::size_t>(std::min_element(sums.begin(), sums.end()) - sums.begin());
  for (std::size_t k = costs.size() - 1; k > 0; --k) way[k - 1] = came_from[k][way[k]];
  return way;
}

/// The way of a round that ends where it begins: a free way through two rounds tells where that is.
std::vector<std::size_t> cheapest_round(const Costs& round, const std::vector<Vector2d>& places) {
  if (round.size() == 1) return cheapest_way(round, places, {});
  Costs twice = round;
  twice.insert(twice.end(), round.begin() + 1, round.end());
  return cheapest_way(round, places, cheapest_way(twice, places, {})[round.size() - 1]);
}

/// Up to `most` moments between the first and the last of `frames`, both included.
std::vector<std::size_t> moments_of(std::size_t frames, std::size_t most) {
  const std::size_t steps = std::min(frames - 1, most);
  std::vector<std::size_t> moments{0};
  for (std::size_t k = 1; k <= steps; ++k) moments.push_back(k * (frames - 1) / steps);
  return moments;
}

}  // namespace

std::vector<MovingName> moving_names(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                                     const std::vector<mechanism::Configuration>& frames,
                                     const std::vector<std::vector<Vector2d>>& analog) {
  constexpr std::size_t kMoments = 120;  // between them names go evenly
  constexpr double kOfDistance = 0.05;
  const std::vector<std::size_t> moments = moments_of(frames.size(), kMoments);
  std::vector<LabelPlacer> placers;
  placers.reserve(moments.size());
  for (const std::size_t k : moments) {
    placers.push_back(
        placer_among(mechanism, layout, frames[k], analog.empty() ? std::vector<Vector2d>() : analog[k]));
  }
  std::vector<MovingName> names;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!is_drawn(mechanism, p)) continue;
    MovingName name{p, label_mark({0, 0}, mechanism.points[p].name, Anchor::middle, kNameSize), {}};
    std::get<Label>(name.mark.shape).bold = true;
    const Extent own = extent_of(name.mark);
    const Vector2d half = own.sizes() / 2;
    name.mark = placed(name.mark, -own.center(), 0);
    name.mark.id = "name-" + mechanism.points[p].name;
    const std::vector<Vector2d> places = places_around(half);
    const auto pin = [&](std::size_t frame) { return layout.axes.at(frames[frame].points[p].position); };
    Costs costs;
    for (std::size_t m = 0; m < moments.size(); ++m) {
      std::vector<double>& row = costs.emplace_back();
      for (const Vector2d& place : places) {
        const Vector2d middle = pin(moments[m]) + place;
        row.push_back(placers[m].cost({middle - half, middle + half}, pin(moments[m])) +
                      kOfDistance * place.norm());
      }
    }
    const std::vector<std::size_t> way = cheapest_round(costs, places);
    name.offsets.push_back(places[way.front()]);
    for (std::size_t m = 0; m < moments.size(); ++m) {
      const Vector2d at = pin(moments[m]);
      placers[m].add_name(placed(name.mark, at + places[way[m]], 0), at);
      if (m == 0) continue;
      const std::size_t from = moments[m - 1], to = moments[m];
      for (std::size_t k = from + 1; k <= to; ++k) {
        const double part = static_cast<double>(k - from) / static_cast<double>(to - from);
        name.offsets.emplace_back(places[way[m - 1]] * (1 - part) + places[way[m]] * part);
      }
    }
    names.push_back(std::move(name));
  }
  return names;
}

}  // namespace oblique::draw
