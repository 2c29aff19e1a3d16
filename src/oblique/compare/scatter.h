// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::compare {

/// Random bits that depend on a counter and a key alone, so that any of them can be had in any order and by
/// any thread: Philox 4×32 with 10 rounds (Salmon, Moraes, Dror, Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3", SC 2011).
std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key);

/// Which run of which experiment draws.
struct DrawKey {
  std::uint64_t seed = 1;
  std::uint64_t run = 0;
};

/// What one element drew.
struct Draw {
  std::size_t block = 0;      ///< in FlatDiagram::blocks
  std::size_t parameter = 0;  ///< in the block's definition
  double value = 0;           ///< in the parameter's unit
};

/// Draws a value for each parameter of each block that a scatter names: uniform within ± half width about the
/// one that it has, which depends on the key, the place of the block in the diagram, and the place of the
/// scatter in the list, on nothing else. A value that the parameter may not have is mirrored at the one
/// that it has.
std::vector<Draw> draw(const diagram::FlatDiagram& diagram, const std::vector<diagram::BlockFigure>& scatters,
                       DrawKey key);

/// Gives the blocks what they drew; a block's equations may become another case of its definition.
void apply_draws(const std::vector<Draw>& draws, diagram::FlatDiagram& diagram);

/// The scatter of elements that are all made to one relative tolerance: each parameter named `tolerance` of
/// the library's primitive blocks but the capacitors', and the error of multipliers, as parts of full scale.
std::vector<diagram::BlockFigure> scatters_of_tolerance(const diagram::BlockLibrary& library,
                                                        double tolerance);

}  // namespace oblique::compare
