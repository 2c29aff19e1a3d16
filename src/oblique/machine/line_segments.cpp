// SPDX-License-Identifier: MIT
#include <oblique/machine/line_segments.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

namespace oblique::machine {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// Of the span of the function: what is left between lines that are the function itself.
constexpr double kExact = 1e-10;
/// Of the span: more than this over a hair's breadth is a jump.
constexpr double kJump = 1e-2;
constexpr double kHair = 1e-9;  ///< of the range of x

struct Point {
  double x = 0, y = 0;
};

/// How far the line from `a` to `b` lies above the function at the point.
double above(const Point& a, const Point& b, const Point& point) {
  return a.y + (b.y - a.y) * (point.x - a.x) / (b.x - a.x) - point.y;
}

class Fitter {
 public:
  Fitter(const std::function<double(double)>& function, double from, double to, int most)
      : function_(function), from_(from), to_(to), most_(static_cast<std::size_t>(most)) {
    constexpr int kGrid = 1024;
    grid_.reserve(kGrid + 1);
    for (int k = 0; k <= kGrid; ++k) grid_.push_back(at(k == kGrid ? to : from + (to - from) * k / kGrid));
  }

  LineSegments make() {
    for (const Point& point : grid_) {
      if (!std::isfinite(point.y)) return {{}, kInfinity};
    }
    look_at_span();
    if (span_ == 0) return finish({grid_.front(), grid_.back()});
    if (jumps()) return {{}, kInfinity};
    std::vector<Point> corners = split_at_corners();
    LineSegments exact = finish(corners);
    if (exact.error <= kExact * span_) return exact;
    // Corners of the function belong to the points that lines may start from.
    grid_.insert(grid_.end(), corners.begin(), corners.end());
    std::sort(grid_.begin(), grid_.end(), [](const Point& a, const Point& b) { return a.x < b.x; });
    const auto same = [](const Point& a, const Point& b) { return a.x == b.x; };
    grid_.erase(std::unique(grid_.begin(), grid_.end(), same), grid_.end());
    look_at_span();  // which a peak between the points of the grid had no part in
    const std::vector<Point> even = even_lines();
    LineSegments on_curve = finish(even), balanced = finish(balance(even));
    LineSegments& better = balanced.error < on_curve.error ? balanced : on_curve;
    return better.error < exact.error ? std::move(better) : std::move(exact);
  }

 private:
  Point at(double x) const { return {x, function_(x)}; }

  void look_at_span() {
    for (const Point& point : grid_) {
      low_ = std::min(low_, point.y);
      high_ = std::max(high_, point.y);
    }
    span_ = high_ - low_;
  }

  /// The point between two where the function is farthest from their line, as far as it is known.
  Point farthest(const Point& a, const Point& b) const {
    constexpr int kTrials = 32;
    const auto distance = [&](const Point& point) { return std::abs(above(a, b, point)); };
    int best = 1;
    double most = -1;
    for (int k = 1; k < kTrials; ++k) {
      const double d = distance(at(a.x + (b.x - a.x) * k / kTrials));
      if (d > most) {
        most = d;
        best = k;
      }
    }
    double left = a.x + (b.x - a.x) * (best - 1) / kTrials, right = a.x + (b.x - a.x) * (best + 1) / kTrials;
    constexpr int kHalvings = 80;
    const double golden = (std::sqrt(5.0) - 1) / 2;
    for (int k = 0; k < kHalvings; ++k) {
      const double one = right - golden * (right - left), other = left + golden * (right - left);
      if (distance(at(one)) < distance(at(other))) {
        left = one;
      } else {
        right = other;
      }
    }
    // Beside a peak that is narrower than the trials the search finds less than they did.
    const Point found = at((left + right) / 2), tried = at(a.x + (b.x - a.x) * best / kTrials);
    return distance(found) < most ? tried : found;
  }

  /// Splits the line that errs most at the point where it does, until there are enough of them or none errs.
  std::vector<Point> split_at_corners() const {
    std::vector<Point> points{grid_.front(), grid_.back()};
    std::vector<Point> worst{farthest(points[0], points[1])};  // of each line
    while (points.size() <= most_) {
      std::size_t line = 0;
      double most = -1;
      for (std::size_t k = 0; k < worst.size(); ++k) {
        if (points[k + 1].x - points[k].x < kHair * (to_ - from_)) continue;
        if (worst[k].x <= points[k].x || worst[k].x >= points[k + 1].x) continue;
        const double error = std::abs(above(points[k], points[k + 1], worst[k]));
        if (error > most) {
          most = error;
          line = k;
        }
      }
      if (most <= kExact * span_) break;
      const auto next = static_cast<std::ptrdiff_t>(line) + 1;
      points.insert(points.begin() + next, worst[line]);
      worst[line] = farthest(points[line], points[line + 1]);
      worst.insert(worst.begin() + next, farthest(points[line + 1], points[line + 2]));
    }
    return points;
  }

