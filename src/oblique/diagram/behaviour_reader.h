// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/block_definition.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads `[let]`, `[equations]`, `[implicit]`, `[[cases]]` and `[start]` of a primitive block whose ports and
/// parameters are known already. Afterwards every derivative and implicit target has a StartRule.
void read_behaviours(text::TableReader& reader, BlockDefinition& definition, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
