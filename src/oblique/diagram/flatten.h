// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>

namespace oblique::diagram {

/// Expands composites, resolves types, parameters and wires. Throws DiagramError with all findings: unknown
/// types, keys and signals (each with the nearest valid name), open and doubly driven inputs, wrong units and
/// ranges. `library` must outlive the result.
FlatDiagram flatten(const Diagram& diagram, const BlockLibrary& library,
                    const std::vector<ParameterOverride>& overrides = {});

/// The same of ideal elements: nothing that the machine's profile says of its own acts, but a voltage is
/// still one of that machine.
FlatDiagram flatten_on_ideal_elements(const Diagram& diagram, const BlockLibrary& library,
                                      const std::vector<ParameterOverride>& overrides = {});

}  // namespace oblique::diagram
