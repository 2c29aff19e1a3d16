// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/report/mechanism_check.h>

namespace oblique::report {

/// A check as JSON, with numbers in full.
std::string to_json(const MechanismCheck& check);

}  // namespace oblique::report
