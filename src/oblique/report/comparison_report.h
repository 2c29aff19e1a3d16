// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/compare/compare.h>
#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// Where the first drive stands: "172.5°" within one turn, or "12.5 mm" of a prismatic joint.
std::string drive_text(const compare::Comparison& comparison, double value);

/// What `patch` warns of where the run of a patch leaves its assembly mode (`compare::drive_off_branch`).
std::string left_branch_text(const mechanism::Mechanism& mechanism, double drive,
                             const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// What `compare` prints: errors, their parts and reasons, order, overloads.
std::string to_text(const compare::Comparison& comparison);

/// The same for `--json` (docs/trust.md), with or without the seconds that were measured.
nlohmann::ordered_json to_json(const compare::Comparison& comparison, bool timings);

}  // namespace oblique::report
