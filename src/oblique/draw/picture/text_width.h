// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::draw {

/// Width of a text in the widest of the pictures' fonts [px]; in others it takes up to a sixth less.
double text_width(const std::string& text, double size, bool bold = false);

}  // namespace oblique::draw
