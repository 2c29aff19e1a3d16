// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <oblique/diagram/block_definition.h>
#include <oblique/text/document.h>

namespace oblique::diagram {

/// The expressions of one block file, and its `[let]`: names for expressions that they share. Where such a
/// name stands its expression is put in, so that a block with them is the block that it is written out.
class BlockExpressions {
 public:
  /// The references must outlive it.
  BlockExpressions(const BlockDefinition& definition, text::Diagnostics& diagnostics)
      : definition_(definition), diagnostics_(diagnostics) {}

  /// Reads `[let]`. Each may name what stands above it, and of the rest what is `known` to some equation.
  void read_lets(const text::Value& table, const std::vector<std::string>& known);
  bool is_let(const std::string& name) const { return lets_.contains(name) || broken_lets_.contains(name); }

  /// A number or an expression, its names not yet looked at; nothing where it is wrong, which is reported.
  std::optional<text::Expression> read(const text::Value& value, const std::string& what) const;

  /// Reports names that are neither `known` nor of `[let]`, and those of `[let]` that stand for what is not
  /// known here; puts in what the names of `[let]` stand for. False where something was reported.
  bool resolve(text::Expression& expression, const text::Value& value, const std::string& what,
               const std::vector<std::string>& known) const;

 private:
  bool is_free(const std::string& name, text::Place place) const;
  void put_in(text::Expression& expression) const;

  const BlockDefinition& definition_;
  text::Diagnostics& diagnostics_;
  std::map<std::string, text::Expression> lets_;
  std::set<std::string> later_lets_;   ///< while `[let]` is read: what stands farther below
  std::set<std::string> broken_lets_;  ///< reported already: nothing is said of those who name them
};

}  // namespace oblique::diagram
