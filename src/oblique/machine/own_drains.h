// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/diagram/flat_diagram.h>

// Not installed.
namespace oblique::machine {

/// Makes weighted inputs of what the parameters `leakage` and `drift` of an integrator feed it with: nobody
/// who patches a machine could set these. Throws RealiseError where the integrator is to hold at any time,
/// and they would go on.
void wire_drains(diagram::FlatDiagram& flat);

}  // namespace oblique::machine
