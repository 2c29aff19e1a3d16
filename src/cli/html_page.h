// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <oblique/draw/picture.h>

namespace oblique::cli {

/// A page in one file: text, tables and pictures inside it, no scripts; light or dark as the reader's screen,
/// always light on paper. All texts are escaped.
class HtmlPage {
 public:
  explicit HtmlPage(std::string title) : title_(std::move(title)) {}

  void heading(std::string_view text);
  void subheading(std::string_view text);
  void paragraph(std::string_view text);
  void list(const std::vector<std::string>& items);
  /// Columns of numbers are aligned to the right, those of words to the left.
  void table(const std::vector<std::string>& header, const std::vector<std::vector<std::string>>& rows);
  /// Lines as they stand, in a font of even width.
  void preformatted(std::string_view text);
  void picture(const Picture& picture);

  std::string text() const;

 private:
  std::string title_;
  std::string body_;
};

}  // namespace oblique::cli
