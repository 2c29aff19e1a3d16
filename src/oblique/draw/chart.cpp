// SPDX-License-Identifier: MIT
#include <oblique/draw/chart.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart_layout.h>
#include <oblique/draw/scale.h>

namespace oblique {
namespace {

using Eigen::Vector2d;

constexpr double kMargin = 20, kText = 12, kTitle = 15, kLine = 18;  // [px]
constexpr double kSample = 22;                                       ///< of a line in a legend
constexpr double kEntryGap = 18;                                     ///< between the names of a legend
constexpr double kLeastWidth = 300, kLeastHeight = 100;              ///< of a plot with equal scales
constexpr double kTickGap = 6;                                       ///< between a plot and its numbers
constexpr Pen kGrid{Ink::faint, 0.75}, kFineGrid{Ink::faint, 0.35}, kFrame{Ink::line, 1};

/// A line that crosses itself this often would be a blot if it were as thick as others.
constexpr std::size_t kPointsOfThinLine = 4000;
constexpr double kThinLine = 0.6;  // [px]

Pen pen_of(const Curve& curve) {
  const std::size_t accents = std::size(kAccents);
  Pen pen{kAccents[curve.number % accents], 1.75};
  if (curve.number / accents % 3 == 1) pen.dashes = {7, 4};
  if (curve.number / accents % 3 == 2) pen.dashes = {1.5, 4};
  if (curve.number == Curve::kPlain) pen = {Ink::line, 1.25};
  if (curve.style == Curve::Style::guide) {
    pen.width = 1.25;
    pen.dashes = {5, 4};
  }
  return pen;
}

/// A row of the legend as names with their samples, left to right.
struct LegendEntry {
  const Curve* curve = nullptr;
  double left = 0;  ///< from the left edge of the plot [px]
  int row = 0;
};

/// One panel with where its parts go.
class PanelPainter {
 public:
  PanelPainter(const Panel& panel, std::size_t index, const PanelScales& scales, bool shows_x)
      : panel_(panel), index_(index), x_(scales.x), y_(scales.y), shows_x_(shows_x) {}

  double label_width() const {
    double width = 0;
    for (const Tick& tick : y_ticks()) width = std::max(width, text_width(tick.label, kText));
    return width;
  }

  /// Gives the parts their places: the plot from `left` to `right`, its head from `top` on. Gives where the
  /// panel ends.
  double place(double left, double right, double top) {
    left_ = left;
    right_ = right;
    double height = panel_.height;
    if (panel_.equal) {
      const double ratio = (x_.high() - x_.low()) / (y_.high() - y_.low());
      right_ = std::min(right, left + std::max(kLeastWidth, height * ratio));
      height = std::clamp((right_ - left_) / ratio, kLeastHeight, height);
    }
    head_ = top + kText;
    top_ = head_ + kLine * place_legend() + 10;
    bottom_ = top_ + height;
    if (panel_.equal) equalise();
    return bottom_ + (shows_x_ ? kTickGap + kText + kLine + 6 : 0);
  }

  double right() const { return right_; }

  void paint(std::vector<Mark>& marks) const {
    paint_grid(marks);
    for (std::size_t c = 0; c < panel_.curves.size(); ++c) paint(panel_.curves[c], c, marks);
    marks.push_back(label_mark({left_, head_}, y_.title()));
    for (const LegendEntry& entry : legend_) paint(entry, marks);
    if (shows_x_) {
      marks.push_back(
          label_mark({(left_ + right_) / 2, bottom_ + kTickGap + kText + kLine}, x_.title(), Anchor::middle));
    }
  }

 private:
  void equalise() {
    const double x_unit = (x_.high() - x_.low()) / (right_ - left_);
    const double y_unit = (y_.high() - y_.low()) / (bottom_ - top_);
    const double unit = std::max(x_unit, y_unit);
    x_.widen(unit * (right_ - left_));
    y_.widen(unit * (bottom_ - top_));
  }

  std::vector<Tick> x_ticks() const {
    return x_.ticks(std::clamp(static_cast<int>((right_ - left_) / 75), 2, 8));
  }
  std::vector<Tick> y_ticks() const { return y_.ticks(std::max(2, static_cast<int>(panel_.height / 40))); }
  double x_of(double value) const { return left_ + x_.fraction(value) * (right_ - left_); }
  double y_of(double value) const { return bottom_ - y_.fraction(value) * (bottom_ - top_); }

  /// Beside the title, and in as many rows under it as is given.
  int place_legend() {
    legend_.clear();
    const std::string title = y_.title();
    double x = title.empty() ? 0 : text_width(title, kText) + kEntryGap;
    int row = 0;
    for (const Curve& curve : panel_.curves) {
      if (curve.name.empty()) continue;
      const double width = kSample + 6 + text_width(curve.name, kText);
      if (x > 0 && x + width > right_ - left_) {
        x = 0;
        ++row;
      }
      legend_.push_back({&curve, x, row});
      x += width + kEntryGap;
    }
    return row;
  }

