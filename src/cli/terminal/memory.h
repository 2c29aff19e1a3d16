// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::cli {

/// Call it first: from then on the program ends in order where memory runs out, even where that cannot be
/// thrown (in a function that is noexcept) or is swallowed (by a stream, which takes it for the end of what
/// it reads).
void guard_memory();

/// Whether memory ran out at some time: what was found since may be for the lack of it.
bool memory_ran_out();

/// Says so on stderr, without taking memory.
void print_no_memory();

}  // namespace oblique::cli
