// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/masks.h>

namespace oblique::network {

/// How the switches of a network hang together, read off its expressions.
///
/// Switches on one switching surface, seen from the same side or from opposite ones, turn over together: they
/// are one unit. Two units are coupled where some signal is no sum of what each of them does by itself.
///
/// On which positions an event function depends at the same instant is asked of the expressions: of a chain
/// of switches the answers together would be as long as the square of its length.
struct SwitchStructure {
  std::vector<std::uint32_t> unit;  ///< of each switch
  std::vector<bool> opposite;       ///< of each switch: it sees its unit's event function from the other side
  std::vector<std::vector<std::uint32_t>> members;  ///< of each unit: its switches

  bool is_coupled(std::uint32_t unit_a, std::uint32_t unit_b) const {
    return (coupled[unit_a % coupled.size()] >> (unit_b % coupled.size()) & 1U) != 0;
  }
  /// The switches on whose positions the event function of switch s depends, ascending.
  std::vector<std::uint32_t> positions_below(std::size_t s) const { return positions_in(event_functions[s]); }
  /// The switches on whose positions a node depends, ascending.
  std::vector<std::uint32_t> positions_in(NodeId node) const;
  /// Whether the event function of switch s depends on the position of switch `other`.
  bool depends(std::size_t s, std::size_t other) const;
  /// Of each switch: whether its event function depends on an unknown of this algebraic loop, itself or by
  /// the position of another that does.
  std::vector<bool> followers_of_loop(std::size_t loop) const;
  /// Of each discrete state: whether the equations of this algebraic loop depend on it.
  std::vector<bool> discrete_states_below_loop(std::size_t loop) const;
  /// Of each switch: whether its event function depends on the position of one of `these` (one flag for each
  /// switch), or on that of another that does.
  std::vector<bool> followers_of(const std::vector<bool>& these) const;

  /// The states and the discrete states on which an event function ever depends, now or later: flags of each.
  struct Ancestry {
    std::vector<bool> states, discrete_states;
  };
  /// Those of the event function of a unit. `events` are the program's.
  Ancestry ancestry(std::uint32_t of_unit, const std::vector<Event>& events) const;

  /// Bit b of row a: units a and b modulo 64 are coupled. Units beyond 64 share the bits of others, which
  /// couples more of them than need be.
  std::array<std::uint64_t, 64> coupled{};

  static constexpr std::uint32_t kNone = 0xFFFFFFFFU;
  /// What each node of the expressions is made of at the same instant, the residuals of the algebraic loop
  /// of an unknown included: those of node i are `operands[first_operand[i]] … operands[first_operand[i + 1]
  /// − 1]`.
  std::vector<std::uint32_t> first_operand, operands;
  std::vector<std::uint32_t> switch_at;                   ///< of each node: the switch whose position it is
  std::vector<std::uint32_t> discrete_state_at, loop_at;  ///< of each node: what it is, the unknown of a loop
  std::vector<std::uint32_t> state_at;                    ///< of each node: the state that it is
  std::vector<NodeId> derivatives;                        ///< of each state
  std::size_t n_discrete_states = 0;
  std::vector<NodeId> event_functions;   ///< of each switch
  std::vector<std::vector<Mask>> masks;  ///< of each switch what masks its position
  std::vector<bool> read_by_events;      ///< of each switch: or by the ends of phases
};

SwitchStructure find_switch_structure(const Network& network);

}  // namespace oblique::network
