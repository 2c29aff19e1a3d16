// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/moving_svg.h>

#include <cmath>
#include <string_view>

#include <fmt/format.h>

namespace oblique::draw {

std::string angle_text(double degrees) {
  return fmt::format("{:.3f}", std::abs(degrees) < 5e-4 ? 0.0 : degrees);
}

std::string elements_of(const MovingGroup& group) {
  std::string text;
  for (const Mark& mark : group.marks) text += svg_element(mark) + "\n";
  return text;
}

std::string transform_of(const MovingGroup& group) {
  const Placing& first = group.placings.front();
  std::string text = fmt::format("translate({} {})", svg_number(first.at.x()), svg_number(first.at.y()));
  if (group.turns) text += fmt::format(" rotate({})", angle_text(first.turned));
  return text;
}

std::string with_body(const Picture& background, const LinkageAnimation& animation, Theme theme,
                      const std::string& body) {
  std::string svg = to_svg(background, theme, animation.width > 0 ? animation.width / background.width : 1);
  constexpr std::string_view kEnd = "</svg>\n";
  svg.insert(svg.size() - kEnd.size(), body);
  return svg;
}

}  // namespace oblique::draw
