// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/compare/compare.h>

namespace oblique::report {

/// Where the first drive stands: "172.5°" within one turn, or "12.5 mm" of a prismatic joint.
std::string drive_text(const compare::Comparison& comparison, double value);

/// What `compare` prints: errors, their parts and reasons, order, overloads.
std::string to_text(const compare::Comparison& comparison);

/// The same for `--json` (docs/trust.md), with or without the seconds that were measured.
nlohmann::ordered_json to_json(const compare::Comparison& comparison, bool timings);

}  // namespace oblique::report
