// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/ensemble/lanes/lane_tape.h>
#include <oblique/ensemble/lanes/straight_lu.h>
#include <oblique/network/program/parameter_prologue.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

// Not installed.
namespace oblique::ensemble {

/// A constant of a lane that follows from what the machine has drawn.
struct LaneConstant {
  std::uint32_t drawn;  ///< in what the prologue gives
  std::uint32_t slot;
};

/// Slots on which a tape runs: t, the variables, then constants and results.
struct LaneSpace {
  std::vector<double> slots;  ///< what they hold in every lane before a machine comes
  std::vector<LaneConstant> constants;
};

/// A number of a machine: that of all, or one that follows from what it has drawn.
struct LaneNumber {
  double value = 0;
  std::optional<std::uint32_t> drawn;

  double of(std::span<const double> draws) const { return drawn ? draws[*drawn] : value; }
};

/// Servo loops that act on each other, and their part of ∂F/∂u.
struct RestGroup {
  struct Entry {
    std::uint32_t place;  ///< in the matrix
    std::uint32_t row, column;
  };
  std::uint32_t size = 0;
  std::vector<Entry> entries = {};
};

/// All that the lanes of an ensemble have in common: the equations with the varied parameters held, as tapes,
/// the matrix, its factors in a straight line, where a machine starts. Immutable.
struct LaneProgram {
  std::size_t n_states = 0, n_variables = 0;
  std::optional<network::ParameterPrologue> prologue;

  LaneSpace integration, output;
  LaneTape rates, derivatives, outputs;
  std::vector<std::uint32_t> rate_slots, output_slots;  ///< in their spaces
  std::vector<std::uint32_t> signal_slots;              ///< of what is watched, in the space of the outputs
  bool bound_to_unit = false;                           ///< signals are to stay within the machine unit
  std::vector<LaneConstant> by_time;                    ///< row, slot

  std::vector<std::uint32_t> matrix_steps, diagonal;
  /// What entries of rows are that are not solved for before the clock starts.
  std::vector<std::pair<std::uint32_t, double>> fixed_entries;
  StraightLu lu;
  bool is_explicit = false;  ///< nothing is stiff: an explicit method, without matrix and LU
  LaneMatrixCode matrix() const {
    return {lu.n_entries(), static_cast<std::uint32_t>(matrix_steps.size() / 2), matrix_steps.data(),
            static_cast<std::uint32_t>(n_states), diagonal.data()};
  }

  std::vector<bool> grows;         ///< of the states: its rate depends on a state
  std::vector<LaneNumber> starts;  ///< of the states
  std::vector<double> guess;       ///< of all variables: the start of the diagram as it is
  std::vector<bool> at_rest;       ///< of all variables: those that are solved for before the clock starts
  bool needs_rest = false;         ///< any of them
  std::vector<RestGroup> rest_groups;  ///< of the servo loops that are brought to rest
  std::vector<LaneNumber> turning;     ///< how fast arguments of sines and cosines of the time go [1/s]

  std::vector<double> absolute;  ///< tolerance of each variable
  double relative = 0;
  double until = 0, max_step = 0;  ///< [s]
  int rows = 0;
  std::size_t most_steps = 0;
  std::vector<std::pair<double, double>> scale_and_offset;  ///< of the outputs
};

/// Made for lanes, or why it cannot be.
struct LaneCompilation {
  std::unique_ptr<const LaneProgram> program;
  std::string why_not;
};

/// Compiles a typical machine for lanes. It is run once by CVODES: lanes are for what that run has no warning
/// of and no events in.
LaneCompilation compile_for_lanes(const diagram::FlatDiagram& diagram, std::span<const std::uint32_t> varied,
                                  const solve::RunOptions& options);

}  // namespace oblique::ensemble
