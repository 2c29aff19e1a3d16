// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/animation/moving_parts.h>

// What animated SVG and pages share.
namespace oblique::draw {

/// Degrees to a thousandth, which is 0.01 px at 500 px.
std::string angle_text(double degrees);

/// The elements of a group's marks, as they are in the first frame.
std::string elements_of(const MovingGroup& group);

/// "translate(…) rotate(…)" of a stiff group in the first frame.
std::string transform_of(const MovingGroup& group);

/// The background of an animation with `body` over it, as large as it is to be shown.
std::string with_body(const Picture& background, const LinkageAnimation& animation, Theme theme,
                      const std::string& body);

}  // namespace oblique::draw
