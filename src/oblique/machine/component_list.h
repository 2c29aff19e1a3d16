// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::machine {

/// One kind of element: what a diagram needs of it and what the machine has.
struct ComponentListRow {
  std::string element;              ///< "multipliers", "integrators with k0 = 100 1/s"
  double needed = 0;                ///< inf never
  bool exists = true;               ///< whether the machine has elements of the kind at all
  std::optional<double> available;  ///< nothing: not published; inf: as many as it takes
  std::string note;                 ///< "12 summers, 2 integrators …"
  bool at_least = false;  ///< `needed` is what is known to be: the machine's inputs are not published
  std::vector<std::string> blocks;  ///< that are of the kind, of those that no other kind can stand in for
  bool is_block = false;            ///< no kind of element but a block, to be made of elements first

  double missing() const;  ///< 0 where the count is unknown
};

/// What a diagram needs on a machine, and whether the machine has it.
struct ComponentList {
  enum class Verdict { fits, does_not_fit, cannot_tell };
  std::string machine;  ///< MachineProfile::title
  std::vector<ComponentListRow> rows;

  /// cannot_tell: nothing is known to be missing, but a count or what the inputs weigh is not published.
  Verdict verdict() const;
  /// The kinds of elements that are needed and of which the machine has none.
  std::vector<std::string> absent() const;
};

/// Counts the elements of a diagram as it is drawn. A weight that is no gain of the machine's inputs counts
/// as a potentiometer, once for each signal and setting; a negative one, where coefficients have no sign, as
/// an inverter, once for each signal; so does an initial value as a potentiometer. A constant, and what has
/// the weight 0, is for nothing but its potentiometer.
///
/// Where the gains of the machine's inputs are not published, its potentiometers are at least those that
/// other connections need.
///
/// Where amplifiers are uncommitted every summer, inverter, integrator and open amplifier is one, and the
/// integrator takes a network besides. Elsewhere open amplifiers are summers, and so are inverters beyond
/// those that the machine has.
ComponentList component_list_of(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine);

}  // namespace oblique::machine
