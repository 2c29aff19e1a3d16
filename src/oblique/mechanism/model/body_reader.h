// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <Eigen/Core>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/text/document.h>
#include <oblique/text/table_reader.h>

namespace oblique::mechanism {

/// Lengths and coordinates that are read, in the file's unit: their squares, and products with what moves at
/// any sensible speed, stay numbers.
inline constexpr double kShortest = 1e-100;
inline constexpr double kLongest = 1e100;

/// Reads `[x, y]` in `unit`; both may be quantities. Findings go to `diagnostics` with `what` as their
/// subject.
std::optional<Eigen::Vector2d> read_coordinates(const std::string& file, const text::Value& value,
                                                std::string_view unit, const std::string& what,
                                                text::Diagnostics& diagnostics);

/// True for an identifier; otherwise reports it at `place` as the name of a `kind` ("body", "point").
bool check_name(std::string_view kind, const std::string& name, const text::Place& place,
                text::Diagnostics& diagnostics);

/// Reads one entry of `[bodies]` and appends it, with the points it is first to name, to `mechanism`.
void read_body(const text::Entry& entry, Mechanism& mechanism, text::Diagnostics& diagnostics);

}  // namespace oblique::mechanism
