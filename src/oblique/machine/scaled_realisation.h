// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::machine {

struct ScalingOptions {
  std::optional<double>
      time;           ///< 1 s of the diagram in so many seconds of the machine; else as the machine asks
  int segments = 10;  ///< straight lines of a function generator, at the most
};

/// What an element of a machine stands for.
struct SignalScale {
  std::string signal;  ///< of the realised diagram; minus_… carries the negative
  double unit = 1;     ///< 1 machine unit there stands for so many of the diagram's
  double largest = 0;  ///< the greatest magnitude over the run, with ideal elements [machine unit]
};

/// A function that a function generator is set for.
struct GeneratedFunction {
  std::string signal;  ///< of the diagram
  std::string block;   ///< its kind there: "cosine"
  int segments = 0;
  double low = 0, high = 0;  ///< of its argument, in the diagram's units
  double error = 0;          ///< greatest distance of the straight lines from it, in the diagram's units
};

/// A diagram in the elements of a machine and in its scale.
struct ScaledRealisation {
  diagram::Diagram diagram;
  double time = 1;  ///< 1 s of the diagram takes so many seconds here
  std::vector<SignalScale> scales;
  std::vector<GeneratedFunction> functions;
};

/// Puts any diagram into a machine's elements so that its signals use most of the machine unit.
///
/// A diagram is run on ideal elements, where nothing saturates; functions of one signal or of time become
/// function generators (`tabulate_functions`), other blocks that no machine has circuits that do the same
/// (`element_library`); then it is reduced to active elements, these are scaled by their peaks
/// (`choose_scaling`), and written as `realise` does. With ideal elements its outputs are what they were, at
/// `time` times the moments, but for the errors of the function generators.
class MachineScaling {
 public:
  /// Throws RealiseError for modes that the machine has not, and blocks that neither are an element nor
  /// become a circuit of some, all in one go; solve::SolveError where the diagram does not run.
  MachineScaling(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                 const diagram::MachineProfile& machine, const ScalingOptions& options);
  ~MachineScaling();
  MachineScaling(const MachineScaling&) = delete;
  MachineScaling& operator=(const MachineScaling&) = delete;

  /// With servo amplifiers `loop_speed` (at most 1) times as fast as the diagram's.
  ScaledRealisation realise(double loop_speed = 1) const;

  /// Takes note of how far the signals of `realised` go on real elements: further ones get more room, up to
  /// twice as much as they need on ideal ones. By how much the farthest leaves the machine unit, 0 where all
  /// stay within it. Throws solve::SolveError where they do not run within `most_steps`.
  double make_room(const ScaledRealisation& realised, std::int64_t most_steps);

 private:
  class State;
  std::unique_ptr<State> state_;
};

/// The same at once, on ideal elements.
ScaledRealisation realise_scaled(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine, const ScalingOptions& options = {});

}  // namespace oblique::machine
