// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/mechanism.h>
#include <oblique/text/document.h>

namespace oblique {

/// Reads one entry of [drives] and adds it to the mechanism, whose bodies and slides are known already; a
/// finding leaves it out.
void read_drive(const Entry& entry, Mechanism& mechanism, Diagnostics& diagnostics);

}  // namespace oblique
