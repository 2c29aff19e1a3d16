// SPDX-License-Identifier: MIT
#include <oblique/draw/picture/svg.h>

#include <array>
#include <cmath>

#include <fmt/format.h>

namespace oblique::draw {
namespace {

struct Colour {
  const char* name;
  const char* light;
  const char* dark;
};

/// In the order of Ink. The accents are Okabe's and Ito's, on a dark ground as light as they need be.
constexpr std::array<Colour, 11> kColours{{{"none", "none", "none"},
                                           {"line", "#1a1a1a", "#ececec"},
                                           {"faint", "#b4b4b4", "#5c5c5c"},
                                           {"paper", "#ffffff", "#16181c"},
                                           {"blue", "#0072b2", "#4aa8e0"},
                                           {"vermilion", "#d55e00", "#f0803c"},
                                           {"green", "#009e73", "#2cc79b"},
                                           {"orange", "#e69f00", "#f2b632"},
                                           {"sky", "#56b4e9", "#86ccf2"},
                                           {"purple", "#cc79a7", "#e09cc4"},
                                           {"yellow", "#c8b900", "#f0e442"}}};

std::string rules(bool dark, const char* indent) {
  std::string text;
  for (std::size_t k = 1; k < kColours.size(); ++k) {
    const Colour& c = kColours[k];
    const char* const value = dark ? c.dark : c.light;
    text +=
        fmt::format("{}.s-{} {{ stroke: {} }} .f-{} {{ fill: {} }}\n", indent, c.name, value, c.name, value);
  }
  return text;
}

std::string attributes(const Mark& mark, bool is_text) {
  std::string text;
  if (!mark.id.empty()) text += fmt::format(" id=\"{}\"", escape_xml(mark.id));
  const char* const fill = kColours[static_cast<std::size_t>(mark.fill)].name;
  const char* const stroke = kColours[static_cast<std::size_t>(mark.pen.ink)].name;
  text += fmt::format(" class=\"f-{} s-{}\"", fill, stroke);
  if (mark.pen.ink != Ink::none && !is_text) {
    text += fmt::format(" stroke-width=\"{}\"", svg_number(mark.pen.width));
    for (std::size_t k = 0; k < mark.pen.dashes.size(); ++k)
      text += (k == 0 ? " stroke-dasharray=\"" : " ") + svg_number(mark.pen.dashes[k]);
    if (!mark.pen.dashes.empty()) text += "\"";
  }
  // What has a line or a filling alone needs no layer of its own: a converter draws it twice as fast.
  const char* const whose = mark.fill == Ink::none                 ? "stroke-"
                            : mark.pen.ink == Ink::none || is_text ? "fill-"
                                                                   : "";
  if (mark.opacity != 1) text += fmt::format(" {}opacity=\"{}\"", whose, svg_number(mark.opacity));
  return text;
}

std::string pair(const Eigen::Vector2d& p) {
  return svg_number(p.x()) + " " + svg_number(p.y());
}

struct Element {
  const Mark& mark;
  std::string inside;  ///< the tooltip
  bool with_data;

  std::string attributes_of(bool is_text) const {
    std::string text = attributes(mark, is_text);
    if (with_data && !mark.element.empty())
      text += fmt::format(" data-element=\"{}\"", escape_xml(mark.element));
    if (with_data && !mark.signals.empty())
      text += fmt::format(" data-signal=\"{}\"", escape_xml(mark.signals));
    return text;
  }

  std::string close(const std::string& head, const char* name) const {
    return inside.empty() ? head + "/>" : fmt::format("{}>{}</{}>", head, inside, name);
  }

  std::string operator()(const Outline& outline) const {
    std::string d;
    for (const Segment& s : outline.segments) {
      if (!d.empty()) d += " ";
      switch (s.kind) {
        case Segment::Kind::move:
          d += "M" + pair(s.to);
          break;
        case Segment::Kind::line:
          d += "L" + pair(s.to);
          break;
        case Segment::Kind::cubic:
          d += "C" + pair(s.control1) + " " + pair(s.control2) + " " + pair(s.to);
          break;
        case Segment::Kind::close:
          d += "Z";
          break;
      }
    }
    return close(fmt::format("<path{} d=\"{}\"", attributes_of(false), d), "path");
  }

