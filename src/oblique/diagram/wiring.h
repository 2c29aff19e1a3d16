// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/scope.h>

namespace oblique::diagram::wiring {

/// Resolves the names of a diagram and of every composite it uses, each file once.
class Resolver {
 public:
  /// Both must outlive the resolver and the scopes it gives.
  Resolver(const BlockLibrary& library, text::Diagnostics& diagnostics)
      : library_(&library), diagnostics_(&diagnostics) {}

  Scope diagram(const Diagram& diagram);

 private:
  const Scope* composite(const BlockDefinition& definition, const text::Place& user);
  void add_blocks(const std::vector<BlockInstance>& blocks, Scope& scope);
  void find_definition(const Scope& scope, WiredBlock& block);
  void read_settings(const Scope& scope, WiredBlock& block);
  void read_input_list(const Scope& scope, WiredBlock& block, const text::Entry& entry,
                       std::vector<const text::Entry*>& drivers);
  void connect(const Scope& scope, WiredBlock& block, std::size_t input, const text::Entry& entry,
               std::vector<const text::Value*> wires, std::vector<const text::Entry*>& drivers);
  void check_open_inputs(const Scope& scope, const WiredBlock& block);
  void read_outputs(Scope& scope);

  const BlockLibrary* library_;
  text::Diagnostics* diagnostics_;
  std::string machine_;
  std::unordered_map<const BlockDefinition*, std::unique_ptr<Scope>> composites_;
  std::vector<const BlockDefinition*> open_;  ///< the composites being resolved, outermost first
};

}  // namespace oblique::diagram::wiring
