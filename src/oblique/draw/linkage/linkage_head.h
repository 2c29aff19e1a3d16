// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/draw/linkage/linkage.h>

namespace oblique::draw {

/// The pen of the path of `scene.traces[k]`.
Pen trace_pen(const LinkageScene& scene, std::size_t k);
/// That of the same point's path in the analog mechanism.
Pen analog_trace_pen(std::size_t k);

/// Writes the title, and under it the caption and the legend from left to right in as many lines as they
/// need. Gives where they end [px].
double add_linkage_head(Picture& picture, const mechanism::Mechanism& mechanism, const LinkageScene& scene);

}  // namespace oblique::draw
