// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/console/carried_state.h>
#include <oblique/console/pots.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flatten.h>

namespace oblique::console {

/// The pots that are turned and of which another diagram, with these new names, says the same. Not installed.
std::vector<diagram::ParameterOverride> kept_pots(const Pots& pots, const diagram::Diagram& next,
                                                  const Renamed& renamed);

}  // namespace oblique::console
