// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>

// Modes of operation on a machine: [groups] and [timeline]. Not installed.
namespace oblique::machine {

/// Whether the integrators of a machine may have modes of their own: what its figure "integrators, modes"
/// begins with, `individual` or `common`; nothing where it is not published.
std::optional<bool> has_mode_groups(const diagram::MachineProfile& machine);

/// Prepares the modes of a flat diagram for a machine. A mode line becomes a comparator's, of the levels 0
/// and 1, unless it is one. Integrators that are not in `own`, which stand for a source or a lag, operate in
/// a group of their own: what they stand for knows no modes. A store becomes an integrator without inputs,
/// whose initial value is what it tracks, in a group of its own that is in initial condition while it does.
/// Throws RealiseError where groups of integrators have modes of their own and the machine has one for all,
/// and where a store does not start as such an integrator does.
void prepare_modes(diagram::FlatDiagram& flat, const diagram::FlatDiagram& own,
                   const diagram::BlockLibrary& library, const diagram::MachineProfile& machine);

/// The signals that modes depend on: of each group those of `initial` and `hold`, then of each phase that of
/// `until`, where there are any.
std::vector<diagram::SignalRef> mode_signals(const diagram::FlatTimeline& timeline);

/// An element of a machine as the modes name it.
struct ModeSource {
  std::string name;
  double scale = 1;  ///< the signal that is meant is so many times that of the element
};

/// Writes the timeline of `flat` into `diagram`, whose integrators are `members` of each group. `sources` are
/// those of `mode_signals`.
void write_modes(const diagram::FlatTimeline& timeline, const std::vector<std::vector<std::string>>& members,
                 const std::vector<ModeSource>& sources, diagram::Diagram& diagram);

}  // namespace oblique::machine
