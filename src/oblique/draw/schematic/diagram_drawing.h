// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/draw/layout/layout.h>
#include <oblique/draw/picture/picture.h>

namespace oblique::draw {

/// The shapes of the blocks.
enum class SymbolStyle {
  classic,  ///< triangles, circles and boxes, as on the plans of analog computers
  din,      ///< boxes with a sign in them, after DIN 40900 part 13
};

/// How a block diagram is drawn.
struct DiagramDrawing {
  SymbolStyle symbols = SymbolStyle::classic;
  int depth = 0;  ///< levels of composites that are shown open, as frames; the others are boxes
};

/// A block diagram in the notation of analog computers: signals run from left to right, what is fed back runs
/// around; weights stand at the inputs, a small circle marks what inverts, every servo loop has a colour. A
/// constant stands at each input that it feeds, what the diagram's outputs measure is written at the signal.
/// The symbol is that of the block's file; a box with the names of its ports where there is none. Places of
/// the diagram's `[layout]` win over the automatic ones. Marks carry the ids "block-PATH" and
/// "net-PATH.OUTPUT", bodies the element and what it gives, wires their signal as the file has it. Throws
/// DiagramError with all findings about the wiring and the layout.
Picture draw_diagram(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                     const DiagramDrawing& options = {});

/// Where that picture has the blocks while composites are closed: as a `[layout]` in the diagram's file, it
/// gives these places. Throws like `draw_diagram`.
std::vector<diagram::BlockPlace> drawn_places(const diagram::Diagram& diagram,
                                              const diagram::BlockLibrary& library,
                                              SymbolStyle symbols = SymbolStyle::classic);

/// How easily that picture reads: crossings and bends of its wires, those in open composites included. Throws
/// like `draw_diagram`.
LayoutQuality drawing_quality(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                              const DiagramDrawing& options = {});

}  // namespace oblique::draw
