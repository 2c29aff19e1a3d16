// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/animation/animation.h>

namespace oblique::draw {

/// One HTML file with the picture of `animated_svg`, a button to play and pause, and a slider. Nothing is
/// loaded from elsewhere; it stands still at first for readers who want less motion.
std::string animated_page(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation,
                          Theme theme);

}  // namespace oblique::draw
