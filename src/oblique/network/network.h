// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/expression_graph.h>

namespace oblique {

/// Thrown by the `network` stage: equations that cannot be put into the form of a Program.
class NetworkError : public Error {
 public:
  using Error::Error;
};

/// The output of an integrator or another dynamic element: d state/dt = derivative.
struct State {
  std::string name;      ///< path of its signal
  double start = 0;      ///< [machine unit]
  bool at_rest = false;  ///< brought to rest before the clock starts; `start` is the guess
  NodeId derivative = 0;
};

/// A quantity that is defined by an equation: residual = 0.
struct Unknown {
  std::string name;  ///< path of its signal
  double guess = 0;
  NodeId residual = 0;
  /// The explicit output of a block cut out of an algebraic loop: its residual is (what the block gives) −
  /// (itself). Otherwise the unknown of an implicit equation, such as an ideal servo amplifier's.
  bool torn = false;
  Place place;
};

/// Unknowns that must be solved for together.
struct Loop {
  std::vector<std::size_t> unknowns;
  std::vector<std::string> members;  ///< paths of the blocks on the loop, in file order
};

/// The flat mathematical form of a diagram:
///
///     dx/dt = f(t, x, z),   0 = g(t, x, z),   signals = h(t, x, z)
///
/// with states x and algebraic unknowns z. Variables of the graph are numbered: time, states, unknowns.
struct Network {
  ExpressionGraph graph;
  std::vector<State> states;
  std::vector<Unknown> unknowns;
  std::vector<Loop> loops;      ///< each after those it depends on
  std::vector<NodeId> signals;  ///< one for each output of each flat block, in their order
  std::vector<std::string> signal_names;
  std::vector<std::size_t> first_signal;  ///< of each flat block

  std::uint32_t state_variable(std::size_t state) const { return static_cast<std::uint32_t>(1 + state); }
  std::uint32_t unknown_variable(std::size_t unknown) const {
    return static_cast<std::uint32_t>(1 + states.size() + unknown);
  }
  std::size_t n_variables() const { return 1 + states.size() + unknowns.size(); }
  std::size_t signal_index(SignalRef signal) const { return first_signal[signal.block] + signal.output; }
};

/// Puts the equations of all blocks into one network; wires become shared sub-expressions and feedback
/// without a state in it becomes algebraic loops. Throws NetworkError with all findings.
Network assemble(const FlatDiagram& diagram);

}  // namespace oblique
