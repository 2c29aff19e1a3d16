// SPDX-License-Identifier: MIT
#include <oblique/mechanism/motion/path_measure.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace oblique::mechanism {
namespace {

constexpr std::array kNodes{-0.991455371120812639206854697526329, -0.949107912342758524526189684047851,
                            -0.864864423359769072789712788640926, -0.741531185599394439863864773280788,
                            -0.586087235467691130294144691258287, -0.405845151377397166906606412076961,
                            -0.207784955007898467600689403773245, 0.0};
constexpr std::array kKronrod{0.022935322010529224963732008058970, 0.063092092629978553290700663189204,
                              0.104790010322250183839876322541518, 0.140653259715525918745189590510238,
                              0.169004726639267902826583426598550, 0.190350578064785409913256402421014,
                              0.204432940075298892414161999234649, 0.209482141084727828012999174891714};
constexpr std::array kGauss{0.129484966168869693270611432679082, 0.279705391489276667901467771423780,
                            0.381830050505118944950369775488975, 0.417959183673469387755102040816327};
constexpr double kTolerance = 1e-10;  ///< of the largest link, over the whole motion range
constexpr int kMostHalvings = 40;     ///< down to the rounding of u
constexpr double kGain = 0.35;        ///< a corner loses three quarters of its error by a halving
constexpr int kMostStalled = 3;
constexpr double kNever = std::numeric_limits<double>::infinity();

class Quadrature {
 public:
  Quadrature(RangeWalk& walk, std::vector<std::size_t> points)
      : walk_(walk),
        points_(std::move(points)),
        size_(walk.mechanism().largest_length()),
        lengths_(points_.size()),
        areas_(points_.size()) {
    for (const std::size_t point : points_) origins_.push_back(walk.go(0).points[point].position);
  }

  /// Adds the integrals over [a, b] of u. Near a limit the velocities are noise at last, which no halving
  /// takes away: an interval whose ancestors gained nothing by being halved is taken as it is.
  void add(double a, double b, int halvings = kMostHalvings, double error_before = kNever, int stalled = 0) {
    std::vector<Sums> sums(points_.size());
    for (std::size_t i = 0; i < 15; ++i) {
      const std::size_t node = std::min(i, 14 - i);
      const double u = (a + b) / 2 + (i > 7 ? -1 : 1) * kNodes[node] * (b - a) / 2;
      const Configuration& here = walk_.go(u);
      const double factor = walk_.motion_range().rate(u) * (b - a) / 2;
      for (std::size_t p = 0; p < points_.size(); ++p) {
        const PointState& state = here.points[points_[p]];
        const Eigen::Vector2d way = factor * state.velocity;
        const double length = way.norm();
        const Eigen::Vector2d arm = state.position - origins_[p];
        const double area = (arm.x() * way.y() - arm.y() * way.x()) / 2;
        sums[p].length += kKronrod[node] * length;
        sums[p].area += kKronrod[node] * area;
        if (node % 2 == 0) continue;
        sums[p].coarse_length += kGauss[node / 2] * length;
        sums[p].coarse_area += kGauss[node / 2] * area;
      }
    }
    double error = 0;
    for (const Sums& s : sums) {
      error =
          std::max({error, std::abs(s.length - s.coarse_length), std::abs(s.area - s.coarse_area) / size_});
    }
    stalled = error > kGain * error_before ? stalled + 1 : 0;
    if (error > kTolerance * size_ * std::sqrt(b - a) / 10 && halvings > 0 && stalled < kMostStalled) {
      const double middle = a + (b - a) / 2;
      add(a, middle, halvings - 1, error, stalled);
      add(middle, b, halvings - 1, error, stalled);
      return;
    }
    for (std::size_t p = 0; p < points_.size(); ++p) {
      lengths_[p] += sums[p].length;
      areas_[p] += sums[p].area;
    }
  }

  double length(std::size_t p) const { return lengths_[p]; }
  double area(std::size_t p) const { return areas_[p]; }

 private:
  struct Sums {
    double length = 0, area = 0, coarse_length = 0, coarse_area = 0;
  };
  RangeWalk& walk_;
  std::vector<std::size_t> points_;
  double size_;
  std::vector<double> lengths_, areas_;
  std::vector<Eigen::Vector2d> origins_;  ///< where the paths begin: areas are counted from there
};

}  // namespace

std::vector<PathMeasure> measure_paths(RangeWalk& walk) {
  const Mechanism& mechanism = walk.mechanism();
  std::vector<PathMeasure> paths;
  std::vector<std::size_t> points;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!mechanism.points[p].fixed) points.push_back(p);
  }
  const std::size_t panels = walk.motion_range().samples / 40;
  Quadrature quadrature(walk, points);
  for (std::size_t k = 0; k < panels; ++k) {
    quadrature.add(static_cast<double>(k) / static_cast<double>(panels),
                   static_cast<double>(k + 1) / static_cast<double>(panels));
  }
  const std::vector<PointState> last = walk.go(1).points;
  const std::vector<PointState>& first = walk.go(0).points;
  constexpr double kSame = 1e-7;
  for (std::size_t i = 0; i < points.size(); ++i) {
    PathMeasure path{points[i], quadrature.length(i), std::nullopt};
    const double gap = (last[points[i]].position - first[points[i]].position).norm();
    if (gap < kSame * mechanism.largest_length()) path.area = quadrature.area(i);
    paths.push_back(path);
  }
  return paths;
}

}  // namespace oblique::mechanism
