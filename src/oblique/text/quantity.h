// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include <oblique/text/expression.h>

namespace oblique::text {

/// A unit of measure: its name, its size in coherent base units (m, s, rad, kg, V, machine unit), and its
/// dimension. An angle is a dimension of its own, so that "60 rpm" in rad/s is never mistaken for 1; where
/// one of hertz and rad/s is wanted and the other given, a turn is 2π rad.
struct Unit {
  enum Base { length, time, angle, mass, voltage, signal, kBases };
  std::string name = "1";
  double scale = 1;
  std::array<int, kBases> exponents{};
  bool counts_turns = false;  ///< Hz, and 1/min: turns of whatever turns, where an angular velocity is wanted

  /// Of a wanted unit of signals: whose machine unit it is, and how many volts that has there. Without a
  /// machine voltages and machine units have nothing to do with each other.
  std::string machine;
  std::optional<double> volts;

  bool same_dimension(const Unit& other) const { return exponents == other.exponents; }
};

/// Reads a unit: base names joined by `*`, `/` and `^n` ("mm/s^2", "rad/s", "machine unit", "1"). Empty if
/// unknown.
std::optional<Unit> parse_unit(std::string_view text);

/// What one of `unit` is in `wanted`; nothing where the one cannot stand for the other. Beside units of one
/// dimension these can: frequencies and angular velocities, voltages and signals of a machine whose unit is
/// known, and percent of the machine unit.
std::optional<double> factor_between(const Unit& unit, const Unit& wanted);

/// Reads a constant expression with an optional unit ("60 rpm", "2*pi/3", "30 deg") and gives it in `wanted`;
/// without a unit the number is in `wanted` already. Throws ExpressionError.
double parse_quantity(std::string_view text, const Unit& wanted, const NameLookup& lookup = {});

/// A quantity without a unit in that of another one, as the first bound of "1..2 mm" is; else as it stands.
std::string with_unit_of(std::string_view quantity, std::string_view other);

/// What a number before the unit in `text`, from `rest` on, is multiplied by to be in `wanted`; 1 where there
/// is none. Throws ExpressionError.
double unit_factor(std::string_view text, std::size_t rest, const Unit& wanted,
                   const NameLookup& lookup = {});

}  // namespace oblique::text
