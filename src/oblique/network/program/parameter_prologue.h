// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::network {

/// What varied parameters make of the constants of a program: computed as a short tape, for any number of
/// machines, where ParameterSetting follows one machine as it is turned. Immutable.
class ParameterPrologue {
 public:
  /// `varied`: numbers of parameters, as ParameterNumbers has them. The program was made of a network in
  /// which they are held.
  ParameterPrologue(const Program& program, std::span<const std::uint32_t> varied);

  /// The slots whose values it gives.
  const std::vector<std::uint32_t>& slots() const { return slots_; }
  /// Scratch that `run` needs.
  std::size_t scratch_size() const { return values_.size(); }
  /// Gives `out` the values of `slots` for these values of the varied parameters. False where the program
  /// would be another one: a choice between cases falls out otherwise.
  bool run(std::span<const double> varied, std::span<double> scratch, std::span<double> out) const;

 private:
  struct Step {
    Op op;
    std::uint32_t a, b, result;
  };
  struct Held {
    std::uint32_t constant;
    Decided decided;
  };
  std::vector<double> values_;         ///< of all constants, as compiled
  std::vector<std::uint32_t> leaves_;  ///< of each varied parameter its constant, or none
  std::vector<Step> steps_;
  std::vector<Held> decided_;  ///< constants that decide something
  std::vector<std::uint32_t> slots_, slot_constants_;
};

}  // namespace oblique::network
