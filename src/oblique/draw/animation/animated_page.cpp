// SPDX-License-Identifier: MIT
#include <oblique/draw/animation/animated_page.h>

#include <string_view>

#include <fmt/format.h>

#include <oblique/draw/animation/moving_svg.h>

namespace oblique::draw {
namespace {

std::string page_style(Theme theme, double width) {
  const auto colours = [](bool dark) {
    return fmt::format("body {{ background: {}; color: {}; color-scheme: {} }}\n",
                       colour_of(Ink::paper, dark), colour_of(Ink::line, dark), dark ? "dark" : "light");
  };
  std::string text = colours(theme == Theme::dark);
  if (theme == Theme::automatic)
    text += fmt::format("@media (prefers-color-scheme: dark) {{ {} }}\n", colours(true));
  return text +
         fmt::format(
             "body {{ font-family: Helvetica, Arial, sans-serif; margin: 0 auto; max-width: {}px }}\n",
             svg_number(width)) +
         "svg { display: block; width: 100%; height: auto; max-height: calc(100vh - 60px) }\n"
         "div { display: flex; gap: 12px; align-items: center; padding: 4px 16px 16px }\n"
         "button { width: 5em; padding: 6px 0; font: inherit } input { flex: 1 }\n"
         "output { min-width: 9em; text-align: right; font-variant-numeric: tabular-nums }\n";
}

/// What runs in the page. `motions` is one list a group: x, y and degrees for each frame in turn, or the
/// corners of a line.
constexpr std::string_view kScript = R"js(
const groups = document.querySelectorAll("[data-moves]");
const play = document.getElementById("play"), slider = document.getElementById("place");
const caption = document.getElementById("caption"), last = captions.length - 1;
let playing = !matchMedia("(prefers-reduced-motion: reduce)").matches, place = 0, before = null;
function show() {
  const frame = Math.min(Math.floor(place), last - 1), part = place - frame;
  groups.forEach((group, g) => {
    const values = motions[g], n = values.length / captions.length;
    const at = (k) => values[n * frame + k] * (1 - part) + values[n * frame + n + k] * part;
    if (group.tagName === "g") {
      group.setAttribute("transform", `translate(${at(0)} ${at(1)}) rotate(${at(2)})`);
      return;
    }
    let d = "";
    for (let k = 0; k < n; k += 2) d += `${k ? "L" : "M"}${at(k)} ${at(k + 1)}`;
    group.setAttribute("d", d + (group.dataset.moves === "closed" ? "Z" : ""));
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

/// A group as an element that the script finds where it moves.
std::string element_of(const MovingGroup& group) {
  if (group.corners.empty()) {
    return fmt::format("<g{} transform=\"{}\">\n{}</g>\n", group.moves() ? " data-moves=\"\"" : "",
                       transform_of(group), elements_of(group));
  }
  constexpr std::string_view kBegin = "<path";
  std::string element = svg_element(group.marks.front());
  if (group.moves())
    element.insert(kBegin.size(), fmt::format(" data-moves=\"{}\"", group.closed ? "closed" : ""));
  return element + "\n";
}

/// What a group needs in each frame, one after the other.
std::string numbers_of(const MovingGroup& group) {
  std::string text;
  const auto add = [&](const std::string& number) { text += (text.empty() ? "" : ",") + number; };
  for (const std::vector<Eigen::Vector2d>& corners : group.corners) {
    for (const Eigen::Vector2d& corner : corners) {
      add(svg_number(corner.x()));
      add(svg_number(corner.y()));
    }
  }
  for (const Placing& placing : group.placings) {
    add(svg_number(placing.at.x()));
    add(svg_number(placing.at.y()));
    add(group.turns ? angle_text(placing.turned) : "0");
  }
  return text;
}

}  // namespace

std::string animated_page(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation,
                          Theme theme) {
  const LinkageLayout layout = lay_out(mechanism, animation.scene);
  const double width = animation.width > 0 ? animation.width : layout.background.width;
  std::string body, motions, captions;
  for (const MovingGroup& group : moving_groups(mechanism, layout, animation)) {
    body += element_of(group);
    if (group.moves()) motions += (motions.empty() ? "[" : ",\n[") + numbers_of(group) + "]";
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
      escape_xml(mechanism.title), page_style(theme, width),
      with_body(layout.background, animation, theme, body), animation.frames.size() - 1,
      svg_number(animation.duration), captions, motions, kScript);
}

}  // namespace oblique::draw
