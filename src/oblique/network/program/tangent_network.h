// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/assembly/network.h>

namespace oblique::network {

/// A network that computes, besides its signals, how everything in it moves along a direction: of the time,
/// the states, the discrete states and some parameters. The direction is put in as discrete states, the
/// unknowns of algebraic loops move as these loops make them, and what moves is read as further signals. It
/// has no switches and events: their positions are put in like the direction.
struct TangentNetwork {
  Network network;

  // Discrete states that hold the direction:
  std::size_t time = 0;                  ///< of the time
  std::size_t first_state = 0;           ///< of the states
  std::size_t first_discrete_state = 0;  ///< of the discrete states of the network as it was
  std::size_t first_parameter = 0;       ///< of the parameters, in the order of the request

  // Signals:
  std::size_t derivatives = 0;      ///< d(dx/dt) of each state
  std::size_t signals = 0;          ///< d of each signal of the network as it was
  std::size_t event_values = 0;     ///< the event function of each switch
  std::size_t event_functions = 0;  ///< d of it
  std::size_t starts = 0;           ///< d of where each state starts
  /// Of each action of each event: its value, and d of it next to it.
  std::vector<std::vector<std::size_t>> actions;
  /// Of each, whether it may move where no discrete state does.
  std::vector<std::vector<bool>> actions_move;
};

/// `parameters` are numbers of ParameterNumbers.
TangentNetwork with_tangents(Network made, std::span<const std::uint32_t> parameters);

/// A network whose signals are the derivatives of dx/dt by parameters, those that are not zero, each computed
/// by itself: all of them together in one evaluation, where a TangentNetwork gives one column after the
/// other.
struct ParameterDerivatives {
  Network network;
  struct Entry {
    std::uint32_t state = 0, parameter = 0;  ///< the parameter by its place in the request
  };
  std::vector<Entry> entries;  ///< what each signal is
};
ParameterDerivatives with_parameter_derivatives(Network made, std::span<const std::uint32_t> parameters);

}  // namespace oblique::network
