// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/commission/judge.h>
#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/solve/trajectory.h>

namespace oblique::compare {

/// The first row in which the links of a run stand next to another assembly mode than the exact one:
/// Newton's method, begun from where the run has a group, closes it elsewhere. Only rows that err by a
/// twentieth of the largest link are looked at; `along` has the largest error of each.
std::optional<std::size_t> row_off_branch(const mechanism::Mechanism& mechanism,
                                          const mechanism::Structure& structure,
                                          const diagram::FlatDiagram& flat, const solve::Trajectory& analog,
                                          const mechanism::Motion& exact, const std::vector<double>& along);

/// The value of the first drive [rad, or length unit] from which on the run of a patch stands next to another
/// assembly mode than the exact motion, at positions as `compare` has them. Nothing where it keeps to its
/// mode, and where it fails or takes more steps than anybody waits for: such a run tells of itself.
std::optional<double> drive_off_branch(const mechanism::Mechanism& mechanism,
                                       const commission::JudgedPatch& patched,
                                       const diagram::BlockLibrary& library);

}  // namespace oblique::compare
