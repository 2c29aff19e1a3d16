// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/rescale.h>
#include <oblique/machine/bill.h>
#include <oblique/solve/stability/analysis.h>

#include "command.h"

namespace oblique::cli {

/// A proposal that needs a trial run which came to its end.
struct ScalingProposal {
  diagram::AmplitudeScaling blocks;
  std::vector<double> signals;  ///< the factor of every signal of the program
  /// By how much to slow the scaled diagram down, in 1-2-5 steps, so that no integrator of k0 = 1/s is fed
  /// with more than 1 machine unit: 1 s of the diagram in so many seconds of the machine.
  double time_scale = 1;
};

/// A diagram without the saturation of its machine.
struct Unsaturated {
  network::Program program;
  solve::Analysis analysis;
};

/// All that `oblique check` finds out about a diagram.
struct DiagramCheck {
  std::string file;
  const diagram::Diagram& diagram;
  const diagram::FlatDiagram& flat;
  const network::Program& program;
  solve::Analysis analysis;
  std::optional<ScalingProposal> scaling;
  std::optional<machine::Bill> bill;  ///< on the machine that the diagram is for; none for the ideal one
  /// Of the same diagram where no amplifier saturates, if it comes to its end: how far signals would go. Only
  /// where one leaves the machine unit on a machine that saturates.
  std::optional<Unsaturated> unsaturated;

  /// What overloads and scales are judged by.
  const solve::Analysis& in_full() const { return unsaturated ? unsaturated->analysis : analysis; }
};

/// The report for people: what the diagram is made of, then loops, stability, overloads, scaling.
std::string to_text(const DiagramCheck& check);

/// The same as JSON, with numbers in full.
std::string to_json(const DiagramCheck& check);

/// "grows", "undamped", "badly damped", "well damped".
std::string_view verdict_name(solve::ModeVerdict verdict);
/// "no feedback", "stable", "stable when frozen", "undamped", "grows", "grows at times",
/// "servo loops unstable", "not told".
std::string_view verdict_name(solve::StabilityVerdict verdict);
/// "linear", "varying", "non-linear".
std::string_view kind_name(solve::LoopKind kind);

/// `text` is what the file holds.
ExitStatus check_diagram(const Session& session, const CheckRequest& request, const std::string& text);

}  // namespace oblique::cli
