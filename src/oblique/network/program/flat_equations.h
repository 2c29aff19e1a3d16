// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/network/program/loop_matrix.h>
#include <oblique/network/program/program.h>
#include <oblique/network/program/tape.h>

namespace oblique::network {

/// The equations of a Program in one piece, algebraic loops and all:
///
///     M u′ = F(t, u),      outputs = h(t, u),
///
/// with u the states and then the unknowns of loops, and M the unit matrix with zeros for the latter: a
/// differential-algebraic system of index 1, which a method for such systems integrates without solving
/// loops. On slots that begin with t and u, and hold the constants of the program; discrete states are what
/// they are before the run.
struct FlatEquations {
  std::size_t n_states = 0;
  std::size_t n_variables = 0;            ///< of u
  std::vector<std::uint32_t> unknowns;    ///< of the program, those that are in u behind the states
  std::vector<Instruction> rates;         ///< computes F
  std::vector<Instruction> derivatives;   ///< after `rates`: its derivatives
  std::vector<Instruction> outputs;       ///< computes h, and no less than it needs
  std::vector<std::uint32_t> rate_slots;  ///< of F
  std::vector<MatrixEntry> jacobian;      ///< ∂F/∂u; several at one place are added
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_time;  ///< ∂F/∂t: row, slot
  std::vector<std::uint32_t> output_slots;
  std::vector<double> initial_slots;
  /// Of each state the slot of the constant at which it starts.
  std::vector<std::optional<std::uint32_t>> start_slots;
};

/// Those of a program, with these of its signals as outputs. Throws NetworkError where an output needs an
/// algebraic loop that no state depends on: it is no part of the system.
FlatEquations flat_equations(const Program& program, std::span<const std::size_t> signals);

}  // namespace oblique::network
