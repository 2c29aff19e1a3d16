// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <oblique/draw/picture/picture.h>

namespace oblique::draw {

/// The colours of a picture.
enum class Theme {
  automatic,  ///< light, or dark where the reader's screen is
  light,
  dark,
};

/// The picture as SVG 1.1: the same picture gives the same bytes. Coordinates are rounded to a hundredth of a
/// pixel. It is shown `zoom` times as large as it is at 100 %. `with_data`: elements say what they stand for,
/// as "data-element" and "data-signal".
std::string to_svg(const Picture& picture, Theme theme = Theme::automatic, double zoom = 1,
                   bool with_data = false);

/// The element of one mark alone, for animations and pages that hold several pictures; the style sheet of
/// `svg_style` must be there.
std::string svg_element(const Mark& mark, bool with_data = false);

/// The colour of an ink, "#0072b2", on a light or a dark ground; "none" for none.
const char* colour_of(Ink ink, bool dark);

/// The style sheet that the classes of the elements refer to.
std::string svg_style(Theme theme);

/// A text with what XML reserves written as entities; control characters that XML does not know are left out.
std::string escape_xml(std::string_view text);

/// "12.35": rounded to a hundredth, without needless zeros.
std::string svg_number(double value);

}  // namespace oblique::draw
