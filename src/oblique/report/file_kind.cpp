// SPDX-License-Identifier: MIT
#include <oblique/report/file_kind.h>

#include <oblique/text/document.h>

namespace oblique::report {

FileKind kind_of_file(const std::string& text, const std::string& file) {
  const text::Document document = text::parse_document(text, file);
  const text::Value* const format = document.root.find("format");
  const std::string name = format != nullptr ? format->text : "";
  if (name == "oblique-diagram/1") return FileKind::diagram;
  if (name == "oblique-mechanism/1") return FileKind::mechanism;
  throw text::ReadError(
      text::Diagnostic{{file, {1, 1}},
                       "this is neither a diagram nor a mechanism",
                       R"(format = "oblique-diagram/1" or "oblique-mechanism/1" at the head of the file)",
                       {}});
}

}  // namespace oblique::report
