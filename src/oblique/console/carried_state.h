// SPDX-License-Identifier: MIT
#pragma once

#include <span>

#include <oblique/network/program/program.h>
#include <oblique/solve/run_state.h>

namespace oblique::console {

/// The state of a run of `from`, in which `signals` are those at its time, as one of `to`: what has the same
/// name has the same value. A state of `to` that was an element of a loop of `from`, or the other way round
/// (a gain has become finite, or infinite), begins at what it was; what is new, where `to` starts it. Which
/// switches slide is then not known. Not installed.
solve::RunState carried_state(const solve::RunState& state, const network::Program& from,
                              std::span<const double> signals, const network::Program& to);

}  // namespace oblique::console
