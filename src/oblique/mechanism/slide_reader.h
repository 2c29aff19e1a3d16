// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/mechanism.h>
#include <oblique/text/document.h>

namespace oblique {

/// Reads one entry of [slides] and adds it to the mechanism, whose points and bodies are known already; a
/// finding leaves it out.
void read_slide(const Entry& entry, Mechanism& mechanism, Diagnostics& diagnostics);

}  // namespace oblique
