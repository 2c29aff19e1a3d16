// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/heat_map.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/draw/chart/axes.h>
#include <oblique/draw/chart/panel_stack.h>
#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr double kMapText = 12;                                           // [px]
constexpr double kMapHeight = 300, kScaleBar = 16, kBeforeScaleBar = 24;  // [px]
constexpr int kShades = 64;                                               ///< of the scale of colours

/// A rectangle in the colour of a fraction from 0 to 1: blue over yellow, ever less transparent.
void add_shade(const Vector2d& corner, const Vector2d& size, double fraction, const std::string& id,
               const std::string& tooltip, std::vector<Mark>& marks) {
  marks.push_back(box_mark(corner, size, Ink::yellow, {Ink::none, 0}));
  marks.back().id = id;
  marks.back().tooltip = tooltip;
  marks.push_back(box_mark(corner, size, Ink::blue, {Ink::none, 0}));
  marks.back().opacity = std::clamp(fraction, 0.0, 1.0);
  marks.back().tooltip = tooltip;
}

/// The ends of the rectangles along an axis, as fractions of it: in the middle between two values as the axis
/// shows them.
std::vector<double> edges_of(const std::vector<double>& values, const Scale& scale) {
  std::vector<double> edges{scale.fraction(values.front())};
  for (std::size_t k = 0; k + 1 < values.size(); ++k)
    edges.push_back(0.5 * (scale.fraction(values[k]) + scale.fraction(values[k + 1])));
  edges.push_back(scale.fraction(values.back()));
  return edges;
}

class MapPainter {
 public:
  explicit MapPainter(const HeatMap& map)
      : map_(map),
        x_(map.x, map.xs, false),
        y_(map.y, map.ys, false),
        value_(map.value, map.values, !map.value.logarithmic) {}

  /// Gives where the map ends.
  double paint(std::size_t index, double top, double width, std::vector<Mark>& marks) const {
    marks.push_back(label_mark({kPanelMargin, top + kMapText}, value_.title(), Anchor::start, kMapText));
    std::get<Label>(marks.back().shape).bold = true;
    top += 2 * kMapText + Axes::kHead + 6;
    const Extent anywhere(Vector2d(0, top), Vector2d(100, top + kMapHeight));
    const double numbers = Axes(anywhere, x_, y_, Axes::Shape::stretched).number_width();
    const double of_bar = Axes(anywhere, x_, value_, Axes::Shape::stretched).number_width();
    const double left = std::ceil(kPanelMargin + numbers + Axes::kTickGap), right = width - kPanelMargin;
    const double end = std::floor(right - kScaleBar - Axes::kTickGap - of_bar - kBeforeScaleBar);
    const Axes axes(Extent(Vector2d(left, top), Vector2d(end, top + kMapHeight)), x_, y_,
                    Axes::Shape::stretched);
    std::vector<Mark> frame = axes.marks();
    marks.insert(marks.end(), frame.begin(), frame.end());
    paint_cells(axes.frame(), index, marks);
    marks.push_back(box_mark(axes.frame().min(), axes.frame().sizes(), Ink::none, {Ink::faint, 1}));
    marks.back().id = fmt::format("plot-{}", index);
    paint_bar(Extent(Vector2d(right - kScaleBar, top), Vector2d(right, top + kMapHeight)), marks);
    return top + kMapHeight + Axes::kFoot + 6;
  }

 private:
  void paint_cells(const Extent& frame, std::size_t index, std::vector<Mark>& marks) const {
    const std::vector<double> xs = edges_of(map_.xs, x_), ys = edges_of(map_.ys, y_);
    // at whole pixels: no seams between rectangles
    const auto x_at = [&](double part) { return std::round(frame.min().x() + part * frame.sizes().x()); };
    const auto y_at = [&](double part) { return std::round(frame.max().y() - part * frame.sizes().y()); };
    for (std::size_t j = 0; j < map_.ys.size(); ++j) {
      for (std::size_t i = 0; i < map_.xs.size(); ++i) {
        const double value = map_.values[j * map_.xs.size() + i];
        const Vector2d corner(x_at(xs[i]), y_at(ys[j + 1]));
        const Vector2d size(x_at(xs[i + 1]) - corner.x(), y_at(ys[j]) - corner.y());
        const std::string tooltip = fmt::format("{} = {:.6g}, {} = {:.6g}: {:.6g}", map_.x.name, map_.xs[i],
                                                map_.y.name, map_.ys[j], value);
        if (value_.shows(value)) {
          add_shade(corner, size, value_.fraction(value), fmt::format("cell-{}-{}-{}", index, i, j), tooltip,
                    marks);
          continue;
        }
        const Pen cross{Ink::faint, 1};
        marks.push_back(box_mark(corner, size, Ink::paper, {Ink::none, 0}));
        marks.push_back(line_mark(corner, corner + size, cross));
        marks.push_back(line_mark(corner + Vector2d(size.x(), 0), corner + Vector2d(0, size.y()), cross));
      }
    }
  }

  void paint_bar(const Extent& frame, std::vector<Mark>& marks) const {
    const Axes axes(frame, Scale({""}, {}, false), value_, Axes::Shape::stretched);
    for (Mark& mark : axes.marks_without_x()) {
      const Label* const label = std::get_if<Label>(&mark.shape);
      if (label != nullptr && label->anchor == Anchor::end) marks.push_back(std::move(mark));  // the numbers
    }
    const double height = frame.sizes().y();
    for (int k = 0; k < kShades; ++k) {
      const double top = std::round(frame.max().y() - height * (k + 1) / kShades);
      const double bottom = std::round(frame.max().y() - height * k / kShades);
      add_shade({frame.min().x(), top}, {frame.sizes().x(), bottom - top}, (k + 0.5) / kShades, {}, {},
                marks);
    }
    marks.push_back(box_mark(frame.min(), frame.sizes(), Ink::none, {Ink::faint, 1}));
  }

  const HeatMap& map_;
  Scale x_, y_, value_;
};

}  // namespace

Picture draw_heat_maps(const std::string& title, const std::vector<HeatMap>& maps, const std::string& note,
                       double width) {
  const auto panel = [&](std::size_t index, double top, std::vector<Mark>& marks) {
    return MapPainter(maps[index]).paint(index, top, width, marks);
  };
  return stack_panels(title, maps.size(), panel, note, width);
}

}  // namespace oblique::draw
