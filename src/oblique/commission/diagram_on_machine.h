// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/commission/judge.h>
#include <oblique/machine/scaled_realisation.h>

namespace oblique::commission {

/// A diagram in a machine's elements and scale, and what was found out about it there.
struct DiagramOnMachine {
  machine::ScaledRealisation made;
  /// Of the outputs with ideal elements from those of the diagram, over the largest value of each.
  double difference = 0;
  std::size_t published_left_out = 0;  ///< published values that set parameters, which it has no longer
  std::optional<Judgement> loops;      ///< of its servo loops on the machine, where it has any
  double loop_speed = 1;   ///< of servo amplifiers; below 1 the machine's elements are too slow for them
  std::string loop_fault;  ///< what is wrong with them at the speed of the diagram (`fault_of`), or empty
  struct Overload {
    std::string signal;
    double peak = 0;  ///< [machine unit], where no amplifier saturates
  };
  std::vector<Overload> overloads;  ///< on the machine's elements, the largest first
  std::string failure;              ///< why it does not run there, or empty
  bool given_up = false;            ///< the run there took too many steps, and tells no overloads
};

/// Puts any diagram onto a machine: realises and scales it (`machine::MachineScaling`), slows its servo
/// amplifiers by the least step of 1, 2, 5 times a power of ten with which their loops are well damped, or at
/// least stable, on the machine's elements, and makes room where these drive signals over the machine unit,
/// as far as 200 000 steps of the solver lead there.
/// Throws as MachineScaling.
DiagramOnMachine put_on_machine(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                const diagram::MachineProfile& machine,
                                const machine::ScalingOptions& options = {});

}  // namespace oblique::commission