  std::string operator()(const Disc& disc) const {
    return close(
        fmt::format(R"(<circle{} cx="{}" cy="{}" r="{}")", attributes_of(false), svg_number(disc.centre.x()),
                    svg_number(disc.centre.y()), svg_number(disc.radius)),
        "circle");
  }

  std::string operator()(const Box& box) const {
    std::string head = fmt::format(R"(<rect{} x="{}" y="{}" width="{}" height="{}")", attributes_of(false),
                                   svg_number(box.corner.x()), svg_number(box.corner.y()),
                                   svg_number(box.size.x()), svg_number(box.size.y()));
    if (box.rounding > 0) head += fmt::format(" rx=\"{}\"", svg_number(box.rounding));
    return close(head, "rect");
  }

  std::string operator()(const Label& label) const {
    constexpr std::array<const char*, 3> kAnchors{"start", "middle", "end"};
    std::string head =
        fmt::format(R"(<text{} x="{}" y="{}" font-size="{}")", attributes_of(true), svg_number(label.at.x()),
                    svg_number(label.at.y()), svg_number(label.size));
    if (label.anchor != Anchor::start)
      head += fmt::format(" text-anchor=\"{}\"", kAnchors[static_cast<std::size_t>(label.anchor)]);
    if (label.bold) head += " font-weight=\"bold\"";
    if (label.turned != 0)
      head += fmt::format(" transform=\"rotate({} {})\"", svg_number(label.turned), pair(label.at));
    return fmt::format("{}>{}{}</text>", head, inside, escape_xml(label.text));
  }
};

}  // namespace

const char* colour_of(Ink ink, bool dark) {
  const Colour& colour = kColours[static_cast<std::size_t>(ink)];
  return dark ? colour.dark : colour.light;
}

std::string svg_number(double value) {
  std::string text = fmt::format("{:.2f}", std::round(value * 100) / 100 + 0.0);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text == "-0" ? "0" : text;
}

std::string escape_xml(std::string_view text) {
  std::string out;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const char c = text[at];
    const std::string_view here = text.substr(at, 3);
    if (here == "\uFFFE" || here == "\uFFFF") {  // no characters, and none of XML
      out += "\uFFFD";
      at += 2;
      continue;
    }
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 0x20 || c == '\t' || c == '\n' || c == '\r') out += c;
    }
  }
  return out;
}

std::string svg_element(const Mark& mark, bool with_data) {
  const std::string tooltip =
      mark.tooltip.empty() ? "" : fmt::format("<title>{}</title>", escape_xml(mark.tooltip));
  return std::visit(Element{mark, tooltip, with_data}, mark.shape);
}

std::string svg_style(Theme theme) {
  std::string text =
      "  .s-none { stroke: none } .f-none { fill: none }\n" + rules(theme == Theme::dark, "  ");
  text += "  path, rect, circle { stroke-linejoin: round; stroke-linecap: round }\n";
  text +=
      "  text { font-family: Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif; stroke: none "
      "}\n";
  if (theme == Theme::automatic)
    text += "  @media (prefers-color-scheme: dark) {\n" + rules(true, "    ") + "  }\n";
  return text;
}

std::string to_svg(const Picture& picture, Theme theme, double zoom, bool with_data) {
  const std::string width = svg_number(picture.width), height = svg_number(picture.height);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" "
      "role=\"img\">\n"
      "<title>{}</title>\n<style>\n{}</style>\n"
      "<rect class=\"f-paper s-none\" width=\"{}\" height=\"{}\"/>\n",
      svg_number(picture.width * zoom), svg_number(picture.height * zoom), width, height,
      escape_xml(picture.title), svg_style(theme), width, height);
  for (const Mark& mark : picture.marks) text += svg_element(mark, with_data) + "\n";
  return text + "</svg>\n";
}

}  // namespace oblique::draw
