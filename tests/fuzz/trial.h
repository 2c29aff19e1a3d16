// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

#include <oblique/diagram/diagram.h>
#include <oblique/solve/run.h>

namespace oblique::fuzz {

/// How the way from a text to a trajectory ended.
struct Trial {
  enum class End {
    clean,        ///< without a warning: the run stands for its numbers
    warned,       ///< it says what it may not have seen
    refused,      ///< an exception of a stage
    over_budget,  ///< longer than a trial may take: it tells nothing
    broken,       ///< in a way that no run may end
  };
  End end = End::broken;
  std::string says;     ///< the stage and kind of a refusal, the warnings without their numbers and names; or
                        ///< how it is broken
  std::string message;  ///< in full
  std::optional<solve::Run> run;
};

/// What a trial changes of the options in the text.
struct TrialOptions {
  std::optional<diagram::IntegrationMethod> method;
  std::optional<double> tolerance;
  std::optional<double> until;
  std::optional<int> samples;
  std::optional<solve::RunState> from;
};

/// Reads, flattens, assembles and runs the text of a diagram, within a budget of steps, and looks at all that
/// comes out: numbers that are none, empty messages and exceptions of no stage are `broken`.
Trial try_diagram(const std::string& text, const TrialOptions& options = {});
Trial try_diagram(const diagram::Diagram& diagram, const TrialOptions& options = {});

}  // namespace oblique::fuzz
