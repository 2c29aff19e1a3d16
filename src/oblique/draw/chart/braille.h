// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include <oblique/draw/chart/chart.h>

namespace oblique::draw {

/// Columns below which a chart in the terminal has no room.
inline constexpr std::size_t kFewestColumns = 40;

/// The chart as lines of text, in dots of Braille (two by four a character), with the numbers of the axes and
/// the names of the curves beside their ends. No line is longer than `columns`, of which there are at least
/// kFewestColumns. With `colours` a curve and its name have a colour, by ANSI escapes.
std::string to_braille(const Chart& chart, std::size_t columns, bool colours);

}  // namespace oblique::draw
