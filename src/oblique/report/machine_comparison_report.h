// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/compare/machine_comparison.h>

namespace oblique::report {

/// What `compare --machine` prints below the comparison; lengths are in the comparison's unit.
std::string to_text(const compare::MachineComparison& machine, const compare::Comparison& comparison,
                    const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// The same of a diagram: errors are parts of the largest value of each output.
std::string to_text(const compare::MachineComparison& machine,
                    const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// The same for `--json` (docs/trust.md).
nlohmann::ordered_json to_json(const compare::MachineComparison& machine);

}  // namespace oblique::report
