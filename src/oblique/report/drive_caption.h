// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::report {

/// "crank = 80°", "lift = 12.5 mm": where the first drive stands at a moment [s].
std::string drive_caption(const mechanism::Mechanism& mechanism, double time);

}  // namespace oblique::report
