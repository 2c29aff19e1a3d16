// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/report/mechanism_check.h>

namespace oblique::report {

/// The report for people: what the mechanism is made of, its range, tables and remarks.
std::string to_text(const MechanismCheck& check);

}  // namespace oblique::report
