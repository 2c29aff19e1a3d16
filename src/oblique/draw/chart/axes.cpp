// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/axes.h>

#include <algorithm>
#include <cmath>

#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

/// Grid lines lie at least so far apart [px]. Those of equal axes do so in both directions: they are squares.
constexpr double kBetweenX = 62, kBetweenY = 40, kBetweenEqual = 50;
constexpr double kBetweenNumbers = 10;  // [px]
constexpr double kHalfDigit = 4;        // [px]
const Pen grid_pen{Ink::faint, 0.75}, fine_grid_pen{Ink::faint, 0.35}, zero_pen{Ink::faint, 1.5},
    frame_pen{Ink::faint, 1};

double width_of(const std::vector<Tick>& ticks) {
  double width = 0;
  for (const Tick& tick : ticks) width = std::max(width, text_width(tick.label, Axes::kNumberSize));
  return width;
}

/// As many ticks as have room beside each other along `length` [px].
std::vector<Tick> ticks_along_x(const Scale& scale, double length, double between) {
  constexpr double kFewer = 0.8;
  std::vector<Tick> ticks;
  bool apart = false;
  double most = std::max(2.0, length / between);
  while (!apart && most >= 1) {
    ticks = scale.ticks(most);
    double end = -INFINITY;
    apart = true;
    for (const Tick& tick : ticks) {
      if (tick.label.empty()) continue;
      const double middle = scale.fraction(tick.value) * length;
      const double half = text_width(tick.label, Axes::kNumberSize) / 2;
      apart = apart && middle - half >= end;
      end = middle + half + kBetweenNumbers;
    }
    most *= kFewer;
  }
  return ticks;
}

Mark grid_line(const Vector2d& from, const Vector2d& to, const Tick& tick, const Scale& scale) {
  const bool zero = !scale.is_logarithmic() && tick.value == 0;
  return line_mark(from, to, zero ? zero_pen : tick.label.empty() ? fine_grid_pen : grid_pen);
}

}  // namespace

Axes::Axes(const Extent& frame, Scale x, Scale y, Shape shape)
    : frame_(frame), x_(std::move(x)), y_(std::move(y)), shape_(shape) {
  if (shape == Shape::stretched) return;
  const Vector2d size = frame.sizes();
  const double unit = std::max((x_.high() - x_.low()) / size.x(), (y_.high() - y_.low()) / size.y());
  x_.widen(unit * size.x());
  y_.widen(unit * size.y());
  x_.count_like(y_);
  y_.count_like(x_);
}

Axes Axes::within(const Extent& place, const Scale& x, const Scale& y, Shape shape) {
  const double top = place.min().y() + kHead + kTitleSize, bottom = place.max().y() - kFoot - 4;
  Axes axes(Extent(Vector2d(place.min().x(), top), Vector2d(place.max().x(), bottom)), x, y, shape);
  // The width of the numbers depends on the range, and that of equal axes on the frame: twice is enough.
  for (int round = 0; round < 2; ++round) {
    const double left = place.min().x() + axes.number_width() + kTickGap + 2;
    const double right = place.max().x() - std::max(14.0, width_of(axes.x_ticks()) / 2 + 2);
    axes = Axes(Extent(Vector2d(left, top), Vector2d(right, bottom)), x, y, shape);
  }
  return axes;
}

Vector2d Axes::at(const Vector2d& data) const {
  return {frame_.min().x() + x_.fraction(data.x()) * frame_.sizes().x(),
          frame_.max().y() - y_.fraction(data.y()) * frame_.sizes().y()};
}

bool Axes::shows(const Vector2d& data) const {
  return x_.shows(data.x()) && y_.shows(data.y());
}

Vector2d Axes::scale() const {
  return frame_.sizes().cwiseQuotient(Vector2d(x_.high() - x_.low(), y_.high() - y_.low()));
}

std::vector<Tick> Axes::x_ticks() const {
  return ticks_along_x(x_, frame_.sizes().x(), shape_ == Shape::equal ? kBetweenEqual : kBetweenX);
}

std::vector<Tick> Axes::y_ticks() const {
  const double between = shape_ == Shape::equal ? kBetweenEqual : kBetweenY;
  return y_.ticks(std::max(2.0, frame_.sizes().y() / between));
}

double Axes::number_width() const {
  return width_of(y_ticks());
}

std::vector<Mark> Axes::grid() const {
  std::vector<Mark> marks;
  const Vector2d low = frame_.min(), high = frame_.max();
  for (const Tick& tick : x_ticks()) {
    const double x = low.x() + x_.fraction(tick.value) * frame_.sizes().x();
    marks.push_back(grid_line({x, low.y()}, {x, high.y()}, tick, x_));
  }
  for (const Tick& tick : y_ticks()) {
    const double y = high.y() - y_.fraction(tick.value) * frame_.sizes().y();
    marks.push_back(grid_line({low.x(), y}, {high.x(), y}, tick, y_));
  }
  return marks;
}

std::vector<Mark> Axes::marks_without_x(double head) const {
  std::vector<Mark> marks = grid();
  const Vector2d low = frame_.min(), high = frame_.max();
  for (const Tick& tick : y_ticks()) {
    if (tick.label.empty()) continue;
    const double y = high.y() - y_.fraction(tick.value) * frame_.sizes().y();
    marks.push_back(label_mark({low.x() - kTickGap, y + kHalfDigit}, tick.label, Anchor::end, kNumberSize));
  }
  marks.push_back(box_mark(low, frame_.sizes(), Ink::none, frame_pen));
  const std::string title = y_.title();
  if (!title.empty())
    marks.push_back(label_mark({low.x(), low.y() - head}, title, Anchor::start, kTitleSize));
  return marks;
}

std::vector<Mark> Axes::marks(double head) const {
  std::vector<Mark> marks = marks_without_x(head);
  const Vector2d low = frame_.min(), high = frame_.max();
  for (const Tick& tick : x_ticks()) {
    if (tick.label.empty()) continue;
    const double x = low.x() + x_.fraction(tick.value) * frame_.sizes().x();
    marks.push_back(
        label_mark({x, high.y() + kTickGap + kNumberSize}, tick.label, Anchor::middle, kNumberSize));
  }
  marks.push_back(
      label_mark({frame_.center().x(), high.y() + kFoot - 2}, x_.title(), Anchor::middle, kTitleSize));
  return marks;
}

Mark curve_mark(const Axes& axes, const std::vector<Vector2d>& data, const Pen& pen) {
  Outline outline;
  bool down = false;  // the pen
  for (const Vector2d& point : data) {
    const bool known = axes.shows(point);
    if (known) outline.segments.push_back({down ? Segment::Kind::line : Segment::Kind::move, axes.at(point)});
    down = known;
  }
  return {std::move(outline), pen};
}

}  // namespace oblique::draw
