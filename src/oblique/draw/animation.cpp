// SPDX-License-Identifier: MIT
#include <oblique/draw/animation.h>

#include <cmath>
#include <numbers>
#include <string_view>

#include <fmt/format.h>

#include <oblique/draw/linkage_layout.h>

namespace oblique {
namespace {

using Eigen::Vector2d;

/// Where a group of marks stands in a frame: [px], and [°] clockwise.
struct Placing {
  Vector2d at = Vector2d::Zero();
  double turned = 0;
};

/// Marks that move together, drawn about their own origin.
struct MovingGroup {
  std::vector<Mark> marks;
  std::vector<Placing> placings;  ///< one for each frame; one alone: it stands still
  bool turns = false;
};

std::string angle_text(double degrees) {
  return fmt::format("{:.3f}", std::abs(degrees) < 5e-4 ? 0.0 : degrees);  // 0.01 px at 500 px
}

std::string pair_text(const Vector2d& p) {
  return svg_number(p.x()) + " " + svg_number(p.y());
}

MovingGroup group_of(const Mechanism& mechanism, const LinkageLayout& layout, const LinkagePart& part,
                     const std::vector<Configuration>& frames) {
  using Carrier = LinkagePart::Carrier;
  MovingGroup group{part.marks, {}, part.carrier != Carrier::frame && part.carrier != Carrier::point};
  const bool still = part.carrier == Carrier::frame || part.carrier == Carrier::guide;
  for (const Configuration& here : frames) {
    const PartPose pose = pose_of(part, mechanism, here);
    group.placings.push_back({layout.place(pose), -pose.angle * 180 / std::numbers::pi});
    if (still) break;
  }
  return group;
}

/// The names, each moving with its pin and placed for the first frame.
void add_names(std::vector<MovingGroup>& groups, const Mechanism& mechanism, const LinkageLayout& layout,
               const std::vector<Configuration>& frames) {
  const std::vector<Mark> names = name_marks(mechanism, layout, frames.front());
  std::size_t next = 0;
  for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
    if (!is_drawn(mechanism, p)) continue;
    const Vector2d start = layout.axes.at(frames.front().points[p].position);
    MovingGroup group{{placed(names[next++], -start, 0)}, {}, false};
    for (const Configuration& here : frames) {
      group.placings.push_back({layout.axes.at(here.points[p].position), 0});
      if (mechanism.points[p].fixed) break;
    }
    groups.push_back(std::move(group));
  }
}

std::vector<MovingGroup> moving_groups(const Mechanism& mechanism, const LinkageLayout& layout,
                                       const std::vector<Configuration>& frames) {
  std::vector<MovingGroup> groups;
  bool paths_drawn = false;
  for (const LinkagePart& part : layout.parts) {
    if (!paths_drawn && lies_over_paths(part)) {
      groups.push_back({layout.paths, {Placing{}}, false});
      paths_drawn = true;
    }
    groups.push_back(group_of(mechanism, layout, part, frames));
  }
  add_names(groups, mechanism, layout, frames);
  return groups;
}

std::string transform_of(const MovingGroup& group) {
  const Placing& first = group.placings.front();
  std::string text = fmt::format("translate({})", pair_text(first.at));
  if (group.turns) text += fmt::format(" rotate({})", angle_text(first.turned));
  return text;
}

std::string elements_of(const MovingGroup& group) {
  std::string text;
  for (const Mark& mark : group.marks) text += svg_element(mark) + "\n";
  return text;
}

/// An element that moves what it stands in through all frames.
template <class TextOf>
std::string motion_element(const char* type, const MovingGroup& group, double duration, TextOf text_of) {
  std::string values;
  for (const Placing& placing : group.placings) {
    if (!values.empty()) values += ";";
    values += text_of(placing);
  }
  return fmt::format(
      "<animateTransform attributeName=\"transform\" type=\"{}\" dur=\"{}s\" repeatCount=\"indefinite\" "
      "values=\"{}\"/>\n",
      type, svg_number(duration), values);
}

/// Shifted by one group and turned by another within: SMIL changes one kind of transform at a time.
std::string animated_group(const MovingGroup& group, double duration) {
  const Placing& first = group.placings.front();
  std::string text = fmt::format("<g transform=\"translate({})\">\n", pair_text(first.at));
  text += motion_element("translate", group, duration, [](const Placing& p) { return pair_text(p.at); });
  if (!group.turns) return text + elements_of(group) + "</g>\n";
  text += fmt::format("<g transform=\"rotate({})\">\n", angle_text(first.turned));
  text += motion_element("rotate", group, duration, [](const Placing& p) { return angle_text(p.turned); });
  return text + elements_of(group) + "</g></g>\n";
}

std::string with_body(std::string svg, const std::string& body) {
  constexpr std::string_view kEnd = "</svg>\n";
  svg.insert(svg.size() - kEnd.size(), body);
  return svg;
}

std::string page_style(Theme theme) {
  const auto colours = [](bool dark) {
    return fmt::format("body {{ background: {}; color: {}; color-scheme: {} }}\n",
                       colour_of(Ink::paper, dark), colour_of(Ink::line, dark), dark ? "dark" : "light");
  };
  std::string text = colours(theme == Theme::dark);
  if (theme == Theme::automatic)
    text += fmt::format("@media (prefers-color-scheme: dark) {{ {} }}\n", colours(true));
  return text +
         "body { font-family: Helvetica, Arial, sans-serif; margin: 0 auto; max-width: 760px }\n"
         "svg { display: block; width: 100%; height: auto }\n"
         "div { display: flex; gap: 12px; align-items: center; padding: 4px 16px 16px }\n"
         "button { width: 5em; padding: 6px 0; font: inherit } input { flex: 1 }\n"
         "output { min-width: 9em; text-align: right; font-variant-numeric: tabular-nums }\n";
}

/// What runs in the page. `motions` is one list a group: x, y and degrees for each frame in turn.
constexpr std::string_view kScript = R"js(
const groups = document.querySelectorAll("[data-moves]");
const play = document.getElementById("play"), slider = document.getElementById("place");
const caption = document.getElementById("caption"), last = captions.length - 1;
let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, place = 0, before = null;
function show() {
  const frame = Math.min(Math.floor(place), last - 1), part = place - frame;
  groups.forEach((group, g) => {
    const values = motions[g], at = (k) => values[3 * frame + k] * (1 - part) + values[3 * frame + 3 + k] * part;
    group.setAttribute("transform", `translate(${at(0)} ${at(1)}) rotate(${at(2)})`);
  });
  slider.value = place;
  caption.textContent = captions[Math.round(place)];
}
function step(now) {
  if (playing && before !== null) {
    place = (place + (now - before) / 1000 / duration * last) % last;
    show();
  }
  before = now;
  requestAnimationFrame(step);
}
function set(on) {
  playing = on;
  play.textContent = on ? "Pause" : "Play";
}
play.addEventListener("click", () => set(!playing));
slider.addEventListener("input", () => {
  set(false);
  place = Number(slider.value);
  show();
});
set(playing);
show();
requestAnimationFrame(step);
)js";

