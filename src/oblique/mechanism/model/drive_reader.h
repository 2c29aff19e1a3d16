// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/text/document.h>

namespace oblique::mechanism {

/// Reads one entry of [drives] and adds it to the mechanism, whose bodies and prismatic joints are known
/// already; a finding leaves it out.
void read_drive(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics);

}  // namespace oblique::mechanism
