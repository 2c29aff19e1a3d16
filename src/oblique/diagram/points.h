// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/text/document.h>
#include <oblique/text/point_table.h>

namespace oblique {

/// Reads a function given by points: [[x, y], …], or { file = "data.csv", x = "t", y = "u" }, two columns of
/// a file beside `file`. Reports what is wrong with it; `subject` names it in messages.
std::optional<PointTable> read_points(const std::string& file, const Value& value, const std::string& subject,
                                      Diagnostics& diagnostics);

}  // namespace oblique
