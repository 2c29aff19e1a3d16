// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include <oblique/draw/picture/picture.h>

namespace oblique::draw {

inline constexpr double kPanelMargin = 20;  ///< around a stack of panels [px]

/// Paints a panel into the marks from a height on downwards, and gives where it ends [px].
using PaintPanel = std::function<double(std::size_t index, double top, std::vector<Mark>& marks)>;

/// A picture of panels one below another, under a title and above a note where these have text. It is as high
/// as they need, and wider than `width` where a mark reaches beyond it [px].
Picture stack_panels(const std::string& title, std::size_t n_panels, const PaintPanel& paint,
                     const std::string& note, double width);

}  // namespace oblique::draw
