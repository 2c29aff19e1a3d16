// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/straight_lu.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::ensemble {
namespace {

constexpr double kThreshold = 0.1;
constexpr double kLeast = 1e-6;  ///< of the largest in its column: below, no pivot suits all samples
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The elimination of all samples at once.
class Elimination {
 public:
  Elimination(std::uint32_t n, std::span<const StraightLu::Place> entries,
              std::span<const std::vector<double>> samples)
      : n_(n),
        place_(std::size_t{n} * n, kNone),
        values_(samples.begin(), samples.end()),
        row_done_(n),
        column_done_(n) {
    for (std::uint32_t k = 0; k < entries.size(); ++k) place(entries[k].first, entries[k].second) = k;
    n_entries_ = static_cast<std::uint32_t>(entries.size());
  }

  std::uint32_t& place(std::uint32_t row, std::uint32_t column) {
    return place_[std::size_t{row} * n_ + column];
  }
  bool is_there(std::uint32_t row, std::uint32_t column) { return place(row, column) != kNone; }
  std::uint32_t n_entries() const { return n_entries_; }

  /// The next pivot; nothing where none suits.
  std::optional<StraightLu::Place> choose() {
    std::vector<std::uint32_t> in_row(n_), in_column(n_);
    for (std::uint32_t i = 0; i < n_; ++i) {
      for (std::uint32_t j = 0; j < n_; ++j) {
        if (row_done_[i] || column_done_[j] || !is_there(i, j)) continue;
        ++in_row[i];
        ++in_column[j];
      }
    }
    std::optional<StraightLu::Place> best, largest;
    std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
    double best_part = 0, largest_part = 0;
    for (std::uint32_t j = 0; j < n_; ++j) {
      if (column_done_[j]) continue;
      std::vector<double> most(values_.size(), 0);
      for (std::uint32_t i = 0; i < n_; ++i) {
        if (row_done_[i] || !is_there(i, j)) continue;
        for (std::size_t s = 0; s < values_.size(); ++s)
          most[s] = std::max(most[s], std::abs(values_[s][place(i, j)]));
      }
      for (std::uint32_t i = 0; i < n_; ++i) {
        if (row_done_[i] || !is_there(i, j)) continue;
        double part = 1;  // of the largest, in the worst sample
        for (std::size_t s = 0; s < values_.size(); ++s) {
          const double size = std::abs(values_[s][place(i, j)]);
          part = std::min(part, most[s] > 0 ? size / most[s] : 0);
        }
        if (part > largest_part) {
          largest_part = part;
          largest = {i, j};
        }
        if (part < kThreshold) continue;
        const std::uint64_t fill = std::uint64_t{in_row[i] - 1} * (in_column[j] - 1);
        if (fill > least || (fill == least && part <= best_part)) continue;
        least = fill;
        best_part = part;
        best = {i, j};
      }
    }
    if (best) return best;
    if (largest_part > kLeast) return largest;
    return std::nullopt;
  }

  /// Eliminates below a pivot.
  void eliminate(std::uint32_t row, std::uint32_t column) {
    row_done_[row] = column_done_[column] = true;
    for (std::uint32_t i = 0; i < n_; ++i) {
      if (row_done_[i] || !is_there(i, column)) continue;
      for (std::uint32_t j = 0; j < n_; ++j) {
        if (column_done_[j] || !is_there(row, j)) continue;
        if (!is_there(i, j)) {
          place(i, j) = n_entries_++;
          for (std::vector<double>& sample : values_) sample.push_back(0);
        }
        for (std::vector<double>& sample : values_)
          sample[place(i, j)] -=
              sample[place(i, column)] / sample[place(row, column)] * sample[place(row, j)];
      }
    }
  }

  bool row_done(std::uint32_t i) const { return row_done_[i]; }
  bool column_done(std::uint32_t j) const { return column_done_[j]; }

 private:
  std::uint32_t n_, n_entries_ = 0;
  std::vector<std::uint32_t> place_;
  std::vector<std::vector<double>> values_;
  std::vector<bool> row_done_, column_done_;
};

}  // namespace

std::optional<StraightLu> StraightLu::make(std::uint32_t n, std::span<const Place> entries,
                                           std::span<const std::vector<double>> samples) {
  Elimination elimination(n, entries, samples);
  StraightLu lu;
  lu.n_ = n;
  std::vector<Place> pivots;
  std::vector<std::uint32_t> pivot_of_column(n, kNone);
  for (std::uint32_t k = 0; k < n; ++k) {
    const std::optional<Place> pivot = elimination.choose();
    if (!pivot) return std::nullopt;
    const auto [row, column] = *pivot;
    elimination.eliminate(row, column);
    std::vector<std::uint32_t> columns, rows;
    for (std::uint32_t j = 0; j < n; ++j) {
      if (!elimination.column_done(j) && elimination.is_there(row, j)) columns.push_back(j);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      if (!elimination.row_done(i) && elimination.is_there(i, column)) rows.push_back(i);
    }
    lu.factor_.push_back(elimination.place(row, column));
    lu.factor_.push_back(static_cast<std::uint32_t>(rows.size()));
    lu.factor_.push_back(static_cast<std::uint32_t>(columns.size()));
    for (const std::uint32_t j : columns) lu.factor_.push_back(elimination.place(row, j));
    for (const std::uint32_t i : rows) {
      lu.factor_.push_back(elimination.place(i, column));
      for (const std::uint32_t j : columns) lu.factor_.push_back(elimination.place(i, j));
    }
    pivot_of_column[column] = k;
    pivots.push_back(*pivot);
  }
  lu.n_entries_ = elimination.n_entries();
  const auto add = [&](std::vector<std::uint32_t>& code, std::uint32_t index, std::uint32_t k, bool left) {
    code.push_back(index);
    const std::size_t count = code.size();
    code.push_back(0);
    for (std::uint32_t j = 0; j < n; ++j) {
      const std::uint32_t other = pivot_of_column[j];
      if (!elimination.is_there(pivots[k].first, j) || other == k || (other < k) != left) continue;
      code.push_back(elimination.place(pivots[k].first, j));
      code.push_back(other);
      ++code[count];
    }
  };
  for (std::uint32_t k = 0; k < n; ++k) add(lu.forward_, pivots[k].first, k, true);
  for (std::uint32_t k = n; k-- > 0;) add(lu.backward_, pivots[k].second, k, false);
  return lu;
}

}  // namespace oblique::ensemble
