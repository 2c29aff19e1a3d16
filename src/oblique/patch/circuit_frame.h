// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// Title, comment and run, and the reference; `method` ends the title, `remarks` stand in the comment.
void begin_circuit(Circuit& circuit, const std::string& method, const std::string& remarks);

/// "one turn of 'crank'", or how long the file says: for the remarks.
std::string span_text(const mechanism::Mechanism& mechanism);

/// Velocities and accelerations where the options want them, and the outputs: all points in the length unit,
/// under the names of `solve`'s columns.
void end_circuit(Circuit& circuit);

}  // namespace oblique::patch
