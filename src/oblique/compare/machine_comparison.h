// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <oblique/compare/compare.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::compare {

/// What one published figure of a machine does to one kind of element, with all else ideal.
struct FigureError {
  std::string figure;  ///< MachineFigure::name
  std::string block;   ///< on which it acts: "servo-amplifier"
  double alone = 0;  ///< largest distance of any moving point from where ideal elements have it [length unit]
  double share = 0;  ///< of the machine's largest error: at that point and time, along it [length unit]
};

/// A mechanism on a machine, against the exact motion and against the same elements without errors.
struct MachineComparison {
  std::string machine;  ///< MachineProfile::title
  std::vector<std::string>
      absent;  ///< kinds of elements that it needs and the machine has none of: ideal ones
  std::vector<std::string> scatter;  ///< figures that say how single elements scatter: not in this
  double max_error = 0;   ///< of the machine: largest distance of any moving point from its exact place
                          ///< [length unit]
  double rms_error = 0;   ///< root of the mean square of these distances [length unit]
  double from_ideal = 0;  ///< largest distance from where ideal elements have it [length unit]
  double ideal_error =
      0;             ///< largest distance of the ideal elements' points from the exact ones [length unit]
  WorstPlace worst;  ///< of max_error, without a reason
  double ideal_share = 0;            ///< of max_error: what the method leaves on ideal elements [length unit]
  std::vector<FigureError> figures;  ///< those that act on its blocks, in the order of the profile
  std::vector<Overload> overloads;   ///< of the machine
  bool stable = true;                ///< every servo loop of the machine, at every tenth row

  /// The part of max_error that the method and the figures alone add up to: 1 where errors do not act on each
  /// other.
  double explained() const;
};

/// Puts a mechanism's patch into a machine's elements and runs it over one turn: with all figures of the
/// profile, with none, and with each alone on one kind of block. There are as many elements as it takes.
/// Scatter is not in it (see `monte_carlo`). `options.gain` is that of ideal servo amplifiers. A run that
/// takes a hundred times the steps of the one on ideal elements has failed. Throws as `patch`, `realise`, and
/// as `run` with the figure in the message.
MachineComparison compare_on_machine(const mechanism::Mechanism& whole, const diagram::BlockLibrary& library,
                                     const diagram::MachineProfile& machine,
                                     const patch::PatchOptions& options,
                                     const std::function<void(double)>& progress = {});

/// A diagram in the elements of a machine (`machine::realise`) against `reference`, the run of its ideal self
/// with as many rows: errors are those of its outputs over the largest value that each has there, and
/// `worst.point` is the output. Otherwise the same. Throws as `run` with the figure in the message.
MachineComparison compare_on_machine(const solve::Trajectory& reference, diagram::Diagram realised,
                                     const diagram::BlockLibrary& library,
                                     const diagram::MachineProfile& machine,
                                     const std::function<void(double)>& progress = {});

}  // namespace oblique::compare
