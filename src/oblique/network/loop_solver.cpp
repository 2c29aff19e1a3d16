// SPDX-License-Identifier: MIT
#include <oblique/network/loop_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMostIterations = 100;
constexpr double kSmallestFraction = 1e-9;  ///< of a Newton step, below which the search along it gives up

/// A step below this, of 1 + |z|, that does not bring the residual down is led by the residual's rounding:
/// the terms of an equation may be a hundred million times its slope. (A Newton step leads downhill, so along
/// a longer one that does not, there is no solution.)
constexpr double kNoise = 1e-8;

/// Size of an unknown for relative tests; the floor only keeps a zero from dividing.
double magnitude(double z) {
  return std::abs(z) + std::numeric_limits<double>::min();
}

Eigen::Index index(std::size_t i) {
  return static_cast<Eigen::Index>(i);
}

}  // namespace

LoopWorkspace::LoopWorkspace(std::size_t size)
    : matrix_(index(size), index(size)),
      scale_(index(size)),
      step_(index(size), 1),
      start_(index(size)),
      permuted_(index(size)),
      lu_(index(size)) {}

bool LoopWorkspace::factor(const LoopCode& loop, const double* slots) {
  scale_ = Eigen::Map<const Eigen::VectorXd>(loop.natural_scale.data(), index(loop.size()));
  for (const MatrixEntry& entry : loop.slopes) {
    scale_[entry.row] = std::max(scale_[entry.row], std::abs(slots[entry.slot]));
  }
  if (!scale_.allFinite() || scale_.minCoeff() <= 0) return false;
  matrix_.setZero();
  for (const MatrixEntry& entry : loop.slopes) {
    matrix_(entry.row, entry.column) = slots[entry.slot] / scale_[entry.row];
  }
  const double smallest_pivot = 8 * kEpsilon * static_cast<double>(loop.size());
  if (loop.size() == 1) return std::abs(matrix_(0, 0)) > smallest_pivot;
  lu_.compute(matrix_);
  return lu_.matrixLU().diagonal().cwiseAbs().minCoeff() > smallest_pivot;
}

void LoopWorkspace::solve(Eigen::Ref<Eigen::MatrixXd> right_sides) {
  for (Eigen::Index column = 0; column < right_sides.cols(); ++column) {
    right_sides.col(column).array() /= scale_.array();
  }
  if (matrix_.rows() == 1) {
    right_sides /= matrix_(0, 0);
    return;
  }
  const auto& row_of = lu_.permutationP().indices();
  for (Eigen::Index column = 0; column < right_sides.cols(); ++column) {
    for (Eigen::Index i = 0; i < row_of.size(); ++i) permuted_[row_of[i]] = right_sides(i, column);
    right_sides.col(column) = permuted_;
  }
  lu_.matrixLU().triangularView<Eigen::UnitLower>().solveInPlace(right_sides);
  lu_.matrixLU().triangularView<Eigen::Upper>().solveInPlace(right_sides);
}

/// Largest residual over the scale of its row: the length of the step that the row asks for.
double LoopWorkspace::residual_norm(const LoopCode& loop, const double* slots) const {
  double norm = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double residual = slots[loop.residual_slots[i]];
    if (!std::isfinite(residual)) return std::numeric_limits<double>::infinity();
    norm = std::max(norm, std::abs(residual) / scale_[index(i)]);
  }
  return norm;
}

/// Puts start + fraction · step into the unknowns' slots; the largest relative change.
double LoopWorkspace::move(const LoopCode& loop, double* slots, double fraction) const {
  double change = 0;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const double by = fraction * step_(index(i), 0);
    slots[loop.unknown_slots[i]] = start_[index(i)] + by;
    change = std::max(change, std::abs(by) / magnitude(start_[index(i)]));
  }
  return change;
}

LoopFailure LoopWorkspace::solve_loop(const LoopCode& loop, std::span<const Instruction> tape,
                                      double* slots) {
  const auto body = tape.subspan(loop.body.begin, loop.body.end - loop.body.begin);
  if (loop.linear) {  // its one step rounds as the point does that it starts from
    for (const std::uint32_t slot : loop.unknown_slots) slots[slot] = 0;
  }
  run_tape(body, slots);
  double last_change = std::numeric_limits<double>::infinity();
  bool small = false;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    for (const std::uint32_t slot : loop.residual_slots) {
      if (!std::isfinite(slots[slot])) return LoopFailure::not_finite;
    }
    // Singular where it started: the loop itself. Singular on the way: a search that found no solution.
    if (!factor(loop, slots)) return iteration == 0 ? LoopFailure::singular : LoopFailure::diverged;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      step_(index(i), 0) = -slots[loop.residual_slots[i]];
      start_[index(i)] = slots[loop.unknown_slots[i]];
    }
    const double norm = residual_norm(loop, slots);
    if (norm == 0) return LoopFailure::none;
    solve(step_);
    small = (step_.col(0).array().abs() < kNoise * (1 + start_.array().abs())).all();

    double fraction = 1;
    double change = move(loop, slots, fraction);
    run_tape(body, slots);
    if (loop.linear) return step_.allFinite() ? LoopFailure::none : LoopFailure::not_finite;
    // Steps at the level of rounding are not judged by the residual, which is noise there.
    while (change > 1e-13 && !(residual_norm(loop, slots) < (1 - 1e-4 * fraction) * norm)) {
      fraction /= 2;
      if (fraction < kSmallestFraction) {
        if (!small) return LoopFailure::diverged;
        move(loop, slots, 0);
        run_tape(body, slots);
        return LoopFailure::none;
      }
      change = move(loop, slots, fraction);
      run_tape(body, slots);
    }
    const bool stagnates = change < 1e-10 && change > last_change / 2;
    if (change < 2 * kEpsilon || stagnates) return LoopFailure::none;
    last_change = change;
  }
  return small ? LoopFailure::none
               : LoopFailure::diverged;  // rounding that a step now and then makes smaller
}

}  // namespace oblique
