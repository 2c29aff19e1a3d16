// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/chart.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart/axes.h>
#include <oblique/draw/chart/chart_layout.h>
#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kMargin = 20, kText = 12, kTitle = 15, kNote = 11, kLine = 18;  // [px]
constexpr double kBetweenPanels = 16, kBetweenColumns = 22;                      // [px]
constexpr double kSample = 22;                                                   ///< of a line in a legend
constexpr double kEntryGap = 18;                         ///< between the names of a legend
constexpr double kLeastWidth = 300, kLeastHeight = 100;  ///< of a plot with equal scales
constexpr double kFilled = 0.3;                          ///< opacity of areas and bands

/// A line as long as this on one plot would be a blot if it were as thick as others [px].
constexpr double kLengthOfThinLine = 20'000;
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
      : panel_(panel),
        index_(index),
        scales_(scales),
        shows_x_(shows_x),
        axes_(Extent(Vector2d(0, 0), Vector2d(kLeastWidth, panel.height)), scales.x, scales.y,
              Axes::Shape::stretched) {}

  double number_width() const { return axes_.number_width(); }

  /// Gives the parts their places: the plot from `left` to `right`, its head from `top` on. Gives where the
  /// panel ends.
  double place(double left, double right, double top) {
    double height = panel_.height;
    if (panel_.equal) {
      const Scale &x = scales_.x, &y = scales_.y;
      const double ratio = (x.high() - x.low()) / (y.high() - y.low());
      right = std::min(right, left + std::max(kLeastWidth, height * ratio));
      height = std::clamp((right - left) / ratio, kLeastHeight, height);
    }
    head_ = kLine * place_legend(right - left) + Axes::kHead;
    const double frame_top = top + kText + head_, bottom = frame_top + height;
    axes_ = Axes(Extent(Vector2d(left, frame_top), Vector2d(right, bottom)), scales_.x, scales_.y,
                 panel_.equal ? Axes::Shape::equal : Axes::Shape::stretched);
    return bottom + (shows_x_ ? Axes::kFoot + 6 : 0);
  }

  void paint(std::vector<Mark>& marks) const {
    for (Mark& mark : shows_x_ ? axes_.marks(head_) : axes_.marks_without_x(head_)) {
      if (std::holds_alternative<Box>(mark.shape)) mark.id = fmt::format("plot-{}", index_);
      marks.push_back(std::move(mark));
    }
    for (std::size_t c = 0; c < panel_.curves.size(); ++c) paint(panel_.curves[c], c, marks);
    for (const LegendEntry& entry : legend_) paint(entry, marks);
  }

 private:
  /// Beside the title, and in as many rows under it as is given.
  int place_legend(double width) {
    legend_.clear();
    const std::string title = axes_.y_title();
    double x = title.empty() ? 0 : text_width(title, kText) + kEntryGap;
    int row = 0;
    for (const Curve& curve : panel_.curves) {
      if (curve.name.empty()) continue;
      const double entry = kSample + 6 + text_width(curve.name, kText);
      if (x > 0 && x + entry > width) {
        x = 0;
        ++row;
      }
      legend_.push_back({&curve, x, row});
      x += entry + kEntryGap;
    }
    return row;
  }

  /// Where the points lie, each piece of the line by itself.
  std::vector<std::vector<Vector2d>> runs_of(const std::vector<Vector2d>& points) const {
    std::vector<std::vector<Vector2d>> runs;
    bool open = false;
    for (const Vector2d& point : points) {
      const bool shown = axes_.shows(point);
      if (shown && !open) runs.emplace_back();
      if (shown) runs.back().push_back(axes_.at(point));
      open = shown;
    }
    return runs;
  }

  void paint_band(const Curve& curve, const std::string& id, std::vector<Mark>& marks) const {
    std::vector<Vector2d> border, back;
    for (const Vector2d& point : curve.points) {
      if (axes_.shows(point)) border.push_back(axes_.at(point));
    }
    for (const Vector2d& point : curve.other_edge) {
      if (axes_.shows(point)) back.push_back(axes_.at(point));
    }
    border.insert(border.end(), back.rbegin(), back.rend());
    if (border.empty()) return;
    Mark band = polyline_mark(border, {Ink::none, 0}, true);
    band.fill = pen_of(curve).ink;
    band.opacity = kFilled;
    band.id = id;
    band.tooltip = curve.name;
    marks.push_back(std::move(band));
  }

  void paint(const Curve& curve, std::size_t number, std::vector<Mark>& marks) const {
    const std::string id = fmt::format("curve-{}-{}", index_, number);
    if (curve.style == Curve::Style::band) {
      paint_band(curve, id, marks);
      return;
    }
    Pen pen = pen_of(curve);
    const auto runs = runs_of(curve.points);
    if (curve.style == Curve::Style::marks) {
      for (const auto& run : runs) {
        for (const Vector2d& at : run) marks.push_back(disc_mark(at, 2.5, Ink::none, {pen.ink, 1.25}));
      }
      return;
    }
    Outline line, area;
    double length = 0;  // [px]
    for (const auto& run : runs) {
      const auto points = thinned(run);
      for (std::size_t k = 1; k < points.size(); ++k) length += (points[k] - points[k - 1]).norm();
      const Outline part = std::get<Outline>(polyline_mark(points).shape);
      line.segments.insert(line.segments.end(), part.segments.begin(), part.segments.end());
      if (curve.style != Curve::Style::area) continue;
      const double bottom = axes_.frame().max().y();
      std::vector<Vector2d> border{{points.front().x(), bottom}};
      border.insert(border.end(), points.begin(), points.end());
      border.emplace_back(points.back().x(), bottom);
      const Outline under = std::get<Outline>(polyline_mark(border, {}, true).shape);
      area.segments.insert(area.segments.end(), under.segments.begin(), under.segments.end());
    }
    if (line.segments.empty()) return;
    if (!area.segments.empty()) marks.push_back({std::move(area), {Ink::none, 0}, pen.ink, kFilled});
    if (length > kLengthOfThinLine) pen.width = kThinLine;
    marks.push_back({std::move(line), pen});
    marks.back().id = id;
    marks.back().tooltip = curve.name;
    if (curve.style != Curve::Style::dotted_line) return;
    for (const auto& run : runs) {
      for (const Vector2d& at : run) marks.push_back(disc_mark(at, 3, pen.ink, {Ink::paper, 1}));
    }
  }

  void paint(const LegendEntry& entry, std::vector<Mark>& marks) const {
    const Vector2d at =
        axes_.frame().min() + Vector2d(entry.left, kLine * static_cast<double>(entry.row) - head_);
    const Pen pen = pen_of(*entry.curve);
    const Vector2d middle = at - Vector2d(0, 0.35 * kText);
    if (entry.curve->style == Curve::Style::marks) {
      marks.push_back(disc_mark(middle + Vector2d(kSample / 2, 0), 2.5, Ink::none, {pen.ink, 1.25}));
    } else if (entry.curve->style == Curve::Style::band) {
      marks.push_back(box_mark(at - Vector2d(0, 0.8 * kText), {kSample, kText}, pen.ink, {Ink::none, 0}));
      marks.back().opacity = kFilled;
    } else {
      marks.push_back(line_mark(middle, middle + Vector2d(kSample, 0), pen));
    }
    if (entry.curve->style == Curve::Style::dotted_line)
      marks.push_back(disc_mark(middle + Vector2d(kSample / 2, 0), 3, pen.ink, {Ink::paper, 1}));
    marks.push_back(label_mark(at + Vector2d(kSample + 6, 0), entry.curve->name));
  }

  const Panel& panel_;
  std::size_t index_;
  PanelScales scales_;
  bool shows_x_;
  Axes axes_;
  double head_ = 0;  ///< from the frame up to the title of y [px]
  std::vector<LegendEntry> legend_;
};

}  // namespace

