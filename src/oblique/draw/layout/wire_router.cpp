// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/wire_router.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <tuple>

#include <oblique/draw/schematic/wire_pieces.h>

// How a net finds its way. The grid has a line wherever a box, a pin or a wire can lie, and gaps where there
// is nothing for long. A point of it is blocked by a box, taken by a wire across or down, or reserved in
// front of a pin, so that no other net can shut the pin in.
//
// A net grows pin by pin, the nearest first: each pin is reached from anywhere on what is laid already, or
// from the source at the start. One search is A* over (point, direction of arrival), since a bend costs more
// than a step straight on: cost = length + bends + crossings + junctions, and the estimate of the rest is
// the distance along the grid with the bends that cannot be avoided. It is never more than the true rest, so
// the first way found is the cheapest. A net that is laid anew keeps its old wires where the new ones are no
// better, and its search gives up as soon as nothing better is possible; so repeating it over all nets comes
// to an end.

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

/// What is as bad as a way of this length [px].
constexpr int kBend = 48, kCrossing = 72, kJunction = 12;
/// Where boxes are farther apart than twice this, the grid between them has a gap [lines].
constexpr int kDense = 40;

/// The lines of the grid in the area near the edges of boxes, and those that wires lie on.
std::vector<double> lines(const std::vector<std::pair<double, double>>& edges,
                          const std::vector<double>& wires, double low, double high) {
  std::vector<double> result(wires);
  std::vector<std::pair<double, double>> spans{{low, low + kDense * kLayoutGrid}};
  for (const auto& [begin, end] : edges)
    spans.emplace_back(begin - kDense * kLayoutGrid, end + kDense * kLayoutGrid);
  std::sort(spans.begin(), spans.end());
  double next = low;
  for (const auto& [begin, end] : spans) {
    next = std::max(next, std::floor(begin / kLayoutGrid) * kLayoutGrid);
    const double last = std::min(end, high);
    while (next <= last) {
      result.push_back(next);
      next += kLayoutGrid;
    }
  }
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

bool is_odd(double line) {
  return std::floor(line / kLayoutGrid) * kLayoutGrid != line;
}

std::size_t index_of(const std::vector<double>& lines, double at) {
  return static_cast<std::size_t>(std::lower_bound(lines.begin(), lines.end(), at) - lines.begin());
}

}  // namespace

WireRouter::WireRouter(const LayoutGraph& graph, const std::vector<Vector2d>& corners,
                       const std::vector<NetToRoute>& nets, const RoutingArea& area)
    : nets_(nets) {
  std::vector<std::pair<double, double>> x_edges, y_edges;
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const Vector2d end = corners[v] + graph.nodes[v].size;
    x_edges.emplace_back(corners[v].x(), end.x());
    y_edges.emplace_back(corners[v].y(), end.y());
  }
  std::vector<double> x_wires, y_wires;
  for (const NetToRoute& net : nets) {
    for (const WirePiece& piece : net.pieces) {
      for (const Vector2d& end : {piece.from, piece.to}) {
        x_wires.push_back(end.x());
        y_wires.push_back(end.y());
      }
    }
  }
  xs_ = lines(x_edges, x_wires, area.low.x(), area.high.x());
  ys_ = lines(y_edges, y_wires, area.low.y(), area.high.y());
  std::transform(xs_.begin(), xs_.end(), std::back_inserter(odd_column_), is_odd);
  std::transform(ys_.begin(), ys_.end(), std::back_inserter(odd_row_), is_odd);
  const std::size_t n = xs_.size() * ys_.size();
  blocked_.assign(n, 0);
  across_.assign(n, kNone);
  down_.assign(n, kNone);
  reserved_.assign(n, kNone);
  reached_.assign(2 * n, 0);
  stamp_.assign(2 * n, 0);
  from_.assign(2 * n, kNone);
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const Vector2d end = corners[v] + graph.nodes[v].size;
    for (std::size_t j = index_of(ys_, corners[v].y()); j < ys_.size() && ys_[j] <= end.y(); ++j) {
      for (std::size_t i = index_of(xs_, corners[v].x()); i < xs_.size() && xs_[i] <= end.x(); ++i)
        blocked_[j * xs_.size() + i] = 1;
    }
  }
  for (std::size_t k = 0; k < nets_.size(); ++k) {
    const auto reserve = [&](const Vector2d& pin, int step) {
      const Point at = point(pin) + step;
      const auto beside = static_cast<std::size_t>(at);
      if (beside < n) reserved_[beside] = static_cast<std::int32_t>(k);
    };
    reserve(nets_[k].source, 1);
    for (const Vector2d& sink : nets_[k].sinks) reserve(sink, -1);
    if (!nets_[k].pieces.empty()) lay(k);
  }
}

