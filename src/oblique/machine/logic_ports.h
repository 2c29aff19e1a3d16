// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/diagram/flat_diagram.h>

// Not installed.
namespace oblique::machine {

/// What is a level or a number, whatever the scale, at a block that stays as it is on a machine: a counter's
/// clock and carry, but not its count in machine units.
struct LogicPorts {
  std::vector<bool> inputs, outputs;
  bool scales = false;  ///< whether its other signals may have any factor, one for all
};

/// Those of a block without a role that a machine takes as it is: one that says what it takes of the
/// machine's elements (`[requires]`), as a counter, a flip-flop, a monostable, a delay line or a noise
/// generator do. Nothing for others, and where one factor for all that is no level or number changes what it
/// does.
std::optional<LogicPorts> logic_ports(const diagram::FlatBlock& block);

}  // namespace oblique::machine
