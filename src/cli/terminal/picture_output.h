// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/svg.h>

namespace oblique::cli {

/// As `check_output`, of a picture, which ends in .svg or .png and for which rsvg-convert may be needed.
void check_picture_output(const std::string& path);

/// Writes a picture, whose path was checked, and says so on stderr: .svg itself, .png through rsvg-convert.
/// Throws ReadError, also where rsvg-convert fails; nothing is then written.
void save_picture(const draw::Picture& picture, const std::string& path, draw::Theme theme);

/// Throws ReadError where the program is missing that makes `path`, a .png or a .gif.
void require_converter(const std::string& path);

/// The theme that --theme names: auto, light or dark. Throws ReadError.
draw::Theme theme_option(const std::string& text);

/// An SVG text as PNG, by rsvg-convert, which is there. Throws ReadError that names `path`, what it is for.
std::string png_of(std::string_view svg, const std::string& path);

}  // namespace oblique::cli
