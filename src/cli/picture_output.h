// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <string>
#include <string_view>

#include <oblique/draw/picture.h>

namespace oblique::cli {

/// What the names of pictures end with.
inline constexpr std::array<std::string_view, 2> kPictureEndings{".svg", ".png"};

/// Checks before the work is done that a picture can be written to `path`, and for .png that the program is
/// there which paints it. Throws ReadError.
void check_picture_output(const std::string& path);

/// Writes a picture and says so on stderr: .svg by ourselves, .png through rsvg-convert at twice the size.
/// Throws ReadError.
void save_picture(const Picture& picture, const std::string& path);

}  // namespace oblique::cli
