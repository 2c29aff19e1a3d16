// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram::wiring {

/// What a machine says for the parameters that a diagram leaves open: its systematic errors, and where its
/// amplifiers saturate.
class MachineDefaults {
 public:
  /// Of a shipped profile. Throws DiagramError where there is none of that name.
  explicit MachineDefaults(std::string profile);

  const std::string& profile() const { return profile_; }
  /// The value of each parameter of a block, in their order; nothing where the machine says nothing. A block
  /// of a user that takes the place of a shipped one has those of the parameters that it kept.
  const std::vector<std::optional<double>>& of(const BlockDefinition& block);

 private:
  std::string profile_;
  std::unordered_map<const BlockDefinition*, std::vector<std::optional<double>>> values_;
};

}  // namespace oblique::diagram::wiring
