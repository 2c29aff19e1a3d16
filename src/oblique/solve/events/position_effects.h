// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/event_functions.h>

// What hangs on the position of a switch. Not installed.
namespace oblique::solve {

/// Whether two values differ by more than rounding and the errors of the states make of them.
inline bool differ(double a, double b) {
  constexpr double kMuch = 1e-6;  // of 1 + the value
  return std::abs(a - b) > kMuch * (1 + std::abs(a));
}

/// Whether some signal at (t, x) is another with the switches of a unit turned over.
bool changes_signals(const network::Program& program, network::Workspace& workspace, std::uint32_t unit,
                     double t, std::span<const double> x);

/// A switch of a unit that holds on one of its sides, the upper one if `above`, and moves nothing of what it
/// compares there; nothing where there is none.
std::optional<std::uint32_t> idle_on_side(const network::Program& program, network::Workspace& workspace,
                                          std::uint32_t unit, bool above, double t,
                                          std::span<const double> x);

/// Of each unit of switches the events that set states and whose conditions follow it.
std::vector<std::vector<std::size_t>> find_setters(const network::Program& program);

/// Whether switch s, on its level, sets off one of these events there where it and others of its unit are
/// announced to go, by which its event function jumps away: then it turns over, whatever drives it back there
/// (an integrator that is put back by a comparator of its own output).
bool sets_off_a_jump(const network::Program& program, const network::Workspace& workspace,
                     const Thresholds& thresholds, const std::vector<std::size_t>& setters,
                     const Announced& announced, std::uint32_t s, double t, std::span<const double> x);

/// Whether some rate of the states is.
bool changes_rates(const network::Program& program, network::Workspace& workspace, std::uint32_t unit,
                   double t, std::span<const double> x);

}  // namespace oblique::solve
