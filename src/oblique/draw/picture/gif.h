// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include <oblique/draw/picture/raster.h>

namespace oblique::draw {

/// An animated GIF (GIF89a) that repeats for ever, `delay` [1/100 s] a frame. All frames have one palette of
/// 255 colours, chosen from all of them and not dithered; each holds the rectangle that changed, in which
/// pixels that did not are transparent. The same frames give the same bytes.
///
/// `frame(k)` gives frame k; it is asked twice for each, so that not all of them need be kept. Throws
/// std::invalid_argument where frames have no pixels or not one size of up to 65535 px, or the delay is not
/// within 1 and 65535.
std::string encode_gif(std::size_t frames, const std::function<Raster(std::size_t)>& frame, int delay);

}  // namespace oblique::draw
