// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::diagram {

/// Reads one machine file (oblique-machine/1, docs/machines.md), whose figures act on blocks of `library`.
/// Throws DiagramError with all findings: unknown keys, elements, blocks and parameters, values out of range,
/// figures without a value or a source; ReadError for broken TOML.
MachineProfile parse_machine(std::string_view text, std::string file, std::string name,
                             const BlockLibrary& library);

}  // namespace oblique::diagram