  void paint_grid(std::vector<Mark>& marks) const {
    for (const Tick& tick : x_ticks()) {
      const double x = x_of(tick.value);
      marks.push_back(line_mark({x, top_}, {x, bottom_}, tick.label.empty() ? kFineGrid : kGrid));
      if (shows_x_ && !tick.label.empty())
        marks.push_back(label_mark({x, bottom_ + kTickGap + kText}, tick.label, Anchor::middle));
    }
    for (const Tick& tick : y_ticks()) {
      const double y = y_of(tick.value);
      marks.push_back(line_mark({left_, y}, {right_, y}, tick.label.empty() ? kFineGrid : kGrid));
      if (!tick.label.empty())
        marks.push_back(label_mark({left_ - kTickGap, y + 0.35 * kText}, tick.label, Anchor::end));
    }
    marks.push_back(box_mark({left_, top_}, {right_ - left_, bottom_ - top_}, Ink::none, kFrame));
    marks.back().id = fmt::format("plot-{}", index_);
  }

  std::vector<std::vector<Vector2d>> runs_of(const Curve& curve) const {
    std::vector<std::vector<Vector2d>> runs;
    bool open = false;
    for (const Vector2d& point : curve.points) {
      const bool shown = x_.shows(point.x()) && y_.shows(point.y());
      if (shown && !open) runs.emplace_back();
      if (shown) runs.back().emplace_back(x_of(point.x()), y_of(point.y()));
      open = shown;
    }
    return runs;
  }

  void paint(const Curve& curve, std::size_t number, std::vector<Mark>& marks) const {
    Pen pen = pen_of(curve);
    const auto runs = runs_of(curve);
    if (curve.style == Curve::Style::marks) {
      for (const auto& run : runs) {
        for (const Vector2d& at : run) marks.push_back(disc_mark(at, 2.5, Ink::none, {pen.ink, 1.25}));
      }
      return;
    }
    Outline line, area;
    for (const auto& run : runs) {
      const auto points = thinned(run);
      const Outline part = std::get<Outline>(polyline_mark(points).shape);
      line.segments.insert(line.segments.end(), part.segments.begin(), part.segments.end());
      if (curve.style != Curve::Style::area) continue;
      std::vector<Vector2d> border{{points.front().x(), bottom_}};
      border.insert(border.end(), points.begin(), points.end());
      border.emplace_back(points.back().x(), bottom_);
      const Outline under = std::get<Outline>(polyline_mark(border, {}, true).shape);
      area.segments.insert(area.segments.end(), under.segments.begin(), under.segments.end());
    }
    if (line.segments.empty()) return;
    if (!area.segments.empty()) marks.push_back({std::move(area), {Ink::none, 0}, pen.ink, 0.2});
    if (line.segments.size() > kPointsOfThinLine) pen.width = kThinLine;
    marks.push_back({std::move(line), pen});
    marks.back().id = fmt::format("curve-{}-{}", index_, number);
    marks.back().tooltip = curve.name;
    if (curve.style != Curve::Style::dotted_line) return;
    for (const auto& run : runs) {
      for (const Vector2d& at : run) marks.push_back(disc_mark(at, 3, pen.ink, {Ink::paper, 1}));
    }
  }

  void paint(const LegendEntry& entry, std::vector<Mark>& marks) const {
    const Vector2d at(left_ + entry.left, head_ + kLine * entry.row);
    const Pen pen = pen_of(*entry.curve);
    const Vector2d middle = at - Vector2d(0, 0.35 * kText);
    if (entry.curve->style == Curve::Style::marks) {
      marks.push_back(disc_mark(middle + Vector2d(kSample / 2, 0), 2.5, Ink::none, {pen.ink, 1.25}));
    } else {
      marks.push_back(line_mark(middle, middle + Vector2d(kSample, 0), pen));
    }
    if (entry.curve->style == Curve::Style::dotted_line)
      marks.push_back(disc_mark(middle + Vector2d(kSample / 2, 0), 3, pen.ink, {Ink::paper, 1}));
    marks.push_back(label_mark(at + Vector2d(kSample + 6, 0), entry.curve->name));
  }

  const Panel& panel_;
  std::size_t index_;
  Scale x_, y_;
  bool shows_x_;
  double left_ = 0, right_ = 0, head_ = 0, top_ = 0, bottom_ = 0;
  std::vector<LegendEntry> legend_;
};

}  // namespace

Picture draw_chart(const Chart& chart) {
  const std::vector<PanelScales> scales = scales_of(chart);
  std::vector<PanelPainter> painters;
  double label_width = 0;
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    painters.emplace_back(chart.panels[p], p, scales[p], shows_x_numbers(chart, p));
    label_width = std::max(label_width, painters.back().label_width());
  }
  Picture picture{chart.width, 0, chart.title, {}};
  const double left = kMargin + label_width + kTickGap, right = chart.width - kMargin - 6;
  const std::vector<std::string> title = wrapped(chart.title, kTitle, true, right - kMargin);
  double y = kMargin;
  for (const std::string& line : title) {
    picture.marks.push_back(label_mark({kMargin, y + kTitle}, line, Anchor::start, kTitle));
    std::get<Label>(picture.marks.back().shape).bold = true;
    y += kTitle + 5;
  }
  if (!title.empty()) y += 9;
  double end = 0;
  for (PanelPainter& painter : painters) {
    y = painter.place(left, right, y) + 16;
    painter.paint(picture.marks);
    end = std::max(end, painter.right());
  }
  for (const Mark& mark : picture.marks) end = std::max(end, extent_of(mark).max().x());
  picture.width = end + kMargin + 6;
  picture.height = y - 16 + kMargin;
  return picture;
}

}  // namespace oblique
