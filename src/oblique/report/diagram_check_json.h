// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/report/diagram_check.h>

namespace oblique::report {

/// A check as JSON, with numbers in full.
std::string to_json(const DiagramCheck& check);

}  // namespace oblique::report
