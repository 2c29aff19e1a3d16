// SPDX-License-Identifier: MIT
#include <oblique/draw/point_plots.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/axes.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kWidth = 1080, kHeight = 640, kMargin = 14, kHead = 48;  // [px]
constexpr int kColumns = 3;

/// A quantity over the drive.
struct Curve {
  std::string id;
  Ink ink = Ink::blue;
  std::vector<double> values;
};

Extent cell(int column, int row) {
  const double width = (kWidth - 2 * kMargin) / kColumns, height = (kHeight - kHead - kMargin) / 2;
  const Vector2d corner(kMargin + column * width, kHead + row * height);
  return {corner, Vector2d(corner + Vector2d(width, height - 6))};
}

/// "10³ ": the power of a thousand that makes numbers of this size readable, and the power itself.
struct Prefix {
  std::string text;
  double factor = 1;
};

Prefix prefix_for(double largest) {
  static const char* const kDigits[] = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (!(largest > 0) || (largest >= 1e-2 && largest < 1e4)) return {};
  const int power = 3 * static_cast<int>(std::floor(std::log10(largest) / 3));
  std::string text = power < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(power))) text += kDigits[digit - '0'];
  return {text + " ", std::pow(10.0, power)};
}

/// A range with a little room at both ends.
Axis axis_of(const std::vector<double>& values, std::string label) {
  Axis axis{std::move(label), INFINITY, -INFINITY};
  for (const double value : values) {
    if (!std::isfinite(value)) continue;
    axis.least = std::min(axis.least, value);
    axis.greatest = std::max(axis.greatest, value);
  }
  if (axis.least > axis.greatest) return {std::move(axis.label), 0, 1};
  constexpr double kRoom = 0.06;
  const double room = kRoom * (axis.greatest - axis.least);
  axis.least -= room;
  axis.greatest += room;
  return axis;
}

double largest_of(const std::vector<Curve>& curves) {
  double largest = 0;
  for (const Curve& curve : curves) {
    for (const double value : curve.values) {
      if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
    }
  }
  return largest;
}

Axis drive_axis(const PointHistory& history) {
  const auto [least, greatest] = std::minmax_element(history.drives.begin(), history.drives.end());
  Axis axis{fmt::format("{} [{}]", history.drive, history.drive_unit), *least, *greatest};
  constexpr double kQuarter = 90;
  if (history.drive_unit == "°" && axis.greatest - axis.least > 2 * kQuarter) {
    axis.step = kQuarter * std::max(1.0, std::round((axis.greatest - axis.least) / (5 * kQuarter)));
  }
  return axis;
}

void add_path(Picture& picture, const PointHistory& history) {
  std::vector<double> x, y;
  std::vector<Vector2d> path;
  for (const PointState& state : history.states) {
    path.push_back(state.position);
    x.push_back(state.position.x());
    y.push_back(state.position.y());
  }
  const std::string unit = fmt::format(" [{}]", history.length_unit);
  const Axes axes(cell(0, 0), axis_of(x, "x" + unit), axis_of(y, "y" + unit), Axes::Shape::equal, "path");
  for (Mark& mark : axes.marks()) picture.marks.push_back(std::move(mark));
  picture.marks.push_back(curve_mark(axes, path, {Ink::line, 2}));
  picture.marks.back().id = "path";
}

void add_curves(Picture& picture, const PointHistory& history, const Extent& place, std::vector<Curve> curves,
                const std::string& title, const std::string& unit) {
  const Prefix prefix = prefix_for(largest_of(curves));
  std::vector<double> all;
  for (Curve& curve : curves) {
    for (double& value : curve.values) value /= prefix.factor;
    all.insert(all.end(), curve.values.begin(), curve.values.end());
  }
  const Axes axes(place, drive_axis(history), axis_of(all, fmt::format("[{}{}]", prefix.text, unit)),
                  Axes::Shape::stretched, title);
  for (Mark& mark : axes.marks()) picture.marks.push_back(std::move(mark));
  double x = axes.frame().max().x();
  for (std::size_t k = curves.size(); k-- > 0;) {
    std::vector<Vector2d> points;
    for (std::size_t i = 0; i < history.drives.size(); ++i)
      points.emplace_back(history.drives[i], curves[k].values[i]);
    picture.marks.push_back(curve_mark(axes, points, {curves[k].ink, 2}));
    picture.marks.back().id = curves[k].id;
    if (curves.size() < 2) continue;
    constexpr double kSize = 12, kSwatch = 20, kGap = 14;  // a legend at the right of the title
    const double y = axes.frame().min().y() - 9;
    picture.marks.push_back(label_mark({x, y}, curves[k].id, Anchor::end, kSize));
    x -= text_width(curves[k].id, kSize) + 5;
    picture.marks.push_back(line_mark({x - kSwatch, y - 4}, {x, y - 4}, {curves[k].ink, 2}));
    x -= kSwatch + kGap;
  }
}

Curve component(const PointHistory& history, std::string id, Ink ink, Vector2d PointState::*vector,
                int axis) {
  Curve curve{std::move(id), ink, {}};
  for (const PointState& state : history.states) curve.values.push_back((state.*vector)[axis]);
  return curve;
}

}  // namespace

Picture draw_point_plots(const PointHistory& history) {
  Picture picture{kWidth, kHeight, fmt::format("{}: point {}", history.title, history.point), {}};
  constexpr double kTitleSize = 17;
  Label title{{kMargin + 4, 30}, picture.title, Anchor::start, kTitleSize, true};
  title.size =
      std::min(kTitleSize, kTitleSize * (kWidth - 3 * kMargin) / text_width(title.text, kTitleSize, true));
  picture.marks.push_back({title, {Ink::none, 0}, Ink::line});
  const auto of = [&](const char* id, Ink ink, Vector2d PointState::*vector, int axis) {
    return component(history, id, ink, vector, axis);
  };
  const std::string length = history.length_unit, velocity = length + "/s", acceleration = length + "/s²";
  add_path(picture, history);
  add_curves(
      picture, history, cell(0, 1),
      {of("x", Ink::blue, &PointState::position, 0), of("y", Ink::vermilion, &PointState::position, 1)},
      "coordinates", length);
  add_curves(picture, history, cell(1, 0), {of("vx", Ink::blue, &PointState::velocity, 0)}, "velocity in x",
             velocity);
  add_curves(picture, history, cell(1, 1), {of("vy", Ink::vermilion, &PointState::velocity, 1)},
             "velocity in y", velocity);
  add_curves(picture, history, cell(2, 0), {of("ax", Ink::blue, &PointState::acceleration, 0)},
             "acceleration in x", acceleration);
  add_curves(picture, history, cell(2, 1), {of("ay", Ink::vermilion, &PointState::acceleration, 1)},
             "acceleration in y", acceleration);
  return picture;
}

}  // namespace oblique
