// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram {

/// The kinds of blocks a diagram may use, by name. Copies share the blocks, which stay where they are as long
/// as one of the copies has them.
class BlockLibrary {
 public:
  /// The shipped library, embedded in the program; each of its files is parsed when it is first asked for.
  static BlockLibrary shipped();

  /// Adds every `*.toml` of a directory; a name that is there already is replaced.
  /// Throws DiagramError with the findings of all files.
  void add_directory(const std::filesystem::path& directory);

  /// Adds a block, or replaces the one of that name; flat diagrams that were made with the old one are then
  /// void.
  void add(BlockDefinition definition);
  /// The same under a name of its own.
  void add_as(std::string name, BlockDefinition definition);
  /// The block of that name, or nothing.
  const BlockDefinition* find(std::string_view name) const;
  /// The block that a machine's elements of a role are written as: the one with it that was added first, so
  /// the shipped one as long as it has the role. Nothing where no block has it.
  const BlockDefinition* find(Role role) const;
  /// All names in alphabetical order.
  std::vector<std::string> names() const;

 private:
  class Entry;

  std::map<std::string, std::shared_ptr<const Entry>, std::less<>> entries_;
  std::vector<std::string> order_;  ///< the names, as they were first added
};

}  // namespace oblique::diagram
