// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/svg.h>

namespace oblique::report {

/// The element `<svg>` of a picture inside a page; the style sheet of `svg_style` must be there.
std::string inline_svg(const draw::Picture& picture);

/// A page in one file: contents, text, tables and pictures inside it, no scripts. On paper it is always
/// light; headings and introductions stay with what follows them, pictures and short tables are not divided,
/// and pictures that are broad have a sheet across. All texts are escaped but elements that are given whole.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  /// Begins a section, which the contents list.
  void heading(std::string_view text);
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  /// A paragraph that belongs to what follows it.
  void introduction(std::string_view text);
  void list(const std::vector<std::string>& items);
  /// Columns of numbers are aligned to the right, those of words to the left. The first cell of each row
  /// leads to its address in `links`, where there are any.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows,
             const std::vector<std::string>& links = {});
  /// The same, with the header as the first of `rows`.
  void table(const std::vector<std::vector<std::string>>& rows);
  void picture(const draw::Picture& picture);
  /// A paragraph that is a link.
  void link(std::string_view text, std::string_view address);
  /// An element of HTML as it stands.
  void element(std::string_view html);

  std::string text(draw::Theme theme) const;

 private:
  std::string title_;
  std::string body_;
  std::vector<std::string> sections_;
};

}  // namespace oblique::report
