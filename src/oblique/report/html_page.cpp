// SPDX-License-Identifier: MIT
#include <oblique/report/html_page.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/draw/picture/svg.h>

namespace oblique::report {
namespace {

constexpr std::string_view kStyle =
    R"(  body { margin: 2rem auto; max-width: 54rem; padding: 0 1rem; overflow-wrap: break-word;
         font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif }
  h1 { font-size: 1.7rem; line-height: 1.2; margin-bottom: .5rem }
  h2 { font-size: 1.25rem; margin-top: 2.4rem; border-bottom: 1px solid #8886; padding-bottom: .15rem }
  h3 { font-size: 1rem; margin: 1.5rem 0 .3rem }
  h3::first-letter { text-transform: uppercase }
  p { max-width: 46rem; margin: .6rem 0 }
  pre { white-space: pre-wrap; overflow-wrap: anywhere; font-size: .9rem }
  pre span { display: block; padding-left: 2em; text-indent: -2em }
  nav ul { list-style: none; padding: 0; margin: 1rem 0 }
  nav li { display: inline-block; margin-right: 1.4rem }
  a { color: inherit; text-underline-offset: .2em }
  figure { margin: 1rem 0; overflow-x: auto }
  figure svg { max-width: 100%; height: auto }
  figure.broad { margin-inline: calc(50% - 50vw + 1rem); text-align: center }
  .scroll { overflow-x: auto; margin: .6rem 0 }
  table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }
  th, td { padding: .15rem .8rem .15rem 0; text-align: left; vertical-align: top }
  th { border-bottom: 1px solid #8886; font-weight: 600; vertical-align: bottom }
  .n { text-align: right }
  td.n { white-space: nowrap }
)";
constexpr std::string_view kPrint = R"(  @page { margin: 16mm }
  @page across { size: landscape; margin: 12mm }
  @media print {
    body { margin: 0; padding: 0; max-width: none; font-size: 10pt }
    h2, h3, .lead { break-after: avoid }
    p { orphans: 3; widows: 3; max-width: none }
    figure { break-inside: avoid; overflow: visible }
    figure svg { max-height: 235mm }
    figure.broad { page: across; margin: 0 }
    figure.broad div { min-width: 0 !important }
    figure.broad svg { max-height: 180mm }
    .scroll { overflow: visible }
    .short, tr, li { break-inside: avoid }
    table { font-size: 8pt }
    td, th { padding-right: .5rem }
    nav a { text-decoration: none }
)";

/// Wider pictures would be too small on a sheet upright [px].
constexpr double kBroad = 900;
/// Of its size, a broad picture can just be read: in a narrower window it is scrolled.
constexpr double kReadable = 0.5;
/// Rows of a table that is not divided between sheets.
constexpr std::size_t kShort = 32;

std::string ground(bool dark) {
  return fmt::format("body {{ background: {}; color: {} }}\n", draw::colour_of(draw::Ink::paper, dark),
                     draw::colour_of(draw::Ink::line, dark));
}

/// The colours of the page on the screen.
std::string colours(draw::Theme theme) {
  if (theme != draw::Theme::automatic) {
    const bool dark = theme == draw::Theme::dark;
    return fmt::format("  :root {{ color-scheme: {} }}\n  ", dark ? "dark" : "light") + ground(dark);
  }
  return "  :root { color-scheme: light dark }\n  " + ground(false) +
         "  @media (prefers-color-scheme: dark) { " + ground(true) + "  }\n";
}

/// "12.5", "−3e-4", "80°", and cells without anything in them.
bool is_number(std::string_view cell) {
  return cell.find_first_not_of("0123456789+-.e °%−≥±–∞·⁰¹²³⁴⁵⁶⁷⁸⁹⁻") == std::string_view::npos ||
         cell == "inf";
}

/// Words, in which what stands between two backticks is code.
std::string prose(std::string_view text) {
  std::string html;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t begin = text.find('`', at);
    const std::size_t end = begin == std::string_view::npos ? begin : text.find('`', begin + 1);
    html += draw::escape_xml(text.substr(at, end == std::string_view::npos ? end : begin - at));
    if (end == std::string_view::npos) break;
    html += "<code>" + draw::escape_xml(text.substr(begin + 1, end - begin - 1)) + "</code>";
    at = end + 1;
  }
  return html;
}