/// A text in a script: no quote, backslash or tag in it can end the string or the script.
std::string script_text(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const bool plain = static_cast<unsigned char>(c) >= 0x20 && c != '"' && c != '\\' && c != '<';
    out += plain ? std::string(1, c) : fmt::format("\\u{:04x}", static_cast<unsigned char>(c));
  }
  return out + "\"";
}

}  // namespace

std::string animated_svg(const Mechanism& mechanism, const LinkageAnimation& animation, Theme theme) {
  const LinkageLayout layout = lay_out(mechanism, animation.scene);
  std::string body;
  for (const MovingGroup& group : moving_groups(mechanism, layout, animation.frames)) {
    body += group.placings.size() > 1
                ? animated_group(group, animation.duration)
                : fmt::format("<g transform=\"{}\">\n{}</g>\n", transform_of(group), elements_of(group));
  }
  return with_body(to_svg(layout.background, theme), body);
}

std::string animated_page(const Mechanism& mechanism, const LinkageAnimation& animation, Theme theme) {
  const LinkageLayout layout = lay_out(mechanism, animation.scene);
  std::string body, motions, captions;
  for (const MovingGroup& group : moving_groups(mechanism, layout, animation.frames)) {
    const bool moves = group.placings.size() > 1;
    body += fmt::format("<g{} transform=\"{}\">\n{}</g>\n", moves ? " data-moves=\"\"" : "",
                        transform_of(group), elements_of(group));
    if (!moves) continue;
    motions += motions.empty() ? "[" : ",\n[";
    for (std::size_t k = 0; k < group.placings.size(); ++k) {
      const Placing& p = group.placings[k];
      motions += fmt::format("{}{},{},{}", k == 0 ? "" : ",", svg_number(p.at.x()), svg_number(p.at.y()),
                             group.turns ? angle_text(p.turned) : "0");
    }
    motions += "]";
  }
  for (const std::string& caption : animation.captions)
    captions += (captions.empty() ? "" : ",") + script_text(caption);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width\">\n<title>{}</title>\n<style>\n{}</style>\n"
      "</head>\n<body>\n{}"
      "<div><button id=\"play\">Play</button><input id=\"place\" type=\"range\" aria-label=\"place in the "
      "motion\" min=\"0\" max=\"{}\" step=\"any\" value=\"0\"><output id=\"caption\"></output></div>\n"
      "<script>\nconst duration = {};\nconst captions = [{}];\nconst motions = [{}];{}</script>\n"
      "</body>\n</html>\n",
      escape_xml(mechanism.title), page_style(theme), with_body(to_svg(layout.background, theme), body),
      animation.frames.size() - 1, svg_number(animation.duration), captions, motions, kScript);
}

}  // namespace oblique
