// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace oblique::draw {

/// What a shape is drawn with; the theme (light or dark) says which colour that is. The accents can be told
/// apart by colour-blind people (M. Okabe, K. Ito, "Color universal design", 2008).
enum class Ink {
  none,
  line,   ///< text and outlines
  faint,  ///< grids, hatching, second thoughts
  paper,  ///< the background
  blue,
  vermilion,
  green,
  orange,
  sky,
  purple,
  yellow,
};

/// The accents in the order in which they are given out.
inline constexpr Ink kAccents[] = {Ink::blue, Ink::vermilion, Ink::green, Ink::orange, Ink::sky, Ink::purple};

struct Pen {
  Ink ink = Ink::line;
  double width = 1.5;            ///< [px]
  std::vector<double> dashes{};  ///< lengths drawn and left out in turn [px]; none: a full line
};

/// A part of an outline: from where the last one ended.
struct Segment {
  enum class Kind { move, line, cubic, close };
  Kind kind = Kind::line;
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  Eigen::Vector2d control1 = Eigen::Vector2d::Zero(), control2 = Eigen::Vector2d::Zero();  ///< of a cubic
};

struct Outline {
  std::vector<Segment> segments;
};

struct Disc {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  double radius = 1;  ///< [px]
};

struct Box {
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< upper left
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  double rounding = 0;  ///< radius of the corners [px]
};

enum class Anchor { start, middle, end };

/// A line of text; `at` is on the baseline.
struct Label {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  std::string text;
  Anchor anchor = Anchor::start;
  double size = 12;  ///< of the font [px]
  bool bold = false;
  double turned = 0;  ///< about `at`, clockwise [°]
};

/// A shape with how it is drawn. x goes to the right and y down, in pixels at 100 %.
struct Mark {
  std::variant<Outline, Disc, Box, Label> shape;
  Pen pen{};
  Ink fill = Ink::none;  ///< of a Label: its colour
  double opacity = 1;
  std::string id{};       ///< of the SVG element, for tests and scripts; empty: none
  std::string tooltip{};  ///< what a browser shows where the pointer rests
  std::string element{};  ///< of a symbol: the path of its block, for a page that reads it
  std::string signals{};  ///< that it carries, as a console calls them, with blanks between: for such a page
};

/// A picture as data: what writers write and tests measure.
struct Picture {
  double width = 0, height = 0;  ///< [px]
  std::string title;             ///< for readers who do not see it
  std::vector<Mark> marks;       ///< later ones over earlier ones
};

/// Marks that pictures are made of.
Mark line_mark(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Pen& pen = {});
Mark polyline_mark(const std::vector<Eigen::Vector2d>& points, const Pen& pen = {}, bool closed = false);
Mark disc_mark(const Eigen::Vector2d& centre, double radius, Ink fill, const Pen& pen = {});
Mark box_mark(const Eigen::Vector2d& corner, const Eigen::Vector2d& size, Ink fill, const Pen& pen = {});
Mark label_mark(const Eigen::Vector2d& at, std::string text, Anchor anchor = Anchor::start, double size = 12);

/// The rectangle that a mark covers, its pen included.
Eigen::AlignedBox<double, 2> extent_of(const Mark& mark);

}  // namespace oblique::draw
