// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/run_state.h>

namespace oblique::console {

/// Blocks that have other names now: the one before, and the new one.
using Renamed = std::vector<std::pair<std::string, std::string>>;

/// A path ("c", "c.product") as it was called before blocks were renamed; empty where something else was.
std::string path_before(std::string_view path, const Renamed& renamed);

/// The state of a run of `from`, in which `signals` are those at its time, as one of `to`: what has the same
/// name has the same value. A state of `to` that was an element of a loop of `from`, or the other way round
/// (a gain has become finite, or infinite), begins at what it was; what is new, where `to` starts it. Which
/// switches slide is then not known. Blocks may have other names in `to`: those of `renamed`. Not installed.
solve::RunState carried_state(const solve::RunState& state, const network::Program& from,
                              std::span<const double> signals, const network::Program& to,
                              const Renamed& renamed = {});

}  // namespace oblique::console
