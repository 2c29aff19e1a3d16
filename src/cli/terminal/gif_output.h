// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/animation/animation.h>

namespace oblique::cli {

/// An animation as a GIF, its frames drawn by rsvg-convert: all but the last, which is as the first; `delay`
/// [1/100 s] each. Throws ReadError that names `path`.
std::string gif_of(const mechanism::Mechanism& mechanism, const draw::LinkageAnimation& animation,
                   draw::Theme theme, int delay, const std::string& path);

}  // namespace oblique::cli
