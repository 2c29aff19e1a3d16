// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <oblique/text/expression.h>

namespace oblique {

/// A unit of measure: its name, its size in coherent base units (m, s, rad, kg, V, machine unit), and its
/// dimension. An angle is a dimension of its own, so that "60 rpm" is never mistaken for "1 Hz".
struct Unit {
  enum Base { length, time, angle, mass, voltage, signal, kBases };
  std::string name;
  double scale = 1;
  std::array<int, kBases> exponents{};

  bool same_dimension(const Unit& other) const { return exponents == other.exponents; }
};

/// Reads a unit: base names joined by `*`, `/` and `^n` ("mm/s^2", "rad/s", "machine unit", "1"). Empty if
/// unknown.
std::optional<Unit> parse_unit(std::string_view text);

/// Reads a constant expression with an optional unit ("60 rpm", "2*pi/3", "30 deg") and gives it in `wanted`;
/// without a unit the number is in `wanted` already. Throws ExpressionError.
double parse_quantity(std::string_view text, const Unit& wanted, const NameLookup& lookup = {});

/// What a number before the unit in `text`, from `rest` on, is multiplied by to be in `wanted`; 1 where there
/// is none. Throws ExpressionError.
double unit_factor(std::string_view text, std::size_t rest, const Unit& wanted,
                   const NameLookup& lookup = {});

}  // namespace oblique
