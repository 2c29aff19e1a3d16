// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/scale.h>

namespace oblique::draw {

/// Points and how they are drawn.
struct Curve {
  enum class Style {
    line,
    dotted_line,  ///< a line with a dot at each point: few points, each of them measured
    guide,        ///< thin and dashed: what is compared with
    area,         ///< filled down to the axis
    band,         ///< filled between the points and those of the other edge
    marks,        ///< small rings, no line
  };
  static constexpr std::size_t kPlain = static_cast<std::size_t>(-1);
  std::string name;                     ///< in the legend; empty: not told there
  std::vector<Eigen::Vector2d> points;  ///< a coordinate that is not finite interrupts the line
  /// Which colour and dashes: kMostCurves of them, then again from the first; kPlain: the colour of texts.
  std::size_t number = 0;
  Style style = Style::line;
  std::vector<Eigen::Vector2d> other_edge{};  ///< of a band; as many as there are points
};

/// As many curves as can be told apart: each accent full, dashed and dotted.
inline constexpr std::size_t kMostCurves = 3 * std::size(kAccents);

/// One pair of axes with its curves.
struct Panel {
  Axis x, y;
  std::vector<Curve> curves;
  double height = 220;  ///< of the plot [px]
  bool equal = false;   ///< one unit of x is as long as one of y; linear axes
};

/// Panels one under the other, in columns side by side: the first ones fill the first column. Panels whose x
/// axes are the same show its numbers once, under the last of them.
struct Chart {
  std::string title;
  std::vector<Panel> panels;
  double width = 720;  ///< of the picture [px]
  std::size_t columns = 1;
  std::string note{};  ///< stands under the panels

  /// How many panels stand under each other.
  std::size_t rows() const { return (panels.size() + columns - 1) / columns; }
};

/// The chart as a picture: ticks at round numbers, legends above the plots, where they cover no curve. Points
/// that would fall into the same half pixel column are thinned; extremes are kept. Curve c of panel p has the
/// id "curve-p-c", the frame of its plot the id "plot-p".
Picture draw_chart(const Chart& chart);

}  // namespace oblique::draw
