// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <oblique/draw/chart/chart.h>
#include <oblique/draw/picture/scale.h>

// What charts on paper and in the terminal share; not installed.
namespace oblique::draw {

struct PanelScales {
  Scale x, y;
};

/// The scales of each panel; those under each other whose x axes are the same share the range of x.
std::vector<PanelScales> scales_of(const Chart& chart);

/// Whether the numbers of x stand under a panel: the next one under it does not show them.
bool shows_x_numbers(const Chart& chart, std::size_t panel);

/// A text in lines that fit, broken between words.
std::vector<std::string> wrapped(const std::string& text,
                                 const std::function<bool(const std::string& line)>& fits);

/// A line with fewer points that lies on the same one to a hundredth of a pixel where it is smooth: of those
/// in a row that share half a pixel column and two pixels of height the first, the last and the extreme ones
/// are kept. Where that leaves too many, of a dense oscillation, the height does not count; extremes are kept
/// all the same.
std::vector<Eigen::Vector2d> thinned(const std::vector<Eigen::Vector2d>& points);

}  // namespace oblique::draw
