// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>

namespace oblique::diagram {

/// An output of a flat block: indices into FlatDiagram::blocks and BlockDefinition::outputs.
struct SignalRef {
  std::size_t block = 0;
  std::size_t output = 0;
  bool operator==(const SignalRef&) const = default;
};

/// weight · signal at an input.
struct FlatTerm {
  double weight = 1;
  SignalRef signal;
};

/// What arrives at one input: the sum of its terms plus a constant (the default of an unconnected input).
struct FlatInput {
  std::vector<FlatTerm> terms;
  double constant = 0;
};

/// A primitive block with everything about it decided but its place in the equations.
struct FlatBlock {
  std::string path;  ///< "C.direction.length": the names of the composites around it
  const BlockDefinition* definition = nullptr;  ///< in the library given to `flatten`
  const Behaviour* behaviour = nullptr;         ///< the case that its parameters select
  /// That case with the block's formulas in it, where it has some: `behaviour` points to it. It never
  /// changes, so copies of the block share it.
  std::shared_ptr<const Behaviour> own_behaviour;
  std::vector<double> parameters;         ///< in the order of the definition
  std::optional<std::size_t> saturation;  ///< the parameter that the machine's saturation gives its value
  std::vector<text::PointTable> points;   ///< of the parameters that are functions; else empty ones
  std::map<std::string, text::Expression> formulas;  ///< of the parameters that are expressions of time
  std::vector<FlatInput> inputs;                     ///< in the order of the definition
  double polarity = 1;                               ///< −1 where summers and integrators invert
  double tolerance = 0;   ///< absolute, of its states [machine unit]; 0: that of the run
  std::size_t group = 0;  ///< of FlatTimeline::groups
  text::Place place;      ///< of the block of the diagram that it is or is a part of

  /// Takes the case that the parameters select, with the formulas in it: to be called where one has changed.
  void choose_behaviour();
};

/// A column of the trajectory.
struct FlatOutput {
  std::string name;
  SignalRef signal;
  double scale = 1;
  std::string unit;
  double offset = 0;
};

/// A comparison of a signal with a number.
struct FlatCondition {
  SignalRef signal;
  bool above = true;  ///< signal > threshold, else signal < threshold
  double threshold = 0.5;
};

/// A group of blocks with a mode line of its own.
struct FlatGroup {
  std::string name;
  std::optional<SignalRef> initial, hold;
};

struct FlatPhase {
  std::vector<OperatingMode> modes;  ///< of each group
  double duration = 0;               ///< [s]
  std::optional<FlatCondition> until;
};

/// Phases and groups with all names resolved. The first group holds what stands in no other; without groups
/// and phases there is none, and everything operates all the time.
struct FlatTimeline {
  std::vector<FlatGroup> groups;
  std::vector<FlatPhase> phases;
  double cycles = 1;
};

/// A diagram of primitive blocks, all names resolved. Refers to the definitions of the library it was made
/// with.
struct FlatDiagram {
  std::string file;
  std::vector<FlatBlock> blocks;
  FlatTimeline timeline;
  std::vector<FlatOutput>
      outputs;  ///< those of `[outputs]`; every signal of the top level where there are none

  /// "path" for a block of one output, "path.port" for others.
  std::string signal_name(SignalRef signal) const;
};

/// The same diagram where no amplifier saturates because its machine does.
FlatDiagram without_saturation(FlatDiagram diagram);

}  // namespace oblique::diagram
