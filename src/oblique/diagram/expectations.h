// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads `[expect]`; a value may be given in the unit of its output, which `diagram` holds already. Times
/// must lie within a run of `until` [s].
std::vector<Expectation> read_expectations(const Diagram& diagram, const text::Value& table, double until,
                                           text::Diagnostics& diagnostics);

/// "side at 3.5", "side maximum": the key of an expectation that has no text of its own.
std::string expectation_key(const Expectation& expectation);

/// Reports every expectation about an output that is not among `outputs`.
void check_expected_outputs(const std::vector<Expectation>& expectations,
                            const std::vector<std::string>& outputs, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