WireRouter::Point WireRouter::point(const Vector2d& at) const {
  return static_cast<Point>(index_of(ys_, at.y()) * xs_.size() + index_of(xs_, at.x()));
}

Vector2d WireRouter::place(Point p) const {
  const auto k = static_cast<std::size_t>(p);
  return {xs_[k % xs_.size()], ys_[k / xs_.size()]};
}

template <class Visit>
void WireRouter::visit(const WirePiece& piece, const Visit& visit_point) const {
  const Point step = piece.horizontal() ? 1 : static_cast<Point>(xs_.size());
  for (Point p = point(piece.from), end = point(piece.to); p <= end; p += step)
    visit_point(static_cast<std::size_t>(p));
}

void WireRouter::lay(std::size_t net) {
  for (const WirePiece& piece : nets_[net].pieces) {
    auto& owner = piece.horizontal() ? across_ : down_;
    visit(piece, [&](std::size_t p) { owner[p] = static_cast<std::int32_t>(net); });
  }
}

void WireRouter::take_up(std::size_t net) {
  for (const WirePiece& piece : nets_[net].pieces) {
    auto& owner = piece.horizontal() ? across_ : down_;
    visit(piece, [&](std::size_t p) { owner[p] = kNone; });
  }
  nets_[net].pieces.clear();
}

int WireRouter::cost(std::size_t net) const {
  double length = 0;
  int crossings = 0;
  for (const WirePiece& piece : nets_[net].pieces) {
    length += (piece.to - piece.from).norm();
    const auto& other = piece.horizontal() ? down_ : across_;
    visit(piece, [&](std::size_t p) {
      if (other[p] != kNone && other[p] != static_cast<std::int32_t>(net)) ++crossings;
    });
  }
  const WireJoints joints = joints_of(nets_[net].pieces);
  return static_cast<int>(length) + kCrossing * crossings + kBend * static_cast<int>(joints.bends) +
         kJunction * static_cast<int>(joints.junctions.size());
}

