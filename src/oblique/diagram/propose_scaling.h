// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include <oblique/diagram/block_scaling.h>
#include <oblique/diagram/flat_diagram.h>

namespace oblique::diagram {

/// An excess over the machine unit below this is no overload: a signal scaled to the full range reaches it,
/// and passes it by the static error of its amplifier and the tolerance of the solver.
inline constexpr double kOverloadTolerance = 1e-6;

/// The largest of 1, 1/2, 1/5, 1/10, 1/20, … (and 2, 5, 10 … for small ones) that brings `peak` to at most 1
/// machine unit; an excess of kOverloadTolerance counts as none. 1 for a peak of 0.
double scale_for_peak(double peak);

/// The amplitude scaling of a diagram: factors for every flat block.
using AmplitudeScaling = std::vector<BlockScaling>;

/// Proposes an amplitude scaling from the peaks of a trial run; `peaks` are magnitudes of every output of
/// every flat block, in their order [machine unit]. Blocks whose equations allow it are scaled as a whole, to
/// the largest 1-2-5 step that keeps their outputs within the machine unit (up by 1000 at most: what needs
/// more is noise, and stays; blocks without inputs never up). A multiplier and its like are fed by weights of
/// ±1, or less where their outputs would leave the machine unit, and the factor that follows for these goes
/// into the weights of the wires they feed. Blocks whose equations forbid scaling (a cosine) keep their
/// signals.
AmplitudeScaling propose_scaling(const FlatDiagram& flat, std::span<const double> peaks);

}  // namespace oblique::diagram
