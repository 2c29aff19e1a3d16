// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/propose_scaling.h>

namespace oblique::diagram {

/// Writes a diagram in scaled signals: weights, initial values, constants and the scales of the outputs are
/// adapted, so that every output is what it was. The result is flat: composites are laid out, since their
/// inner signals are scaled too ("C.cosine" becomes C_cosine). `diagram` is that of `flat`; constants and
/// sums that only an input of a composite could hold become blocks of the library. Throws DiagramError where
/// a block cannot stand in the flat file. A `[layout]` is kept where no composite has a place in it.
Diagram rescale(const Diagram& diagram, const FlatDiagram& flat, const AmplitudeScaling& scaling,
                const BlockLibrary& library);

}  // namespace oblique::diagram
