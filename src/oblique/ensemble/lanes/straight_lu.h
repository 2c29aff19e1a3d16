// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <oblique/ensemble/lanes/lane_code.h>

// Not installed.
namespace oblique::ensemble {

/// The largest multiplier at which the order of pivots still suits a matrix.
inline constexpr double kMostGrowth = 1e6;

/// An LU factorisation of sparse matrices of one pattern without a choice in it: which pivot comes when, and
/// what fills in, is fixed by samples, so that it runs as a straight line in all lanes. Each pivot is the
/// entry that fills in least (Markowitz) among those that are no less than a tenth of the largest in their
/// column, in every sample.
class StraightLu {
 public:
  using Place = std::pair<std::uint32_t, std::uint32_t>;  ///< row, column

  /// `entries`: all places of the pattern. `samples`: matrices as the values of these entries. Nothing where
  /// there is no order that suits all samples.
  static std::optional<StraightLu> make(std::uint32_t n, std::span<const Place> entries,
                                        std::span<const std::vector<double>> samples);

  StraightLuCode code() const { return {n_, factor_.data(), forward_.data(), backward_.data()}; }
  /// Entries of the array, the given ones first, then those that fill in.
  std::uint32_t n_entries() const { return n_entries_; }

 private:
  std::uint32_t n_ = 0, n_entries_ = 0;
  std::vector<std::uint32_t> factor_, forward_, backward_;
};

}  // namespace oblique::ensemble
