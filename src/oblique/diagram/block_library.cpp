// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_library.h>

#include <algorithm>
#include <mutex>
#include <optional>
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

/// A block, or the shipped file that it is parsed from: a run asks for a few of them, and all together take
/// longer than many a run.
class BlockLibrary::Entry {
 public:
  explicit Entry(BlockDefinition definition) : parsed_(std::move(definition)) {}
  explicit Entry(const ShippedFile& file) : file_(file) {}

  /// Several threads may ask at once.
  const BlockDefinition& definition() const {
    const std::lock_guard lock(guard_);
    if (!parsed_)
      parsed_ = parse_block(file_.text, fmt::format("blocks/{}.toml", file_.name), std::string(file_.name));
    return *parsed_;
  }

  bool has(Role role) const {
    const bool is_named = file_.text.empty() || file_.text.find(role_name(role)) != std::string_view::npos;
    return is_named && definition().role == role;
  }

 private:
  ShippedFile file_{};
  mutable std::mutex guard_;
  mutable std::optional<BlockDefinition> parsed_;
};

BlockLibrary BlockLibrary::shipped() {
  // Made once: the machines are read against it too.
  static const BlockLibrary library = [] {
    BlockLibrary made;
    for (const ShippedFile& block : shipped_blocks()) {
      made.order_.emplace_back(block.name);
      made.entries_.emplace(block.name, std::make_shared<const Entry>(block));
    }
    return made;
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
  add_as(std::move(name), std::move(definition));
}

void BlockLibrary::add_as(std::string name, BlockDefinition definition) {
  const auto [at, is_new] =
      entries_.insert_or_assign(std::move(name), std::make_shared<const Entry>(std::move(definition)));
  if (is_new) order_.push_back(at->first);
}

const BlockDefinition* BlockLibrary::find(std::string_view name) const {
  const auto found = entries_.find(name);
  return found == entries_.end() ? nullptr : &found->second->definition();
}

const BlockDefinition* BlockLibrary::find(Role role) const {
  for (const std::string& name : order_) {
    const Entry& entry = *entries_.find(name)->second;
    if (entry.has(role)) return &entry.definition();
  }
  return nullptr;
}

std::vector<std::string> BlockLibrary::names() const {
  std::vector<std::string> names;
  for (const auto& [name, entry] : entries_) names.push_back(name);
  return names;
}

}  // namespace oblique::diagram
