// SPDX-License-Identifier: MIT
#include <oblique/draw/axes.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kNumberSize = 11, kLabelSize = 12, kTitleSize = 13;  // [px]
constexpr double kPixelsPerTick = 62;

/// A range that something can be shown in, even where all values are the same.
void widen(Axis& axis) {
  if (axis.greatest - axis.least > 1e-9 * std::max(std::abs(axis.least), std::abs(axis.greatest))) return;
  const double middle = (axis.least + axis.greatest) / 2;
  const double half = middle == 0 ? 1 : std::abs(middle) / 10;
  axis.least = middle - half;
  axis.greatest = middle + half;
}

/// The axis with its range widened to `span` about the middle.
void grow(Axis& axis, double span) {
  const double middle = (axis.least + axis.greatest) / 2;
  axis.least = middle - span / 2;
  axis.greatest = middle + span / 2;
}

double widest_number(const Axis& axis) {
  double width = 0;
  for (const double value : ticks_between(axis.least, axis.greatest, axis.step))
    width = std::max(width, text_width(tick_text(value, axis.step), kNumberSize));
  return width;
}

void choose_step(Axis& axis, double pixels, bool given) {
  if (!given)
    axis.step =
        round_step(axis.greatest - axis.least, std::max(2, static_cast<int>(pixels / kPixelsPerTick)));
}

}  // namespace

double round_step(double span, int wanted) {
  const double coarse = span / wanted;
  const double power = std::pow(10.0, std::floor(std::log10(coarse)));
  constexpr double kSlack = 1 + 1e-9;  // for quotients that should be whole
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= coarse * kSlack) return factor * power;
  }
  return power;
}

std::vector<double> ticks_between(double least, double greatest, double step) {
  constexpr double kSlack = 1e-9;
  std::vector<double> ticks;
  const double first = std::ceil(least / step - kSlack), last = std::floor(greatest / step + kSlack);
  for (double k = first; k <= last; ++k) ticks.push_back(k * step);
  return ticks;
}

std::string tick_text(double value, double step) {
  const double order = std::floor(std::log10(step) + 1e-9);
  const double rounded = std::abs(value) < step / 1e6 ? 0 : value;
  if (order < -3 || std::abs(value) >= 1e6) return fmt::format("{:.4g}", rounded);
  const int digits = std::max(0, static_cast<int>(-order));
  return (rounded < 0 ? "−" : "") + fmt::format("{:.{}f}", std::abs(rounded), digits);
}

Axes::Axes(const Extent& place, Axis x, Axis y, Shape shape, std::string title)
    : x_(std::move(x)), y_(std::move(y)), title_(std::move(title)) {
  widen(x_);
  widen(y_);
  const bool x_given = x_.step > 0, y_given = y_.step > 0;
  const double top = place.min().y() + (title_.empty() ? 8 : 26);
  const double bottom = place.max().y() - (x_.label.empty() ? 22 : 42);
  choose_step(x_, place.sizes().x(), x_given);
  choose_step(y_, bottom - top, y_given);
  // The numbers' width depends on the range, which with equal axes depends on the frame: twice is enough.
  for (int round = 0; round < 2; ++round) {
    const double left = place.min().x() + widest_number(y_) + (y_.label.empty() ? 12 : 32);
    const double right = place.max().x() - std::max(14.0, widest_number(x_) / 2 + 2);
    frame_ = Extent(Vector2d(left, top), Vector2d(right, bottom));
    const Vector2d size = frame_.sizes();
    if (shape == Shape::equal) {
      const double scale = std::min(size.x() / (x_.greatest - x_.least), size.y() / (y_.greatest - y_.least));
      grow(x_, size.x() / scale);
      grow(y_, size.y() / scale);
    }
    scale_ = Vector2d(size.x() / (x_.greatest - x_.least), size.y() / (y_.greatest - y_.least));
    choose_step(x_, size.x(), x_given);
    choose_step(y_, size.y(), y_given);
    if (shape == Shape::equal) x_.step = y_.step = std::max(x_.step, y_.step);
  }
}

Vector2d Axes::at(const Vector2d& data) const {
  return {frame_.min().x() + (data.x() - x_.least) * scale_.x(),
          frame_.max().y() - (data.y() - y_.least) * scale_.y()};
}

std::vector<Mark> Axes::marks() const {
  std::vector<Mark> marks;
  constexpr double kGridOpacity = 0.45;
  const Vector2d low = frame_.min(), high = frame_.max();
  const auto add_line = [&](const Vector2d& from, const Vector2d& to, bool zero) {
    marks.push_back(line_mark(from, to, {Ink::faint, zero ? 1.5 : 1}));
    marks.back().opacity = zero ? 1 : kGridOpacity;
  };
  const std::vector<double> x_ticks = ticks_between(x_.least, x_.greatest, x_.step);
  const std::vector<double> y_ticks = ticks_between(y_.least, y_.greatest, y_.step);
  for (const double value : x_ticks) {
    const double x = at({value, 0}).x();
    add_line({x, low.y()}, {x, high.y()}, std::abs(value) < x_.step / 2);
  }
  for (const double value : y_ticks) {
    const double y = at({0, value}).y();
    add_line({low.x(), y}, {high.x(), y}, std::abs(value) < y_.step / 2);
  }
  for (const double value : x_ticks)
    marks.push_back(label_mark({at({value, 0}).x(), high.y() + 16}, tick_text(value, x_.step), Anchor::middle,
                               kNumberSize));
  for (const double value : y_ticks)
    marks.push_back(label_mark({low.x() - 6, at({0, value}).y() + 4}, tick_text(value, y_.step), Anchor::end,
                               kNumberSize));
  marks.push_back(box_mark(low, frame_.sizes(), Ink::none, {Ink::faint, 1}));
  const Vector2d middle = frame_.center();
  if (!x_.label.empty())
    marks.push_back(label_mark({middle.x(), high.y() + 35}, x_.label, Anchor::middle, kLabelSize));
  if (!y_.label.empty()) {
    Label label{{low.x() - widest_number(y_) - 16, middle.y()}, y_.label, Anchor::middle, kLabelSize};
    label.turned = -90;
    marks.push_back({label, {Ink::none, 0}, Ink::line});
  }
  if (!title_.empty()) {
    Label label{{low.x(), low.y() - 9}, title_, Anchor::start, kTitleSize, true};
    marks.push_back({label, {Ink::none, 0}, Ink::line});
  }
  return marks;
}

Mark curve_mark(const Axes& axes, const std::vector<Vector2d>& data, const Pen& pen) {
  Outline outline;
  bool down = false;  // the pen
  for (const Vector2d& point : data) {
    const bool known = point.allFinite();
    if (known) outline.segments.push_back({down ? Segment::Kind::line : Segment::Kind::move, axes.at(point)});
    down = known;
  }
  return {std::move(outline), pen};
}

}  // namespace oblique
