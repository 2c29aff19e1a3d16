// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/animation.h>

#include <string_view>

#include <fmt/format.h>

#include <oblique/draw/animation/moving_svg.h>
#include <oblique/draw/picture/text_width.h>

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

/// What `text_of` makes of each, with ";" between them.
template <class Values, class TextOf>
std::string listed(const Values& values, TextOf text_of) {
  std::string text;
  for (const auto& value : values) {
    if (!text.empty()) text += ";";
    text += text_of(value);
  }
  return text;
}

std::string pair_text(const Vector2d& p) {
  return svg_number(p.x()) + " " + svg_number(p.y());
}

/// An element that moves what it stands in through all frames.
std::string transform_element(const char* type, double duration, const std::string& values) {
  return fmt::format(
      "<animateTransform attributeName=\"transform\" type=\"{}\" dur=\"{}s\" repeatCount=\"indefinite\" "
      "values=\"{}\"/>\n",
      type, svg_number(duration), values);
}

/// Shifted by one group and turned by another within: SMIL changes one kind of transform at a time.
std::string stiff_group(const MovingGroup& group, double duration) {
  const Placing& first = group.placings.front();
  std::string text = fmt::format("<g transform=\"translate({})\">\n", pair_text(first.at));
  text += transform_element("translate", duration,
                            listed(group.placings, [](const Placing& p) { return pair_text(p.at); }));
  if (!group.turns) return text + elements_of(group) + "</g>\n";
  text += fmt::format("<g transform=\"rotate({})\">\n", angle_text(first.turned));
  text += transform_element("rotate", duration,
                            listed(group.placings, [](const Placing& p) { return angle_text(p.turned); }));
  return text + elements_of(group) + "</g></g>\n";
}

/// A line whose outline changes.
std::string bending_line(const MovingGroup& group, double duration) {
  const auto outline = [&](const std::vector<Vector2d>& corners) {
    std::string d;
    for (const Vector2d& corner : corners) d += (d.empty() ? "M" : " L") + pair_text(corner);
    return d + (group.closed ? " Z" : "");
  };
  std::string element = svg_element(group.marks.front());
  element.erase(element.rfind("/>"));
  return fmt::format(
      "{}>\n<animate attributeName=\"d\" dur=\"{}s\" repeatCount=\"indefinite\" "
      "values=\"{}\"/>\n</path>\n",
      element, svg_number(duration), listed(group.corners, outline));
}

}  // namespace

std::string animated_svg(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation,
                         Theme theme) {
  const LinkageLayout layout = lay_out(mechanism, animation.scene);
  std::string body;
  for (const MovingGroup& group : moving_groups(mechanism, layout, animation)) {
    if (!group.corners.empty())
      body += bending_line(group, animation.duration);
    else if (group.placings.size() > 1)
      body += stiff_group(group, animation.duration);
    else
      body += fmt::format("<g transform=\"{}\">\n{}</g>\n", transform_of(group), elements_of(group));
  }
  return with_body(layout.background, animation, theme, body);
}

AnimationFrames::AnimationFrames(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation)
    : captions_(animation.captions) {
  LinkageScene scene = animation.scene;
  for (const std::string& caption : captions_) {  // room for the longest
    if (text_width(caption, 1) > text_width(scene.caption, 1)) scene.caption = caption;
  }
  const LinkageLayout layout = lay_out(mechanism, scene);
  background_ = layout.background;
  groups_ = moving_groups(mechanism, layout, animation);
}

AnimationFrames::~AnimationFrames() = default;

Picture AnimationFrames::picture(std::size_t frame) const {
  Picture picture = background_;
  for (Mark& mark : picture.marks) {
    if (mark.id == "caption") std::get<Label>(mark.shape).text = captions_[frame];
  }
  for (const MovingGroup& group : groups_) {
    for (Mark& mark : marks_in_frame(group, frame)) picture.marks.push_back(std::move(mark));
  }
  return picture;
}

}  // namespace oblique::draw
