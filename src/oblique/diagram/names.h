// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram {

/// Whether a file may call a block, port or parameter so: an identifier that the equations do not keep for
/// themselves. Reports otherwise; `what` names the thing ("a block", "an input").
bool check_name(std::string_view name, std::string_view what, const text::Place& place,
                text::Diagnostics& diagnostics);

/// Reads a `[blocks]` table: every key a block, with its type, its label and its settings as they stand.
std::vector<BlockInstance> read_blocks(const std::string& file, const text::Value& table,
                                       text::Diagnostics& diagnostics);

/// All name nodes of an expression, in the order of the text.
std::vector<const text::Expression*> names_in(const text::Expression& expression);

/// The position of a column of the text of a string value; of a number, the value's own.
text::SourcePosition position_in(const text::Value& value, int column);

}  // namespace oblique::diagram
