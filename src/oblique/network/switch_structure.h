// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <oblique/network/network.h>

namespace oblique {

/// How the switches of a network hang together, read off its expressions.
///
/// Switches on one surface, seen from the same side or from opposite ones, turn over together: they are one
/// unit. Two units are coupled where some signal is no sum of what each of them does by itself.
struct SwitchStructure {
  std::vector<std::uint32_t> unit;  ///< of each switch
  std::vector<bool> opposite;       ///< of each switch: it sees its unit's surface from the other side
  std::vector<std::vector<std::uint32_t>> members;  ///< of each unit: its switches
  /// Of each switch: those whose positions its surface depends on at the same instant, ascending.
  std::vector<std::vector<std::uint32_t>> follows;

  bool is_coupled(std::uint32_t unit_a, std::uint32_t unit_b) const {
    return (coupled[unit_a % coupled.size()] >> (unit_b % coupled.size()) & 1U) != 0;
  }
  /// Whether the surface of switch s depends on the position of switch `other`.
  bool depends(std::size_t s, std::size_t other) const;

  /// Bit b of row a: units a and b modulo 64 are coupled. Units beyond 64 share the bits of others, which
  /// couples more of them than need be.
  std::array<std::uint64_t, 64> coupled{};
};

SwitchStructure find_switch_structure(const Network& network);

}  // namespace oblique