  /// Whether the function changes by more than a continuous one can over a hair's breadth, where it is
  /// steepest between two points of the grid.
  bool jumps() const {
    for (std::size_t k = 1; k < grid_.size(); ++k) {
      Point a = grid_[k - 1], b = grid_[k];
      while (std::abs(b.y - a.y) > kJump * span_ && b.x - a.x > kHair * (to_ - from_)) {
        const Point middle = at((a.x + b.x) / 2);
        if (!std::isfinite(middle.y)) return true;
        (std::abs(middle.y - a.y) > std::abs(b.y - middle.y) ? b : a) = middle;
      }
      if (std::abs(b.y - a.y) > kJump * span_) return true;
    }
    return false;
  }

  /// The farthest point from `first` on to which one line errs by at most `error`.
  std::size_t reach(std::size_t first, double error) const {
    std::size_t last = first + 1;
    for (std::size_t next = last + 1; next < grid_.size(); ++next) {
      bool fits = true;
      for (std::size_t k = first + 1; fits && k < next; ++k)
        fits = std::abs(above(grid_[first], grid_[next], grid_[k])) <= error;
      if (!fits) break;
      last = next;
    }
    return last;
  }

  std::vector<Point> lines_within(double error) const {
    std::vector<Point> points{grid_.front()};
    for (std::size_t k = 0; k + 1 < grid_.size() && points.size() <= most_ + 1;) {
      k = reach(k, error);
      points.push_back(grid_[k]);
    }
    return points;
  }

  /// The least error with which the lines are few enough, to a thousandth of it.
  std::vector<Point> even_lines() const {
    double low = 0, high = span_;
    std::vector<Point> best = lines_within(high);
    while (high - low > 1e-3 * high) {
      const double middle = (low + high) / 2;
      std::vector<Point> points = lines_within(middle);
      if (points.size() <= most_ + 1 && points.back().x == to_) {
        high = middle;
        best = std::move(points);
      } else {
        low = middle;
      }
    }
    return best;
  }

  /// Lines through points of a curve lie on one side of it: moved by half their error they err half as much.
  /// Those of a function that has one sign, as the rate of a reaction, keep it.
  std::vector<Point> balance(std::vector<Point> points) const {
    std::vector<double> errors;
    for (std::size_t k = 1; k < points.size(); ++k)
      errors.push_back(above(points[k - 1], points[k], farthest(points[k - 1], points[k])));
    points.front().y -= errors.front() / 2;
    points.back().y -= errors.back() / 2;
    for (std::size_t k = 1; k + 1 < points.size(); ++k) points[k].y -= (errors[k - 1] + errors[k]) / 4;
    for (Point& point : points) {
      if (low_ > 0) point.y = std::max(point.y, low_);
      if (high_ < 0) point.y = std::min(point.y, high_);
    }
    return points;
  }

  LineSegments finish(const std::vector<Point>& points) const {
    LineSegments lines;
    lines.low = low_;
    lines.high = high_;
    for (const Point& point : points) {
      lines.points.x.push_back(point.x);
      lines.points.y.push_back(point.y);
      lines.error = std::max(lines.error, std::abs(point.y - function_(point.x)));
    }
    for (std::size_t k = 1; k < points.size(); ++k)
      lines.error = std::max(lines.error,
                             std::abs(above(points[k - 1], points[k], farthest(points[k - 1], points[k]))));
    std::size_t line = 1;
    for (const Point& point : grid_) {
      while (line + 1 < points.size() && points[line].x < point.x) ++line;
      lines.error = std::max(lines.error, std::abs(above(points[line - 1], points[line], point)));
    }
    return lines;
  }

  const std::function<double(double)>& function_;
  double from_, to_;
  std::size_t most_;
  double low_ = kInfinity, high_ = -kInfinity, span_ = 0;  ///< of the function
  std::vector<Point> grid_;
};

}  // namespace

LineSegments line_segments(const std::function<double(double)>& function, double from, double to, int most) {
  return Fitter(function, from, to, most).make();
}

}  // namespace oblique::machine
