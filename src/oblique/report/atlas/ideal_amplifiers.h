// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/flat_diagram.h>

namespace oblique::report {

/// The same circuit where no amplifier has a limit, and open ones have an infinite gain: it shows the
/// equations that they are there to solve. One without a way back to its inputs solves none, and keeps its
/// gain. Throws NetworkError.
diagram::FlatDiagram with_ideal_amplifiers(const diagram::FlatDiagram& diagram);

}  // namespace oblique::report
