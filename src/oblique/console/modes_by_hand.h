// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/console/pots.h>
#include <oblique/diagram/diagram.h>
#include <oblique/solve/run_state.h>

// The modes of operation of a console whose diagram has no timeline: each is a phase. Not installed.
namespace oblique::console {

/// All modes, each in an endless phase; the first is a run's own.
diagram::Timeline modes_by_hand();
/// In which of these phases a mode is.
solve::PhasePosition position_in(diagram::OperatingMode mode);

/// In initial condition for so long, then in operation, again and again [s].
diagram::Timeline repetition(double initial, double operate);

/// Modes that were set by hand are in a state that was saved then: sets those of a machine so that it has
/// them too, and none where the state knows of none.
void take_modes_of(solve::RunState& state, Pots& pots);

}  // namespace oblique::console
