// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "block_kinds.h"
#include "dice.h"

namespace oblique::fuzz {

/// weight · an output of another block.
struct Wire {
  double weight = 1;
  std::size_t block = 0, output = 0;
};

struct PlannedBlock {
  const BlockKind* kind = nullptr;
  std::vector<std::pair<const PortKind*, std::vector<Wire>>> inputs;
  std::vector<std::pair<const ParameterKind*, double>> parameters;
};

struct PlannedPhase {
  std::size_t mode = 0;  ///< operate, hold, initial
  double length = 1;     ///< [s]
};

/// A diagram before its blocks have names, an order and a scale.
struct DiagramPlan {
  std::vector<PlannedBlock> blocks;
  std::string profile = "ideal";
  bool inverting = false, settle = true;
  double until = 1;  ///< [s]
  double tolerance = 1e-8;
  std::string method = "auto";
  std::optional<double> max_step, absolute_tolerance;
  std::vector<PlannedPhase> phases;  ///< of a timeline; none: it operates throughout
  std::size_t cycles = 1;
};

/// Any bytes make a diagram: random blocks, wired at random forwards and back, with algebraic loops and
/// blocks that nothing uses.
DiagramPlan plan_diagram(Dice& dice);

/// How a plan is written. None of these changes what the diagram does, but for `disturbance` and `offset`;
/// values and times are scaled by powers of two, which is exact.
struct Writing {
  enum class Names { rising, falling };
  Names names = Names::rising;
  std::vector<std::size_t> order;  ///< of the blocks in the file; empty: as planned
  double value = 1, time = 1;
  double disturbance = 0;   ///< relative, of every number, with random signs
  double offset = 0;        ///< [machine unit] of what comparisons read, with random signs
  std::uint32_t signs = 1;  ///< that choose them
  double samples = 41;      ///< rows
};

/// Whether scaling the values is exact: not where a machine's errors have a scale of their own, nor where the
/// noise gain of a real amplifier follows weights that would have to change.
bool can_be_scaled(const DiagramPlan& plan);

/// The diagram's file. Its outputs are in the order of the plan, and are scaled back.
std::string text_of(const DiagramPlan& plan, const Writing& writing = {});

}  // namespace oblique::fuzz
