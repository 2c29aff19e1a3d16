// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/draw/picture/raster.h>

namespace oblique::cli {

/// The dots of a PNG without transparent ones. Throws ReadError that names `path`, what it was made for.
draw::Raster read_png(const std::string& bytes, const std::string& path);

}  // namespace oblique::cli
