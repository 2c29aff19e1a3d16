// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram {

/// Reads a `[layout]` table, `block = [x, y]`. Reports what is no block of `blocks` and what is no place.
std::vector<BlockPlace> read_layout(const std::string& file, const text::Value& table,
                                    const std::vector<BlockInstance>& blocks, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
