// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>

namespace oblique::network {

/// The parameters of a compiled program as somebody turns them.
///
/// Compilation decides by the values of constants what of the equations can be left out: 0·x, x + 0, 1·x. It
/// has kept how each of these constants follows from parameters. Here they are computed anew, only those that
/// follow from what was turned, and where all that was decided by them still holds, the program with the new
/// numbers is the one that would be compiled.
class ParameterSetting {
 public:
  /// As the program was compiled.
  explicit ParameterSetting(const Program& program);

  struct Parameter {
    std::uint32_t number;  ///< as ParameterNumbers has it
    double value;
  };
  /// Sets some. False, and as before, where the program would be another one and must be compiled.
  bool set(std::span<const Parameter> parameters);
  /// The same of a program that holds for them all the same, because it was compiled beside them: only what
  /// was decided by exact values is looked at.
  bool set_beside(std::span<const Parameter> parameters);

 private:
  friend class Program;
  void write(std::vector<double>& slots) const;
  bool set(std::span<const Parameter> parameters, bool kinds_count);
  bool holds(std::uint32_t constant, bool kinds_count) const;
  const std::vector<std::uint32_t>& followers(std::uint32_t leaf);

  std::shared_ptr<const ProgramCode> code_;
  std::vector<double> values_;                     ///< of all constants
  std::vector<std::uint32_t> leaf_;                ///< of each parameter its constant
  std::vector<std::vector<std::uint32_t>> users_;  ///< of each constant: those that need it
  std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> followers_;  ///< of leaves that were set: all
  std::vector<std::pair<std::uint32_t, double>> was_;                        ///< what is put back
};

}  // namespace oblique::network
