// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/step_matrix.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <new>
#include <stdexcept>
#include <vector>

#include <klu.h>

namespace oblique::solve {
namespace {

/// Below this order, or with more than this part of the entries, full rows are faster than lists of entries.
constexpr std::size_t kSmallMatrix = 16;
constexpr double kFull = 0.5;

/// Reciprocal growth of the entries by factorising with the pivots of another matrix: below it they are
/// chosen anew.
constexpr double kLeastReciprocalGrowth = 1e-4;

}  // namespace

class StepMatrix::Factors {
 public:
  virtual ~Factors() = default;
  virtual bool factorise(std::span<const double> jacobian, double shift) = 0;
  virtual void solve(std::span<double> b) = 0;
};

/// Rows in one array, pivots chosen in each column.
class StepMatrix::DenseFactors final : public Factors {
 public:
  explicit DenseFactors(const network::SparsePattern& pattern)
      : n_(pattern.size()), entries_(n_ * n_), columns_(n_ * n_), reciprocals_(n_), pivots_(n_) {
    for (std::size_t column = 0; column < n_; ++column) {
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k)
        places_.push_back(static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)]) * n_ + column);
    }
  }

  bool factorise(std::span<const double> jacobian, double shift) override {
    std::fill(entries_.begin(), entries_.end(), 0.0);
    for (std::size_t k = 0; k < places_.size(); ++k) entries_[places_[k]] -= jacobian[k];
    for (std::size_t i = 0; i < n_; ++i) entries_[i * n_ + i] += shift;
    for (std::size_t k = 0; k < n_; ++k) {
      std::size_t best = k;
      for (std::size_t i = k + 1; i < n_; ++i) {
        if (std::abs(at(i, k)) > std::abs(at(best, k))) best = i;
      }
      pivots_[k] = best;
      if (best != k) std::swap_ranges(row(k), row(k) + n_, row(best));
      const double pivot = at(k, k);
      if (pivot == 0 || !std::isfinite(pivot)) return false;
      reciprocals_[k] = 1 / pivot;
      const double* const from = row(k);
      for (std::size_t i = k + 1; i < n_; ++i) {
        double* const to = row(i);
        if (to[k] == 0) continue;
        const double multiplier = to[k] *= reciprocals_[k];
        for (std::size_t j = k + 1; j < n_; ++j) to[j] -= multiplier * from[j];
      }
    }
    for (std::size_t i = 0; i < n_; ++i) {
      for (std::size_t j = 0; j < n_; ++j) columns_[j * n_ + i] = at(i, j);
    }
    return true;
  }

  void solve(std::span<double> b) override {
    for (std::size_t k = 0; k < n_; ++k) std::swap(b[k], b[pivots_[k]]);
    for (std::size_t k = 0; k < n_; ++k) {
      const double* const of = columns_.data() + k * n_;
      const double by = b[k];
      for (std::size_t i = k + 1; i < n_; ++i) b[i] -= of[i] * by;
    }
    for (std::size_t k = n_; k-- > 0;) {
      const double* const of = columns_.data() + k * n_;
      const double by = b[k] *= reciprocals_[k];
      for (std::size_t i = 0; i < k; ++i) b[i] -= of[i] * by;
    }
  }

 private:
  double* row(std::size_t i) { return entries_.data() + i * n_; }
  double at(std::size_t i, std::size_t j) const { return entries_[i * n_ + j]; }

  std::size_t n_;
  std::vector<double> entries_, columns_, reciprocals_;
  std::vector<std::size_t> pivots_, places_;
};

class StepMatrix::SparseFactors final : public Factors {
 public:
  explicit SparseFactors(const network::SparsePattern& pattern) {
    const std::size_t n = pattern.size();
    starts_.push_back(0);
    for (std::size_t column = 0; column < n; ++column) {
      const auto diagonal = static_cast<std::int64_t>(column);
      bool has_diagonal = false;
      const auto add_diagonal = [&] {
        diagonals_.push_back(rows_.size());
        has_diagonal = true;
      };
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const std::int64_t row = pattern.rows[static_cast<std::size_t>(k)];
        if (!has_diagonal && row >= diagonal) {
          add_diagonal();
          if (row > diagonal) rows_.push_back(diagonal);
        }
        places_.push_back(rows_.size());
        rows_.push_back(row);
      }
      if (!has_diagonal) {
        add_diagonal();
        rows_.push_back(diagonal);
      }
      starts_.push_back(static_cast<std::int64_t>(rows_.size()));
    }
    values_.resize(rows_.size());
    klu_l_defaults(&common_);
    symbolic_ = klu_l_analyze(static_cast<std::int64_t>(n), starts_.data(), rows_.data(), &common_);
    check_memory();
    if (symbolic_ == nullptr) throw std::logic_error("KLU refuses the pattern of a Jacobian");
  }
  ~SparseFactors() override {
    klu_l_free_numeric(&numeric_, &common_);
    klu_l_free_symbolic(&symbolic_, &common_);
  }
  SparseFactors(const SparseFactors&) = delete;
  SparseFactors& operator=(const SparseFactors&) = delete;

  bool factorise(std::span<const double> jacobian, double shift) override {
    std::fill(values_.begin(), values_.end(), 0.0);
    for (std::size_t k = 0; k < places_.size(); ++k) values_[places_[k]] -= jacobian[k];
    for (const std::size_t diagonal : diagonals_) values_[diagonal] += shift;
    if (numeric_ != nullptr && refactorise()) return true;
    klu_l_free_numeric(&numeric_, &common_);
    numeric_ = klu_l_factor(starts_.data(), rows_.data(), values_.data(), symbolic_, &common_);
    check_memory();
    return numeric_ != nullptr && common_.status == KLU_OK;
  }

  void solve(std::span<double> b) override {
    klu_l_solve(symbolic_, numeric_, symbolic_->n, 1, b.data(), &common_);
  }

 private:
  void check_memory() const {
    if (common_.status == KLU_OUT_OF_MEMORY) throw std::bad_alloc();
  }

  bool refactorise() {
    if (klu_l_refactor(starts_.data(), rows_.data(), values_.data(), symbolic_, numeric_, &common_) == 0 ||
        common_.status != KLU_OK)
      return false;
    return klu_l_rgrowth(starts_.data(), rows_.data(), values_.data(), symbolic_, numeric_, &common_) != 0 &&
           common_.rgrowth > kLeastReciprocalGrowth;
  }

  std::vector<std::int64_t> starts_, rows_;
  std::vector<std::size_t> places_, diagonals_;  ///< of J's entries, and of the diagonal
  std::vector<double> values_;
  klu_l_common common_{};
  klu_l_symbolic* symbolic_ = nullptr;
  klu_l_numeric* numeric_ = nullptr;
};

StepMatrix::StepMatrix(const network::SparsePattern& pattern) {
  const auto n = static_cast<double>(pattern.size());
  if (pattern.size() <= kSmallMatrix || static_cast<double>(pattern.entries()) > kFull * n * n) {
    factors_ = std::make_unique<DenseFactors>(pattern);
  } else {
    factors_ = std::make_unique<SparseFactors>(pattern);
  }
}

StepMatrix::~StepMatrix() = default;

bool StepMatrix::factorise(std::span<const double> jacobian, double shift) {
  return factors_->factorise(jacobian, shift);
}

void StepMatrix::solve(std::span<double> b) {
  factors_->solve(b);
}

}  // namespace oblique::solve
