// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <oblique/mechanism/analysis/analysis.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {

inline constexpr double kDegree = std::numbers::pi / 180;  ///< [rad]

/// What `check` finds out about a mechanism.
struct MechanismCheck {
  std::string file;
  mechanism::Mechanism mechanism;
  mechanism::Structure structure;
  mechanism::MechanismAnalysis analysis;
  std::optional<std::string> finding;  ///< what keeps it from moving
};

/// Looks at a mechanism from the file `file`. Throws as `decompose` and `analyse`.
MechanismCheck examine(mechanism::Mechanism mechanism, const std::string& file);

/// "dyad BC-CD (class II, RRR): C lies left of B → D".
std::string describe(const mechanism::Mechanism& mechanism, const mechanism::Group& group);

/// What a designer would look at again.
std::vector<std::string> remarks(const MechanismCheck& check);

/// The first drive's value as people read it: "137.87°", within a turn of a full-turn motion from 0; "12.5
/// mm".
std::string drive_text(const MechanismCheck& check, double value);

}  // namespace oblique::report
