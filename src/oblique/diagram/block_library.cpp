// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_library.h>

#include <algorithm>
#include <system_error>

#include <fmt/format.h>

#include <oblique/diagram/diagram.h>
#include <oblique/diagram/shipped_files.h>
#include <oblique/text/file.h>

namespace oblique::diagram {
namespace {

/// A block type is called as its file: an identifier that may hold '-' too.
bool is_type_name(std::string name) {
  std::replace(name.begin(), name.end(), '-', '_');
  return text::is_identifier(name);
}

text::Diagnostic bad_file_name(const std::filesystem::path& file, const std::string& name) {
  return {{file.string(), {}},
          fmt::format("'{}' cannot be the name of a block type", name),
          "a file name of letters, digits, '_' and '-', with a letter or '_' first",
          {}};
}

}  // namespace

BlockLibrary BlockLibrary::shipped() {
  // Parsed once: the machines are read against it too.
  static const BlockLibrary library = [] {
    BlockLibrary parsed;
    for (const ShippedFile& block : shipped_blocks())
      parsed.add(parse_block(block.text, fmt::format("blocks/{}.toml", block.name), std::string(block.name)));
    return parsed;
  }();
  return library;
}

void BlockLibrary::add_directory(const std::filesystem::path& directory) {
  std::error_code error;
  std::vector<std::filesystem::path> files;
  for (auto at = std::filesystem::directory_iterator(directory, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error)) {
    if (at->path().extension() == ".toml") files.push_back(at->path());
  }
  if (error) {
    const text::Place place{directory.string(), {}};
    throw DiagramError(text::Diagnostic{place,
                                        fmt::format("cannot read the blocks here: {}", error.message()),
                                        "a directory with block files",
                                        {}});
  }
  std::sort(files.begin(), files.end());
  text::Diagnostics diagnostics;
  for (const std::filesystem::path& file : files) {
    const std::string name = file.stem().string();
    if (!is_type_name(name)) {
      diagnostics.add(bad_file_name(file, name));
      continue;
    }
    try {
      add(parse_block(text::read_file(file), file.string(), name));
    } catch (const text::Error& found) {
      for (const text::Diagnostic& diagnostic : found.diagnostics()) diagnostics.add(diagnostic);
    }
  }
  diagnostics.throw_if_any<DiagramError>();
}

void BlockLibrary::add(BlockDefinition definition) {
  std::string name = definition.name;
  const auto [at, is_new] = definitions_.insert_or_assign(std::move(name), std::move(definition));
  if (is_new) order_.push_back(at->first);
}

const BlockDefinition* BlockLibrary::find(std::string_view name) const {
  const auto found = definitions_.find(name);
  return found == definitions_.end() ? nullptr : &found->second;
}

const BlockDefinition* BlockLibrary::find(Role role) const {
  for (const std::string& name : order_) {
    const BlockDefinition& definition = definitions_.find(name)->second;
    if (definition.role == role) return &definition;
  }
  return nullptr;
}

std::vector<std::string> BlockLibrary::names() const {
  std::vector<std::string> names;
  for (const auto& [name, definition] : definitions_) names.push_back(name);
  return names;
}

}  // namespace oblique::diagram
