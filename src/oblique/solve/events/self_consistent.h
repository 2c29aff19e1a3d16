// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/sliding_mode.h>
#include <oblique/solve/readings/thresholds.h>

// Positions of switches that agree with the event functions that follow from them. Not installed.
namespace oblique::solve {

/// Puts every switch but those that are `placed` where its event function asks for it at (t, x), and leaves
/// the event functions that follow, one a switch. Nothing where they go on turning over, or a loop has no
/// solution.
std::optional<network::Evaluation> place_others(const network::Program& program,
                                                network::Workspace& workspace, const Thresholds& thresholds,
                                                const std::vector<bool>& placed, double t,
                                                std::span<const double> x,
                                                std::vector<double>& event_functions);

/// What agrees with itself: nothing, or switches of which one or several combinations as near do.
struct Agreement {
  bool any = false;
  std::vector<std::uint32_t> open;  ///< the switches that stand otherwise in another one
};

/// Tries all combinations of `restless` and of the switches that share their algebraic loops, the nearest to
/// the present one first, until one agrees with itself at (t, x); nothing, and nothing changed, where none
/// does, or they are too many. The switches `left` are left as they stand, and need not agree. `span` is the
/// length of the run [s].
Agreement choose_any(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                     const Thresholds& thresholds, double span, std::vector<std::uint32_t> restless,
                     const std::vector<std::uint32_t>& left, double t, std::span<const double> x);

/// The first switch with a jump that agrees with itself on its other side too, all others settled with it;
/// nothing where there is none. (Of algebraic loops see OtherSolutions: those are left out.)
std::optional<std::uint32_t> find_open(const network::Program& program, const network::Workspace& workspace,
                                       const SlidingMode& slide, const Thresholds& thresholds, double span,
                                       double t, std::span<const double> x);

}  // namespace oblique::solve
