// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program_code.h>
#include <oblique/network/program/tape.h>

namespace oblique::network {

/// A program in the making: what the steps of `compile` hand on to each other.
struct Compilation {
  explicit Compilation(Network made);

  using Gradient = std::vector<std::pair<std::uint32_t, NodeId>>;

  /// Which nodes and loops an evaluation needs.
  struct Needs {
    std::vector<bool> nodes;
    std::vector<bool> loops;
  };
  struct FoundSource {
    NodeId value, derivative;
    bool acts, by_states;
    std::optional<std::uint32_t> switch_index;
    std::vector<Mask> masks;
    bool on_branch = false;
  };

  Needs no_needs() const;
  /// Adds all that a node needs.
  void close_over(NodeId root, Needs& needs) const;
  /// One side of the comparison: where the two are equal, the magnitude of both.
  NodeId compared_side(const Switch& s) const;

  bool is_state(std::uint32_t variable) const { return variable >= 1 && variable <= network.states.size(); }
  bool is_unknown(std::uint32_t variable) const { return variable > network.states.size(); }
  std::size_t state_of(std::uint32_t variable) const { return variable - 1; }
  std::size_t unknown_of(std::uint32_t variable) const { return variable - 1 - network.states.size(); }

  Network network;
  ProgramCode code;
  std::vector<Gradient> state_gradients;
  std::vector<Gradient> residual_gradients;
  std::vector<std::uint32_t> loop_of_unknown;
  std::vector<std::uint32_t> place_in_loop;
  std::vector<std::uint32_t> levels;  ///< of a node: 1 + the last loop it depends on, 0 for none
  Needs for_derivatives, for_event_functions, for_signals, for_jacobian, for_rates, for_sources;

  std::vector<NodeId> positions;             ///< of every switch the node of its discrete state
  std::vector<NodeId> event_function_rates;  ///< of every switch
  std::vector<NodeId> phase_rates;
  /// Of each loop whose unknowns' rates the event functions need, for each residual: what its rate would be
  /// if the loop's own unknowns stood still.
  std::map<std::size_t, std::vector<NodeId>> loop_rates;
  std::vector<FoundSource> sources;
  std::optional<std::vector<NodeId>> turning_rates;  ///< as in the code
  std::vector<bool> in_body;                         ///< of a node: written as part of its loop
  std::optional<TapeWriter> writer;                  ///< made once the graph is complete

 private:
  void require_loop(std::size_t loop, Needs& needs, std::vector<NodeId>& pending) const;
};

}  // namespace oblique::network
