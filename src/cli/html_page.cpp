// SPDX-License-Identifier: MIT
#include "html_page.h"

#include <algorithm>

#include <fmt/format.h>

#include <oblique/draw/svg.h>

namespace oblique::cli {
namespace {

constexpr std::string_view kStyle = R"(  :root { color-scheme: light dark }
  body { margin: 2rem auto; max-width: 52rem; padding: 0 1rem; background: #fff; color: #1a1a1a;
         font: 15px/1.5 Helvetica, Arial, 'Liberation Sans', 'DejaVu Sans', sans-serif }
  h1 { font-size: 1.7rem; line-height: 1.2 }
  h2 { font-size: 1.2rem; margin-top: 2.2rem; border-bottom: 1px solid #b4b4b4 }
  h3 { font-size: 1rem; margin-top: 1.6rem }
  figure { margin: 1rem 0; break-inside: avoid }
  figure svg { max-width: 100%; height: auto }
  .scroll { overflow-x: auto }
  table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums }
  th, td { padding: .15rem .8rem .15rem 0; text-align: left; vertical-align: top }
  th { border-bottom: 1px solid #b4b4b4; font-weight: 600 }
  .n { text-align: right }
  td.n { white-space: nowrap }
  tr { break-inside: avoid }
  pre { font: 12px/1.4 'DejaVu Sans Mono', 'Liberation Mono', Menlo, Consolas, monospace; overflow-x: auto }
  @media screen and (prefers-color-scheme: dark) {
    body { background: #16181c; color: #ececec }
    h2, th { border-color: #5c5c5c }
  }
  @media print {
    body { margin: 0; max-width: none; font-size: 10.5pt }
    h2, h3 { break-after: avoid }
    table { font-size: 8pt }
    pre { white-space: pre-wrap; font-size: 7.5pt }
    .scroll { overflow: visible }
  }
)";

/// "12.5", "−3e-4", "80°", and cells without anything in them.
bool is_number(std::string_view cell) {
  return cell.find_first_not_of("0123456789+-.e °−≥±") == std::string_view::npos || cell == "inf";
}

}  // namespace

void HtmlPage::heading(std::string_view text) {
  body_ += fmt::format("<h2>{}</h2>\n", escape_xml(text));
}

void HtmlPage::subheading(std::string_view text) {
  body_ += fmt::format("<h3>{}</h3>\n", escape_xml(text));
}

void HtmlPage::paragraph(std::string_view text) {
  body_ += fmt::format("<p>{}</p>\n", escape_xml(text));
}

void HtmlPage::list(const std::vector<std::string>& items) {
  body_ += "<ul>\n";
  for (const std::string& item : items) body_ += fmt::format("  <li>{}</li>\n", escape_xml(item));
  body_ += "</ul>\n";
}

void HtmlPage::table(const std::vector<std::string>& header,
                     const std::vector<std::vector<std::string>>& rows) {
  std::vector<const char*> marks;
  for (std::size_t c = 0; c < header.size(); ++c) {
    const bool numbers =
        std::all_of(rows.begin(), rows.end(), [&](const auto& row) { return is_number(row[c]); });
    marks.push_back(numbers ? " class=\"n\"" : "");
  }
  const auto line = [&](const std::vector<std::string>& cells, const char* tag) {
    body_ += "<tr>";
    for (std::size_t c = 0; c < cells.size(); ++c)
      body_ += fmt::format("<{0}{1}>{2}</{0}>", tag, marks[c], escape_xml(cells[c]));
    body_ += "</tr>\n";
  };
  body_ += "<div class=\"scroll\"><table>\n<thead>";
  line(header, "th");
  body_ += "</thead>\n<tbody>\n";
  for (const auto& row : rows) line(row, "td");
  body_ += "</tbody>\n</table></div>\n";
}

void HtmlPage::preformatted(std::string_view text) {
  body_ += fmt::format("<pre>{}</pre>\n", escape_xml(text));
}

void HtmlPage::picture(const Picture& picture) {
  const std::string width = svg_number(picture.width), height = svg_number(picture.height);
  body_ += fmt::format(
      "<figure><svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\" "
      "role=\"img\">\n<title>{}</title>\n",
      width, height, width, height, escape_xml(picture.title));
  for (Mark mark : picture.marks) {
    mark.id.clear();  // several pictures of a page would share them
    body_ += svg_element(mark) + "\n";
  }
  body_ += "</svg></figure>\n";
}

std::string HtmlPage::text() const {
  const std::string title = escape_xml(title_);
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n"
      "<style>\n{}{}  @media print {{\n{}  }}\n</style>\n</head>\n<body>\n<h1>{}</h1>\n{}</body>\n</html>\n",
      title, kStyle, svg_style(Theme::automatic), svg_style(Theme::light), title, body_);
}

}  // namespace oblique::cli
