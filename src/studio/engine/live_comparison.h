// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/compare/compare.h>
#include <oblique/mechanism/model/mechanism.h>

#include "studio/engine/answer.h"
#include "studio/engine/engine.h"

namespace oblique::studio {

/// The errors of a patch over the gain of its amplifiers, gain after gain. As the functions of Engine its own
/// throw nothing; before `open` has succeeded they refuse.
class LiveComparison {
 public:
  /// The engine must outlive it.
  explicit LiveComparison(const Engine& engine) : engine_(engine) {}

  /// A mechanism in place of the one before, without any run: {"unit", "size"}. Options: "bandwidth",
  /// "slower", "method", "split" as Engine::patch has them.
  Answer open(const std::string& text, const std::string& name, const std::string& options);

  /// Runs it at a gain over its motion, in place of an earlier run of the same gain: {"runs": [{"gain",
  /// "max_error", "rms_error", "static", "lag", "solver": parts of the largest one, null where they are not
  /// known, "worst": its point, "steps", "overloads", "stable", "off_branch"}] in the order of the gains,
  /// "order": of those above "floor", what the tolerance leaves; each null where it is not known; "svg"}.
  Answer add(double gain);

 private:
  const Engine& engine_;
  std::optional<mechanism::Mechanism> mechanism_;
  compare::CompareOptions options_;
  compare::Comparison all_;
};

}  // namespace oblique::studio
