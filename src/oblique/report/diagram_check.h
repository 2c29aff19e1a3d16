// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/propose_scaling.h>
#include <oblique/diagram/rescale.h>
#include <oblique/machine/component_list.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/stability/analysis.h>

namespace oblique::report {

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

/// All that a check finds out about a diagram.
struct DiagramCheck {
  std::string file;
  const diagram::Diagram& diagram;
  const diagram::FlatDiagram& flat;
  const network::Program& program;
  solve::Analysis analysis;
  std::optional<ScalingProposal> scaling;
  std::optional<machine::ComponentList>
      components;  ///< on the machine that the diagram is for; none for the ideal one
  /// Of the same diagram where no amplifier saturates, if it comes to its end: how far signals would go. Only
  /// where one leaves the machine unit on a machine that saturates.
  std::optional<Unsaturated> unsaturated;

  /// What overloads and scales are judged by.
  const solve::Analysis& in_full() const { return unsaturated ? unsaturated->analysis : analysis; }
};

/// Runs a diagram on trial and looks at its loops, its stability, its overloads and its scales. The check
/// refers to what it is made of. A run that fails is told in `analysis`. Throws solve::SolveError where not
/// even that is known.
DiagramCheck examine(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                     const network::Program& program, const std::function<void(double fraction)>& progress);

/// A diagram in scaled signals, after a run of it: it is to give what the other one gave.
struct ScaledDiagram {
  diagram::Diagram diagram;
  double difference = 0;  ///< the largest of an output, over its size
  std::size_t overloads = 0;
};

/// By the proposal of a check, which must have one. Throws solve::SolveError.
ScaledDiagram scaled_by(const DiagramCheck& check, const diagram::BlockLibrary& library);

}  // namespace oblique::report