Picture draw_chart(const Chart& chart) {
  const std::vector<PanelScales> scales = scales_of(chart);
  const std::size_t rows = chart.rows();
  std::vector<PanelPainter> painters;
  std::vector<double> number_widths(chart.columns, 0);
  for (std::size_t p = 0; p < chart.panels.size(); ++p) {
    painters.emplace_back(chart.panels[p], p, scales[p], shows_x_numbers(chart, p));
    double& width = number_widths[p / rows];
    width = std::max(width, painters.back().number_width());
  }
  Picture picture{chart.width, 0, chart.title, {}};
  const double right = chart.width - kMargin - 6;
  double y = kMargin;
  const auto add_text = [&](const std::string& text, double size, bool bold) {
    const auto fits = [&](const std::string& line) {
      return text_width(line, size, bold) <= right - kMargin;
    };
    for (const std::string& line : wrapped(text, fits)) {
      picture.marks.push_back(label_mark({kMargin, y + size}, line, Anchor::start, size));
      std::get<Label>(picture.marks.back().shape).bold = bold;
      y += size + 5;
    }
  };
  add_text(chart.title, kTitle, true);
  if (!chart.title.empty()) y += 9;
  const auto columns = static_cast<double>(chart.columns);
  const double width = (right - kMargin - (columns - 1) * kBetweenColumns) / columns;
  for (std::size_t row = 0; row < rows; ++row) {
    double below = y;
    for (std::size_t p = row; p < painters.size(); p += rows) {
      const std::size_t column = p / rows;
      const double begin = kMargin + static_cast<double>(column) * (width + kBetweenColumns);
      below = std::max(below,
                       painters[p].place(begin + number_widths[column] + Axes::kTickGap, begin + width, y));
      painters[p].paint(picture.marks);
    }
    y = below + kBetweenPanels;
  }
  if (!chart.note.empty()) y += 2;
  add_text(chart.note, kNote, false);
  if (!chart.note.empty()) y += kBetweenPanels - 5;
  double end = 0;
  for (const Mark& mark : picture.marks) end = std::max(end, extent_of(mark).max().x());
  picture.width = end + kMargin;
  picture.height = y - kBetweenPanels + kMargin;
  return picture;
}

}  // namespace oblique::draw
