// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/point_plots.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kWidth = 1080, kHeight = 230;  // [px]
constexpr std::size_t kOfX = 0, kOfY = 1;       ///< what numbers a curve; its colour

/// Components of a vector over the drive.
class OverDrive {
 public:
  explicit OverDrive(const PointHistory& history) : history_(history) {}

  Curve path() const {
    Curve path{{}, {}, Curve::kPlain};
    const std::vector<double> x = values(&mechanism::PointState::position, kOfX),
                              y = values(&mechanism::PointState::position, kOfY);
    for (std::size_t k = 0; k < x.size(); ++k) path.points.emplace_back(x[k], y[k]);
    return path;
  }

  Curve curve(std::string name, Vector2d mechanism::PointState::*vector, std::size_t axis) const {
    Curve curve{std::move(name), {}, axis};
    const std::vector<double> values = this->values(vector, axis);
    for (std::size_t k = 0; k < values.size(); ++k) curve.points.emplace_back(history_.drives[k], values[k]);
    if (history_.ends_at_limit && vector != &mechanism::PointState::position) leave_out_extremes(curve);
    return curve;
  }

  Panel panel(std::string title, std::string unit, std::vector<Curve> curves) const {
    return {{history_.drive, history_.drive_unit},
            {std::move(title), std::move(unit)},
            std::move(curves),
            kHeight};
  }

 private:
  /// A component, with 0 for what is as small as rounding beside the vector, or beside the whole mechanism.
  std::vector<double> values(Vector2d mechanism::PointState::*vector, std::size_t axis) const {
    constexpr double kOfVector = 1e-9, kOfMechanism = 1e-12;
    const int order = vector == &mechanism::PointState::position   ? 0
                      : vector == &mechanism::PointState::velocity ? 1
                                                                   : 2;
    const double least =
        std::max(kOfVector * typical(vector), kOfMechanism * history_.size * std::pow(history_.rate, order));
    std::vector<double> values;
    for (const mechanism::PointState& state : history_.states) {
      const double value = (state.*vector)[static_cast<Eigen::Index>(axis)];
      values.push_back(std::abs(value) < least ? 0 : value);
    }
    return values;
  }

  /// The length of the vector that it exceeds a fifth of the time: at a limit it rises beyond all bounds.
  double typical(Vector2d mechanism::PointState::*vector) const {
    std::vector<double> lengths;
    for (const mechanism::PointState& state : history_.states) lengths.push_back((state.*vector).norm());
    return exceeded_by_a_fifth(std::move(lengths));
  }

  /// Of those that are finite; 0 where none is.
  static double exceeded_by_a_fifth(std::vector<double> sizes) {
    std::erase_if(sizes, [](double size) { return !std::isfinite(size); });
    if (sizes.empty()) return 0;
    const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() * 4 / 5);
    std::nth_element(sizes.begin(), place, sizes.end());
    return *place;
  }

  /// Four times what a fifth of the values exceed is the most that is drawn.
  static void leave_out_extremes(Curve& curve) {
    constexpr double kTimes = 4;
    std::vector<double> sizes;
    for (const Vector2d& point : curve.points) sizes.push_back(std::abs(point.y()));
    const double most = kTimes * exceeded_by_a_fifth(std::move(sizes));
    for (Vector2d& point : curve.points) {
      if (std::abs(point.y()) > most) point.y() = std::numeric_limits<double>::quiet_NaN();
    }
  }

  const PointHistory& history_;
};

Panel path_of(const PointHistory& history) {
  Panel panel{
      {"x", history.length_unit}, {"path: y", history.length_unit}, {OverDrive(history).path()}, kHeight};
  panel.equal = true;
  return panel;
}

}  // namespace

Chart point_plots(const PointHistory& history) {
  const OverDrive over(history);
  const auto position = &mechanism::PointState::position, velocity = &mechanism::PointState::velocity,
             acceleration = &mechanism::PointState::acceleration;
  const std::string length = history.length_unit, per_second = length + "/s", per_square = length + "/s²";
  Chart chart;
  chart.title = fmt::format("{}: point {}", history.title, history.point);
  chart.width = kWidth;
  chart.columns = 3;
  chart.panels = {
      path_of(history),
      over.panel("coordinates", length, {over.curve("x", position, kOfX), over.curve("y", position, kOfY)}),
      over.panel("velocity in x", per_second, {over.curve({}, velocity, kOfX)}),
      over.panel("velocity in y", per_second, {over.curve({}, velocity, kOfY)}),
      over.panel("acceleration in x", per_square, {over.curve({}, acceleration, kOfX)}),
      over.panel("acceleration in y", per_square, {over.curve({}, acceleration, kOfY)})};
  return chart;
}

}  // namespace oblique::draw
