// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/graph/expression_graph.h>
#include <oblique/text/point_table.h>

namespace oblique::network {

/// Thrown by the `network` stage: equations that cannot be put into the form of a Program.
class NetworkError : public text::Error {
 public:
  using text::Error::Error;
};

/// The output of an integrator or another dynamic element: d state/dt = derivative.
struct State {
  std::string name;      ///< path of its signal
  double start = 0;      ///< [machine unit]
  bool at_rest = false;  ///< brought to rest before the clock starts; `start` is the guess
  NodeId derivative = 0;
  double tolerance = 0;              ///< absolute [machine unit]; 0: that of the run
  std::optional<NodeId> start_node;  ///< where the start follows from signals; `start` is then no use
  std::optional<NodeId> start_constant = std::nullopt;  ///< else: it has the value `start`
};

/// A value that only events change.
struct DiscreteState {
  std::string name;  ///< of a block's discrete state its path; of a switch the comparison
  double start = 0;
};

/// What meets where a switch turns over, the least first: the bounds of a clip and what lies between them,
/// which is in force at position 0; pieces that meet (of abs, min, max, deadzone, a table); pieces that need
/// not.
enum class Turning { limits, bends, jumps };

/// A switch: its discrete state is 1 where the event function is above 0, else 0.
struct Switch {
  std::uint32_t discrete_state = 0;
  std::string block;          ///< path
  std::string comparison;     ///< "in > high", as the block's file has it
  NodeId event_function = 0;  ///< [machine unit] or whatever is compared
  /// d(event function)/dt of an event function that depends on time alone, and linearly: its crossing is
  /// known beforehand.
  std::optional<NodeId> rate = std::nullopt;
  double check_interval = std::numeric_limits<double>::infinity();  ///< [s] how often at least to look
  Turning turning = Turning::jumps;
  /// The event that moves a table to its next segment as long as this switch holds.
  std::optional<std::size_t> moves_along = std::nullopt;
};

/// What happens when a condition becomes true: all values are those of the moment before.
struct Event {
  struct Action {
    bool on_state = false;  ///< else on a discrete state
    std::uint32_t index = 0;
    NodeId value = 0;
  };
  std::string block;  ///< path
  NodeId condition = 0;
  bool at_start = true;
  bool before_start = false;  ///< what follows from it at the start was so before
  bool repeats = false;       ///< comes again for as long as the condition holds
  std::vector<Action> actions;
  std::optional<std::size_t> piling_up =
      std::nullopt;      ///< the event that takes its place where it comes ever faster
  bool of_mode = false;  ///< it puts something somewhere because its group is in a mode
};

/// A quantity that is defined by an equation: residual = 0.
struct Unknown {
  std::string name;  ///< path of its signal
  double guess = 0;
  NodeId residual = 0;
  /// The explicit output of a block cut out of an algebraic loop: its residual is (what the block gives) −
  /// (itself). Otherwise the unknown of an implicit equation, such as an ideal servo amplifier's.
  bool torn = false;
  text::Place place;
  /// The output of an amplifier: infinitely fast it moves as −residual, and rests where the residual rises.
  bool held_by_amplifier = false;
};

/// Unknowns that must be solved for together.
struct Loop {
  std::vector<std::size_t> unknowns;
  std::vector<std::string> members;  ///< paths of the blocks on the loop, in file order
};

/// The flat mathematical form of a diagram:
///
///     dx/dt = f(t, x, z; m),   0 = g(t, x, z; m),   signals = h(t, x, z; m)
///
/// with states x, algebraic unknowns z and discrete states m, which stay as they are until a switch turns
/// over. Variables of the graph are numbered: time, states, unknowns.
struct Network {
  ExpressionGraph graph;
  std::vector<State> states;
  std::vector<Unknown> unknowns;
  std::vector<Loop> loops;  ///< each after those it depends on
  std::vector<DiscreteState> discrete_states;
  std::vector<Switch> switches;
  std::vector<Event> events;
  std::vector<text::PointTable> tables;
  /// Of each group of integrators: the discrete state that holds its mode of operation. Empty without a
  /// timeline.
  std::vector<std::uint32_t> mode_states;
  std::vector<NodeId> phase_ends;  ///< conditions of the timeline's phases that end by one
  std::vector<NodeId> signals;     ///< one for each output of each flat block, in their order
  std::vector<std::string> signal_names;
  std::vector<std::size_t> first_signal;  ///< of each flat block
  std::size_t n_parameters = 0;           ///< their numbers are those of ParameterNumbers

  std::uint32_t state_variable(std::size_t state) const { return static_cast<std::uint32_t>(1 + state); }
  std::uint32_t unknown_variable(std::size_t unknown) const {
    return static_cast<std::uint32_t>(1 + states.size() + unknown);
  }
  std::size_t n_variables() const { return 1 + states.size() + unknowns.size(); }
  std::size_t signal_index(diagram::SignalRef signal) const {
    return first_signal[signal.block] + signal.output;
  }
};

/// Puts the equations of all blocks into one network; wires become shared sub-expressions and feedback
/// without a state in it becomes algebraic loops. Throws NetworkError with all findings.
///
/// With `held` parameters (by their ParameterNumbers) it is that of all diagrams that differ in these alone
/// and choose the same cases: nothing is left out because one of them is 0 or 1.
Network assemble(const diagram::FlatDiagram& diagram, std::span<const std::uint32_t> held = {});

}  // namespace oblique::network
