// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/draw/schematic/schematic.h>
#include <oblique/draw/schematic/symbol_table.h>

/// The shapes of blocks. Not installed.
namespace oblique::draw::schematic {

/// Sizes of the fonts [px].
inline constexpr double kSmall = 9.5, kText = 12, kCaption = 10.5;

inline constexpr double kBar = 12;    ///< width of an integrator's bar [px]
inline constexpr double kBubble = 3;  ///< radius of the circle that marks inversion [px]

/// What a block looks like, apart from where it stands.
struct Shape {
  Form form = Form::box;
  std::string text;                  ///< inside
  std::string icon;                  ///< name of a small curve inside, for `icon_outline`
  std::vector<std::string> caption;  ///< lines below
  std::string sign;                  ///< in place of a curve, in a box that has its type's name as `text`
  double text_centre = 0;            ///< of `text`, from the left edge of the body
  std::string initial;               ///< the value that an integrator starts from, above its bar
  bool inverts = false;              ///< a small circle at the output
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< upper left of the body, from that of the node
  Eigen::Vector2d body = Eigen::Vector2d::Zero();    ///< size
  LayoutNode node;                                   ///< with all that is written beside the body
};

/// The font of the text inside a symbol [px].
double text_size(const Shape& shape);

/// Half the side of the square for the icon [px].
inline constexpr double kIcon = 12;

/// From an output's edge (or the circle there) to the text of what is measured [px].
inline constexpr double kRecordIndent = 14;

/// What stands above the end of a wire: its weight, and the name of the port where one must know it.
std::string lead_text(const Block& block, const Input& input);

/// The shape of a block that is not open; all lengths fit the layout's grid.
Shape shape_of(const Block& block, SymbolStyle style);

/// The shape of the frame around an open composite, whose inside has this size; the ports are where the
/// terminals inside stand.
Shape frame_shape(const Block& block, const Eigen::Vector2d& inside, const std::vector<double>& inputs,
                  const std::vector<double>& outputs);

/// Room between a frame and what is in it [px].
inline constexpr double kFrameMargin = 2 * kLayoutGrid;
inline constexpr double kFrameTop = 4 * kLayoutGrid;

}  // namespace oblique::draw::schematic
