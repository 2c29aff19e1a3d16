// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/compare/compare.h>
#include <oblique/compare/patched_run.h>
#include <oblique/network/program/program.h>

// Not installed.
namespace oblique::compare {

/// The states that come to rest once the cranks stop: those of servo amplifiers, and the integrators whose
/// output is itself the coordinate of one of these points, as the gradient servo has them. A crank that is an
/// output too (`cos φ` of a patch as the source draws it) is none.
std::vector<std::size_t> tracking_states(const network::Program& program, const diagram::FlatDiagram& flat,
                                         const std::vector<PointOutputs>& points);

/// The instant with the states `moving` (ascending) at rest and all others held. Nothing where Newton's
/// method finds no rest within a tenth of a machine unit.
std::optional<solve::Instant> at_rest(const network::Program& program, const std::vector<std::size_t>& moving,
                                      solve::Instant instant);

/// Takes the largest error of a run apart, as ErrorParts says. Nothing where the loops have no rest or the
/// run of tighter tolerance fails.
std::optional<ErrorParts> error_parts(const mechanism::Mechanism& mechanism, const PatchedMechanism& patched,
                                      const mechanism::Motion& exact, const solve::Run& analog,
                                      const Distances& error, const std::function<void(double)>& progress);

}  // namespace oblique::compare
