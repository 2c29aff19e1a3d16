// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/edit/written_wires.h>
#include <oblique/draw/picture/picture.h>
#include <oblique/draw/schematic/diagram_drawing.h>

namespace oblique::draw {

/// A wire where it ends at a block, as the file has it.
struct PatchPanelWire {
  diagram::WrittenWire written;
  double weight = 1;
  std::optional<Eigen::Vector2d> at;  ///< on the body's left edge [px]; none where nothing can be drawn of it
};

/// An input that must be wired and is not, or an output.
struct PatchPanelPort {
  std::string name;    ///< of an output the signal, as wires name it
  Eigen::Vector2d at;  ///< on the body's edge [px]
};

/// A block where it is drawn.
struct PatchPanelBlock {
  const diagram::BlockInstance* instance = nullptr;
  const diagram::BlockDefinition* definition = nullptr;  ///< none where its type is not known
  std::optional<Box> body, whole;                        ///< [px]; none where it stands at inputs: a constant
  double x = 0, y = 0;                                   ///< its place, as a `[layout]` would have it
  bool is_placed = false;                                ///< the file gives the place
  std::vector<PatchPanelWire> wires;
  std::vector<PatchPanelPort> open_inputs, outputs;
};

/// A patch panel: the picture of a diagram that may be wrong, and where everything is in it.
struct PatchPanel {
  Picture picture;
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< where places count from [px]
  std::vector<PatchPanelBlock> blocks;               ///< in the order of the file
  std::vector<diagram::BlockPlace> moved;  ///< places that blocks needed in place of those of the file
  std::vector<std::string> lost;           ///< blocks whose wires find no way: they are drawn straight
};

/// Draws a diagram as far as it is right: wires that name no signal are left out, inputs that must be wired
/// end at a "?", a block of a type that is not known is a box. What `[layout]` puts too close to something
/// makes room, the block `held` for all others. Constants with a place stand there. `diagram` and `library`
/// must outlive the result.
PatchPanel draw_panel(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                      const std::string& held = {}, SymbolStyle symbols = SymbolStyle::classic);

/// The schematic inside a composite of a diagram, by its path ("c", "c.direction"). Throws DiagramError where
/// the diagram is wrong, or has no such composite.
Picture draw_inside(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                    const std::string& path, SymbolStyle symbols = SymbolStyle::classic);

/// The symbol of a kind of block alone.
Picture draw_symbol_of(const diagram::BlockDefinition& definition,
                       SymbolStyle symbols = SymbolStyle::classic);

}  // namespace oblique::draw