/// The cheapest way to a pin from what is laid of the net, or from its source; false where there is none
/// below the budget.
bool WireRouter::find_way(std::int32_t net, Point target, int budget, std::vector<Point>& way, int& used) {
  ++search_;
  const auto width = static_cast<Point>(xs_.size());
  const double goal_x = xs_[static_cast<std::size_t>(target % width)];
  const double goal_y = ys_[static_cast<std::size_t>(target / width)];
  using Entry = std::tuple<int, int, std::int32_t>;  // estimate of the whole, way so far, state
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  const auto enter = [&](Point p, Point column, Point row, int direction, int so_far, std::int32_t from) {
    const auto state = 2 * static_cast<std::size_t>(p) + static_cast<std::size_t>(direction);
    if (stamp_[state] == search_ && reached_[state] <= so_far) return;
    const double below = std::abs(ys_[static_cast<std::size_t>(row)] - goal_y);
    const double beside = std::abs(xs_[static_cast<std::size_t>(column)] - goal_x);
    const bool must_turn = direction == 1 || below > 0;
    const int whole =
        so_far + static_cast<int>(below + beside) + (must_turn ? (direction == 1 ? kBend : 2 * kBend) : 0);
    if (whole >= budget) return;
    stamp_[state] = search_;
    reached_[state] = so_far;
    from_[state] = from;
    open.push({whole, so_far, static_cast<std::int32_t>(state)});
  };
  const auto index = [](Point p) { return static_cast<std::size_t>(p); };
  const auto is_free = [&](std::int32_t owner) { return owner == kNone || owner == net; };
  const auto may_turn = [&](Point p) {
    return is_free(across_[index(p)]) && is_free(down_[index(p)]) && is_free(reserved_[index(p)]) &&
           !odd_row_[index(p) / xs_.size()] && !odd_column_[index(p) % xs_.size()];
  };
  const auto start = [&](Point p, int direction, int so_far) {
    enter(p, p % width, p / width, direction, so_far, kNone);
  };
  const auto& pieces = nets_[static_cast<std::size_t>(net)].pieces;
  if (pieces.empty()) start(point(nets_[static_cast<std::size_t>(net)].source), 0, 0);
  for (const WirePiece& piece : pieces) {
    visit(piece, [&](std::size_t k) {
      const auto p = static_cast<Point>(k);
      if (blocked_[k] || !may_turn(p)) return;
      start(p, 0, kJunction);
      start(p, 1, kJunction);
    });
  }
  while (!open.empty()) {
    ++work_;
    const auto [whole, so_far, state] = open.top();
    open.pop();
    if (so_far > reached_[static_cast<std::size_t>(state)]) continue;
    const Point p = state / 2;
    if (p == target) {
      used = so_far;
      way.clear();
      for (std::int32_t at = state; at != kNone; at = from_[static_cast<std::size_t>(at)])
        way.push_back(at / 2);
      return true;
    }
    const int direction = state % 2;
    const Point column = p % width, row = p / width;
    for (const int next : {0, 1}) {
      if (next != direction && !may_turn(p)) continue;

      if (next == 0 ? odd_row_[static_cast<std::size_t>(row)] : odd_column_[static_cast<std::size_t>(column)])
        continue;
      for (const int side : {-1, 1}) {
        if (next == 0 && (column + side < 0 || column + side >= width)) continue;
        const Point q = p + side * (next == 0 ? 1 : width);
        if (q < 0 || q >= static_cast<Point>(blocked_.size())) continue;
        if (blocked_[index(q)] && !(q == target && next == 0 && side == 1)) continue;
        const std::int32_t along = next == 0 ? across_[index(q)] : down_[index(q)];
        const std::int32_t crossed = next == 0 ? down_[index(q)] : across_[index(q)];
        if (along != kNone || crossed == net) continue;
        const std::int32_t pin = reserved_[index(q)];
        if (next == 0 && !is_free(pin)) continue;
        const auto& lines = next == 0 ? xs_ : ys_;
        const auto at = static_cast<std::size_t>(next == 0 ? column : row);
        const Point line = (next == 0 ? column : row) + side;
        const auto to = static_cast<std::size_t>(line);
        if (to >= lines.size()) continue;
        const int step = static_cast<int>(std::abs(lines[to] - lines[at]));
        const bool crosses = crossed != kNone || !is_free(pin);
        enter(q, next == 0 ? column + side : column, next == 0 ? row : row + side, next,
              so_far + step + (next != direction ? kBend : 0) + (crosses ? kCrossing : 0), state);
      }
    }
  }
  return false;
}

std::vector<WirePiece> WireRouter::pieces_of(const std::vector<Point>& way) const {
  std::vector<WirePiece> pieces;
  for (std::size_t k = 1; k < way.size(); ++k) {
    const Vector2d a = place(way[k - 1]), b = place(way[k]);
    const bool swap = a.x() > b.x() || a.y() > b.y();
    pieces.push_back(swap ? WirePiece{b, a} : WirePiece{a, b});
  }
  return pieces;
}

bool WireRouter::route(std::size_t net) {
  const std::vector<WirePiece> old = nets_[net].pieces;
  const int old_cost = old.empty() ? std::numeric_limits<int>::max() : cost(net);
  take_up(net);
  std::vector<Vector2d> sinks = nets_[net].sinks;
  std::stable_sort(sinks.begin(), sinks.end(), [&](const Vector2d& a, const Vector2d& b) {
    return (a - nets_[net].source).lpNorm<1>() < (b - nets_[net].source).lpNorm<1>();
  });
  int budget = old_cost;
  std::vector<Point> way;
  for (const Vector2d& sink : sinks) {
    int used = 0;
    if (!find_way(static_cast<std::int32_t>(net), point(sink), budget, way, used)) {
      take_up(net);
      nets_[net].pieces = old;
      lay(net);
      return false;
    }
    if (budget != std::numeric_limits<int>::max()) budget -= used;
    auto& pieces = nets_[net].pieces;
    for (const WirePiece& piece : pieces_of(way)) pieces.push_back(piece);
    pieces = merged(std::move(pieces));
    lay(net);
  }
  if (cost(net) < old_cost) return true;
  take_up(net);
  nets_[net].pieces = old;
  lay(net);
  return false;
}

}  // namespace oblique::draw
