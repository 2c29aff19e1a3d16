// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {

/// Reads `[lesson]`; `diagram` holds its outputs already. Times must lie within a run of `until` [s].
Lesson read_lesson(const Diagram& diagram, const text::Value& table, double until,
                   text::Diagnostics& diagnostics);

/// `[lesson]`, its `[[lesson.step]]` and `[lesson.question]` as a file has them.
std::string write_lesson(const Lesson& lesson);

}  // namespace oblique::diagram
