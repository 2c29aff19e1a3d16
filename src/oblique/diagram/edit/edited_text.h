// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/edit/written_wires.h>
#include <oblique/text/document.h>
#include <oblique/text/toml_edit.h>

namespace oblique::diagram {

/// Throws DiagramError: what cannot be changed in a file.
[[noreturn]] void refuse_edit(const std::string& file, std::string what, std::string expected,
                              text::Remedy remedy = {});

/// The text of a diagram as it is read, wrong or not: what an edit looks for in it. Not installed.
class EditedText {
 public:
  /// `file` and `library` must outlive it. Throws ReadError where the text is no TOML.
  EditedText(const std::string& text, const std::string& file, const BlockLibrary& library)
      : file_(file), library_(library), root_(text::parse_document(text, file).root) {}

  const text::Value* find_table(const char* name) const;
  std::vector<std::string> block_names() const;
  const text::Value* find_block(const std::string& name) const;
  /// Throws DiagramError where there is none; as `wire` does.
  const text::Value& block(const std::string& name) const;
  /// That of its type; nothing where this is not known.
  const BlockDefinition* definition(const text::Value& block) const;

  /// The wires of a block, all or of a port.
  std::vector<WrittenWire> wires(const std::string& name) const;
  std::vector<WrittenWire> wires(const std::string& name, const std::string& port) const;
  WrittenWire wire(const std::string& name, const std::string& port, std::size_t term) const;

  /// Takes a wire away; the others of a list that counts inputs then stand under the names of theirs.
  void cut(const std::string& name, const WrittenWire& wire, std::vector<text::TomlChange>& changes) const;

 private:
  const std::string& file_;
  const BlockLibrary& library_;
  text::Value root_;
};

}  // namespace oblique::diagram
