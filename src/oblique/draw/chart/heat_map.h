// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/scale.h>

namespace oblique::draw {

/// A number that depends on two others, known on a grid of them, as colours: yellow for the least, blue for
/// the greatest, each value in the rectangle that is nearer to it than to others. Those of the border end
/// with the axes.
struct HeatMap {
  Axis x, y;
  Axis value;
  std::vector<double> xs, ys;  ///< ascending, two of each at the least
  /// Of each y all x; what is not finite, or not above 0 on a logarithmic scale, is crossed out.
  std::vector<double> values;
};

/// The maps one under the other, each with its scale of colours. The cell of the i-th x and the j-th y of map
/// m has the id "cell-m-i-j", a frame the id "plot-m".
Picture draw_heat_maps(const std::string& title, const std::vector<HeatMap>& maps, const std::string& note,
                       double width = 720);

}  // namespace oblique::draw