std::string anchor(std::string_view text, std::string_view address) {
  return fmt::format("<a href=\"{}\">{}</a>", draw::escape_xml(address), draw::escape_xml(text));
}

}  // namespace

std::string inline_svg(const draw::Picture& picture) {
  const std::string width = draw::svg_number(picture.width), height = draw::svg_number(picture.height);
  std::string text = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" "
      "role=\"img\">\n<title>{}</title>\n",
      width, height, width, height, draw::escape_xml(picture.title));
  for (draw::Mark mark : picture.marks) {
    mark.id.clear();  // several pictures of a page would share them
    text += draw::svg_element(mark) + "\n";
  }
  return text + "</svg>";
}

void HtmlPage::heading(std::string_view text) {
  sections_.push_back(draw::escape_xml(text));
  body_ += fmt::format("<h2 id=\"section-{}\">{}</h2>\n", sections_.size(), sections_.back());
}

void HtmlPage::subheading(std::string_view text) {
  body_ += fmt::format("<h3>{}</h3>\n", draw::escape_xml(text));
}

void HtmlPage::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", prose(text));
}

void HtmlPage::introduction(std::string_view text) {
  body_ += fmt::format("<p class=\"lead\">{}</p>\n", prose(text));
}

void HtmlPage::link(std::string_view text, std::string_view address) {
  body_ += fmt::format("<p>{}</p>\n", anchor(text, address));
}

void HtmlPage::element(std::string_view html) {
  body_ += html;
  body_ += "\n";
}

void HtmlPage::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("  <li>{}</li>\n", prose(item));
  body_ += "</ul>\n";
}

void HtmlPage::table(const std::vector<std::string>& header,
                     const std::vector<std::vector<std::string>>& rows,
                     const std::vector<std::string>& links) {
  std::vector<const char*> marks;
  for (std::size_t c = 0; c < header.size(); ++c) {
    const bool numbers =
        std::all_of(rows.begin(), rows.end(), [&](const auto& row) { return is_number(row[c]); });
    marks.push_back(numbers ? " class=\"n\"" : "");
  }
  const auto line = [&](const std::vector<std::string>& cells, const char* tag, const std::string& address) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < cells.size(); ++c)
      body_ +=
          fmt::format("<{0}{1}>{2}</{0}>", tag, marks[c],
                      c == 0 && !address.empty() ? anchor(cells[c], address) : draw::escape_xml(cells[c]));
    body_ += "</tr>\n";
  };
  body_ += fmt::format("<div class=\"scroll{}\"><table>\n<thead>", rows.size() <= kShort ? " short" : "");
  line(header, "th", {});
  body_ += "</thead>\n<tbody>\n";
  for (std::size_t r = 0; r < rows.size(); ++r) line(rows[r], "td", r < links.size() ? links[r] : "");
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlPage::table(const std::vector<std::vector<std::string>>& rows) {
  table(rows.front(), {rows.begin() + 1, rows.end()});
}

void HtmlPage::picture(const draw::Picture& picture) {
  std::string svg = inline_svg(picture);
  const bool is_broad = picture.width > kBroad;
  if (is_broad)
    svg = fmt::format("<div style=\"min-width: {:.0f}px\">{}</div>", kReadable * picture.width, svg);
  body_ += fmt::format("<figure{}>{}</figure>\n", is_broad ? R"( class="broad")" : "", svg);
}

std::string HtmlPage::text(draw::Theme theme) const {
  const std::string title = draw::escape_xml(title_);
  std::string contents;
  for (std::size_t k = 0; k < sections_.size(); ++k)
    contents += fmt::format("<li><a href=\"#section-{}\">{}</a></li>\n", k + 1, sections_[k]);
  const std::string style =
      fmt::format("{}{}{}{}    {}{}  }}\n", kStyle, colours(theme), draw::svg_style(theme), kPrint,
                  ground(false), draw::svg_style(draw::Theme::light));
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>\n{}</style>\n</head>\n<body>\n<h1>{}</h1>\n<nav><ul>\n{}</ul></nav>\n{}</body>\n</html>\n",
      title, style, title, contents, body_);
}

}  // namespace oblique::report
