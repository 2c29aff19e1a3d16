// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/ensemble/study/philox.h>

namespace oblique::ensemble {

/// A parameter of an element that draws.
struct DrawnElement {
  std::size_t block = 0;      ///< in FlatDiagram::blocks
  std::size_t parameter = 0;  ///< in the block's definition
  std::size_t scatter = 0;    ///< its place in the list
  double half_width = 0;      ///< [unit of the parameter]

  /// Uniform within ± half width about `nominal`, which depends on the key, the place of the block in the
  /// diagram, and the place of the scatter in the list, on nothing else. A value that the parameter may not
  /// have is mirrored at the nominal one.
  double draw(const diagram::FlatDiagram& diagram, double nominal, DrawKey key) const;
};

/// All parameters of all blocks that the scatters name.
std::vector<DrawnElement> drawn_elements(const diagram::FlatDiagram& diagram,
                                         const std::vector<diagram::BlockFigure>& scatters);

/// What one element drew.
struct Draw {
  std::size_t block = 0;      ///< in FlatDiagram::blocks
  std::size_t parameter = 0;  ///< in the block's definition
  double value = 0;           ///< in the parameter's unit
};

/// Draws a value for each parameter of each block that a scatter names, about the one that it has.
std::vector<Draw> draw(const diagram::FlatDiagram& diagram, const std::vector<diagram::BlockFigure>& scatters,
                       DrawKey key);

/// Gives the blocks what they drew; a block's equations may become another case of its definition.
void apply_draws(const std::vector<Draw>& draws, diagram::FlatDiagram& diagram);

/// The scatter of elements that are all made to one relative tolerance: each parameter named `tolerance` of
/// the library's primitive blocks but the capacitors', and the error of multipliers, as parts of full scale.
std::vector<diagram::BlockFigure> scatters_of_tolerance(const diagram::BlockLibrary& library,
                                                        double tolerance);

}  // namespace oblique::ensemble
