// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <oblique/ensemble/study/levels.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/ensemble/study/sequences.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// Which values the machines of a plan have, by their numbers.
///
/// Of a grid the last name changes fastest, and where elements scatter, each combination has `runs` machines
/// (else 1) one after the other. The k-th machine of every combination draws alike, so that what the varied
/// names do stands out of the scatter. Otherwise there are `runs` machines altogether, each draws by itself.
class Combinations {
 public:
  Combinations() = default;
  /// Of levels that make sense (checked by the study).
  Combinations(std::vector<Levels> levels, Sampling sampling, std::optional<std::uint64_t> runs,
               std::uint64_t seed);

  std::uint64_t runs() const { return runs_; }
  /// The values of the names.
  void values(std::uint64_t number, std::span<double> values) const;
  /// The number by which a machine draws.
  std::uint64_t draw_number(std::uint64_t number) const { return number % repeats_; }

 private:
  std::vector<Levels> levels_;
  Sampling sampling_ = Sampling::grid;
  std::uint64_t repeats_ = 1, runs_ = 0;
  std::optional<LatinHypercube> hypercube_;
};

/// Of a grid: so many combinations, or nothing where they are more than can be counted.
std::optional<std::uint64_t> grid_size(std::span<const Levels> levels);

}  // namespace oblique::ensemble
