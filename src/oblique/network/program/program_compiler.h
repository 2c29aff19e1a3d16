// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/program/program.h>
#include <oblique/network/program/tangents.h>

namespace oblique::network {

/// Fills a Program from a Network; used by Program's constructor only.
class ProgramCompiler {
 public:
  ProgramCompiler(Program& program, Network network);
  void compile();

 private:
  using Gradient = std::vector<std::pair<std::uint32_t, NodeId>>;

  /// Which nodes and loops an evaluation needs.
  struct Needs {
    std::vector<bool> nodes;
    std::vector<bool> loops;
  };

  void differentiate();
  void differentiate_surfaces();
  NodeId total_derivative(const Gradient& gradient, std::size_t without_loop);
  void find_phases(Tangents& rates);
  NodeId rate_of(std::uint32_t variable);
  void find_sources();
  void find_peaks(const std::vector<bool>& acts, const std::vector<bool>& clocks,
                  const std::function<bool(NodeId)>& follows_states);
  void find_levels();
  void find_needs();
  void close_over(NodeId root, Needs& needs) const;
  void require_loop(std::size_t loop, Needs& needs, std::vector<NodeId>& pending) const;
  std::vector<std::uint32_t> count_uses() const;

  NodeId compared_side(const Switch& s) const;
  std::vector<NodeId> surface_roots() const;
  std::vector<NodeId> signal_roots() const;

  void write_tapes();
  void write_events();
  void write_rates();
  void write_sources();
  void find_positions();
  std::vector<NodeId> grounds_of(std::size_t s) const;
  std::vector<OrderStep> order_of_positions(const std::vector<bool>& ordered) const;
  void write_switch_order();
  void write_pieces();
  std::vector<NodeId> rate_roots() const;
  std::vector<NodeId> source_roots() const;
  std::vector<Program::Step> write_steps(const Needs& wanted, const Needs& done);
  std::vector<NodeId> write_loop_body(std::size_t loop, std::vector<NodeId> nodes);

  void find_sensitivities();
  void find_sensitivity(std::size_t loop);
  void lay_out_jacobian();

  bool is_state(std::uint32_t variable) const { return variable >= 1 && variable <= network_.states.size(); }
  bool is_unknown(std::uint32_t variable) const { return variable > network_.states.size(); }
  std::size_t state_of(std::uint32_t variable) const { return variable - 1; }
  std::size_t unknown_of(std::uint32_t variable) const { return variable - 1 - network_.states.size(); }

  Program& program_;
  Network network_;
  std::vector<Gradient> state_gradients_;
  std::vector<Gradient> residual_gradients_;
  std::vector<std::uint32_t> loop_of_unknown_;
  std::vector<std::uint32_t> place_in_loop_;
  std::vector<std::uint32_t> levels_;  ///< of a node: 1 + the last loop it depends on, 0 for none
  Needs for_derivatives_, for_surfaces_, for_signals_, for_jacobian_, for_rates_, for_sources_;

  static constexpr std::uint32_t kNoSwitch = SwitchStructure::kNone;
  std::vector<NodeId> positions_;      ///< of every switch the node of its memory
  std::vector<NodeId> surface_rates_;  ///< of every switch
  std::vector<NodeId> phase_rates_;
  /// Of each loop whose unknowns' rates the surfaces need, for each residual: what its rate would be if the
  /// loop's own unknowns stood still.
  std::map<std::size_t, std::vector<NodeId>> loop_rates_;
  struct FoundSource {
    NodeId value, slope;
    bool acts, by_states;
    std::optional<std::uint32_t> switch_index;
  };
  std::vector<FoundSource> sources_;
  std::vector<bool> in_body_;         ///< of a node: written as part of its loop
  std::optional<TapeWriter> writer_;  ///< made once the graph is complete
};

}  // namespace oblique::network
