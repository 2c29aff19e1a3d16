// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

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

}  // namespace oblique::compare
