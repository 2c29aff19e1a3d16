// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/text/document.h>
#include <oblique/text/point_table.h>
#include <oblique/text/quantity.h>

namespace oblique::diagram {

/// What the numbers of a function given by points are in.
struct PointUnits {
  text::Unit x, y;
};

/// Reads a function given by points: [[x, y], …], or { points = [[x, y], …], beyond = "hold" }, or, with
/// `beyond` or without, { file = "data.csv", x = "t", y = "u" }, two columns of a file beside `file`; or, as
/// the sheet of a diode function generator, { at_zero = …, slope = …, segments = [[breakpoint, slope beyond
/// it], …] } from x = 0 outwards. Numbers without a unit are in `units`; of a column whose heading tells
/// another unit that can stand for it ("t [ms]", "u/V") all are converted. Reports what is wrong with it;
/// `subject` names it in messages.
std::optional<text::PointTable> read_points(const std::string& file, const text::Value& value,
                                            const PointUnits& units, const std::string& subject,
                                            text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
