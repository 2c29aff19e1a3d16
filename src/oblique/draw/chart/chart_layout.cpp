// SPDX-License-Identifier: MIT
#include <oblique/draw/chart/chart_layout.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

bool same_axis(const Axis& a, const Axis& b) {
  return a.name == b.name && a.unit == b.unit && a.logarithmic == b.logarithmic;
}

/// All points of a curve that the axes can show.
template <class Use>
void for_points(const Panel& panel, const Curve& curve, const Use& use) {
  for (const auto* points : {&curve.points, &curve.other_edge}) {
    for (const Vector2d& point : *points) {
      if (Scale::can_show(panel.x, point.x()) && Scale::can_show(panel.y, point.y())) use(point);
    }
  }
}

/// Dots at the ends would lie half outside.
constexpr double kRoomForDots = 0.03;

bool has_dots(const Panel& panel) {
  return std::any_of(panel.curves.begin(), panel.curves.end(), [](const Curve& curve) {
    return curve.style == Curve::Style::dotted_line || curve.style == Curve::Style::marks;
  });
}

}  // namespace

bool shows_x_numbers(const Chart& chart, std::size_t panel) {
  const bool last = panel + 1 == chart.panels.size() || (panel + 1) % chart.rows() == 0;
  const bool shared =
      !last && !chart.panels[panel].equal && same_axis(chart.panels[panel].x, chart.panels[panel + 1].x);
  return !shared;
}

std::vector<PanelScales> scales_of(const Chart& chart) {
  std::vector<PanelScales> scales;
  for (std::size_t first = 0; first < chart.panels.size();) {
    std::size_t end = first + 1;
    while (!shows_x_numbers(chart, end - 1)) ++end;
    std::vector<double> xs;
    bool dots = false;
    for (std::size_t p = first; p < end; ++p) {
      dots = dots || has_dots(chart.panels[p]);
      for (const Curve& curve : chart.panels[p].curves) {
        for_points(chart.panels[p], curve, [&](const Vector2d& point) { xs.push_back(point.x()); });
      }
    }
    for (std::size_t p = first; p < end; ++p) {
      const Panel& panel = chart.panels[p];
      std::vector<double> ys;
      for (const Curve& curve : panel.curves) {
        for_points(panel, curve, [&](const Vector2d& point) { ys.push_back(point.y()); });
        if (curve.style == Curve::Style::area) ys.push_back(0);
      }
      PanelScales both{Scale(panel.x, xs, panel.equal), Scale(panel.y, ys, true)};
      if (dots) both.x.pad(kRoomForDots);
      scales.push_back(both);
    }
    first = end;
  }
  return scales;
}

std::vector<std::string> wrapped(const std::string& text,
                                 const std::function<bool(const std::string& line)>& fits) {
  std::vector<std::string> lines;
  constexpr const char* kSpace = " \t\n";
  for (std::size_t first = text.find_first_not_of(kSpace); first != std::string::npos;) {
    const std::size_t end = std::min(text.find_first_of(kSpace, first), text.size());
    const std::string word = text.substr(first, end - first);
    first = text.find_first_not_of(kSpace, end);
    const std::string longer = lines.empty() ? word : lines.back() + " " + word;
    if (lines.empty() || !fits(longer)) {
      lines.push_back(word);
    } else {
      lines.back() = longer;
    }
  }
  return lines;
}

namespace {

/// Points in a row of one half pixel column, and no farther than `reach` [px] above or below the first of
/// them, as the first, the last and the extreme ones.
std::vector<Vector2d> merged(const std::vector<Vector2d>& points, double reach) {
  std::vector<Vector2d> kept;
  for (std::size_t first = 0; first < points.size();) {
    const double column = std::floor(2 * points[first].x());
    std::size_t end = first;
    std::array<std::size_t, 6> keep{};  // first, last, least and greatest x, least and greatest y
    keep.fill(first);
    for (; end < points.size(); ++end) {
      const Vector2d& point = points[end];
      if (std::floor(2 * point.x()) != column || std::abs(point.y() - points[first].y()) > reach) break;
      keep[1] = end;
      if (point.x() < points[keep[2]].x()) keep[2] = end;
      if (point.x() > points[keep[3]].x()) keep[3] = end;
      if (point.y() < points[keep[4]].y()) keep[4] = end;
      if (point.y() > points[keep[5]].y()) keep[5] = end;
    }
    std::sort(keep.begin(), keep.end());
    const auto unique_end = std::unique(keep.begin(), keep.end());
    for (auto k = keep.begin(); k != unique_end; ++k) kept.push_back(points[*k]);
    first = end;
  }
  return kept;
}

}  // namespace

std::vector<Vector2d> thinned(const std::vector<Vector2d>& points) {
  // within this a bow of 100 px radius is off its chord by less than a hundredth of a pixel
  constexpr double kReach = 2;
  constexpr std::size_t kMost = 10'000;
  std::vector<Vector2d> kept = merged(points, kReach);
  if (kept.size() > kMost) kept = merged(points, std::numeric_limits<double>::infinity());
  return kept;
}

}  // namespace oblique::draw
