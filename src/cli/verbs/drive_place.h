// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::cli {

/// The moment [s] at which the first drive stands where --at says ("80 deg"); 0 for an empty text. Throws
/// ReadError for a mechanism without a drive and where the drive does not come there.
double time_option_at(const mechanism::Mechanism& mechanism, const std::string& at);

}  // namespace oblique::cli
