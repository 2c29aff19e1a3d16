// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Which units of switches have nothing to do with each other: neither ever acts on the event function of the
/// other, at once or by a state or an event. What one of them does is decided without the others. Not
/// installed.
class IndependentUnits {
 public:
  /// It must outlive this.
  explicit IndependentUnits(const network::Program& program)
      : program_(program), ancestries_(program.switch_structure().members.size()) {}

  /// Whether neither of two units acts on the other.
  bool are(std::uint32_t unit_a, std::uint32_t unit_b);
  /// Whether a unit ever acts on the event function of another, or on its own.
  bool acts(std::uint32_t unit, std::uint32_t on);
  /// Whether an event does.
  bool acts(const network::Event& event, std::uint32_t on);
  /// The places in `units` of those that hang together, directly or by others of them: each place once,
  /// ascending. More than `kMostUnits` are taken to hang together.
  std::vector<std::vector<std::size_t>> parts_of(std::span<const std::uint32_t> units);
  static constexpr std::size_t kMostUnits = 64;
  /// Those of some units that act on each other, together: each group behind those that act on it.
  std::vector<std::vector<std::uint32_t>> mutual_of(std::span<const std::uint32_t> units);

 private:
  const network::SwitchStructure::Ancestry& ancestry(std::uint32_t unit);

  const network::Program& program_;
  std::vector<std::optional<network::SwitchStructure::Ancestry>>
      ancestries_;  ///< of each unit, once asked for
};

}  // namespace oblique::solve
