// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/element_kind.h>
#include <oblique/diagram/role.h>
#include <oblique/text/diagnostic.h>
#include <oblique/text/quantity.h>

namespace oblique::diagram {

/// How many elements of a kind a machine has, nothing where that is not published.
struct ElementCount {
  ElementKind kind = ElementKind::amplifier;
  std::optional<double> count;  ///< inf: as many as it takes
  std::string note;             ///< what is published in words
};

/// A published figure, as people read it.
struct MachineFigure {
  std::string name;   ///< "multiplier, static error"
  std::string value;  ///< "±0.4 % of full scale", or "unknown"
  std::string source;
};

/// A figure as it acts in the blocks of a diagram: a value for a parameter that the diagram leaves open, or
/// how far single elements scatter about theirs.
struct BlockFigure {
  std::string block, parameter;
  double value = 0;         ///< of the parameter in its unit; of a scatter its half width
  std::string figure;       ///< MachineFigure::name it comes from
  Role role = Role::other;  ///< of the shipped block of that name

  /// The parameter of a block on which it acts: that of its name, where the block is the one that the figure
  /// names or one of a user's with the same role. Nothing where it does not act.
  std::optional<std::size_t> acts_on(const BlockDefinition& definition) const;
};

/// An analog computer as far as it is published.
struct MachineProfile {
  std::string name;  ///< of its file: "tr-10"
  std::string title;
  std::string source;
  std::string comment;
  std::optional<double> unit;       ///< [V]
  bool inverting = true;            ///< summers and integrators invert
  bool inverting_summers = true;    ///< false: in diagrams they do, on the machine summers do not
  std::vector<double> input_gains;  ///< ascending; empty: any
  std::vector<double> rates;        ///< k0 of integrators [1/s], ascending; empty: any
  bool input_gains_known = true;    ///< false: not published, and `input_gains` is empty
  bool rates_known = true;
  bool signed_coefficients = false;  ///< coefficients may be negative
  std::optional<double> saturation;  ///< greatest magnitude of an amplifier's output [machine unit]
  std::vector<ElementCount> elements;
  std::vector<MachineFigure> figures;
  std::vector<BlockFigure> errors;    ///< systematic: every element has them
  std::vector<BlockFigure> scatters;  ///< tolerances: every element draws its own, uniform within ± value

  /// Nothing where the machine has no such element; a count of nothing where it is unknown.
  const ElementCount* find(ElementKind kind) const;
};

/// The shipped profile of that name, or nothing; all of them in alphabetical order, "ideal" first.
const MachineProfile* find_machine(std::string_view name);
std::vector<std::string> machine_names();

/// A unit that quantities of a diagram for that machine are wanted in: voltages stand for signals there, but
/// on the ideal machine, whose unit is no voltage, and where a machine's is not published.
text::Unit unit_on(std::string_view profile, std::string_view unit);

/// What to say where there is no profile of that name: with the nearest one, which may also be meant by a
/// word of its title ("МН-14", "Heathkit").
text::Diagnostic unknown_machine(std::string_view name, text::Place place = {});

}  // namespace oblique::diagram
