// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/assembly/assembly.h>

// Tables: functions between whose points straight lines run.
namespace oblique::network {

/// table(x, x1, y1, …) in a block: the segment is a discrete state that follows x across the ends of
/// segments. Throws text::ExpressionError.
NodeId interpolated(Assembly& a, std::size_t block, const text::Expression& call);

/// Two switches and two events move each table's segment along.
void define_tables(Assembly& a);

}  // namespace oblique::network
