// SPDX-License-Identifier: MIT
#include <oblique/synthesis/least_squares.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

namespace oblique::synthesis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostIterations = 200;
constexpr int kMostTrials = 40;    ///< of one iteration: each damps at least twice as much as the one before
constexpr int kBlockedWithin = 2;  ///< iterations before the end in which a step was taken back
constexpr double kFirstDamping = 1e-3;
/// Cosine between the residual and what a variable can change, below which the variable is at its best.
constexpr double kFlatWithin = 1e-9;
/// Smallest step, in widths of the bounds, and smallest gain, of the sum, that are worth another iteration.
constexpr double kSmallestStep = 1e-12;
constexpr double kSmallestGain = 1e-11;

class Search {
 public:
  Search(const LeastSquares& problem, VectorXd x, VectorXd residuals)
      : problem_(problem),
        x_(std::move(x)),
        residuals_(std::move(residuals)),
        sum_(residuals_.squaredNorm()) {}

  Minimum run() {
    for (int k = 0; k < kMostIterations && sum_ > problem_.floor; ++k) {
      if (!improve()) break;
    }
    return {x_, sum_, since_blocked_ <= kBlockedWithin};
  }

 private:
  /// One iteration; false where x is as good as it gets.
  bool improve() {
    ++since_blocked_;
    const MatrixXd jacobian = problem_.jacobian(x_);
    const VectorXd gradient = jacobian.transpose() * residuals_;
    const std::vector<Index> free = free_variables(jacobian, gradient);
    if (free.empty()) return false;
    const MatrixXd normal = jacobian(Eigen::all, free).transpose() * jacobian(Eigen::all, free);
    for (int trial = 0; trial < kMostTrials; ++trial) {
      MatrixXd damped = normal;
      damped.diagonal() *= 1 + damping_;
      const VectorXd part = damped.ldlt().solve(-gradient(free));
      if (!part.allFinite()) {
        damp();
        continue;
      }
      VectorXd next = x_;
      next(free) += part;
      next = next.cwiseMax(problem_.lower).cwiseMin(problem_.upper);
      const VectorXd step = next - x_;
      const VectorXd width = problem_.upper - problem_.lower;
      if ((step.array().abs() <= kSmallestStep * width.array()).all()) return false;
      const auto residuals = problem_.residuals(next);
      const double predicted = sum_ - (residuals_ + jacobian * step).squaredNorm();
      const double gain = residuals ? sum_ - residuals->squaredNorm() : -1;
      if (!residuals) since_blocked_ = 0;
      if (gain > 0) {
        relax(gain / predicted);
        const bool small = gain <= kSmallestGain * sum_ && predicted <= kSmallestGain * sum_;
        x_ = next;
        residuals_ = *residuals;
        sum_ = residuals_.squaredNorm();
        return !small;
      }
      damp();
    }
    return false;
  }

  std::vector<Index> free_variables(const MatrixXd& jacobian, const VectorXd& gradient) const {
    std::vector<Index> free;
    bool all_flat = true;
    for (Index i = 0; i < x_.size(); ++i) {
      const bool rests =
          (x_[i] <= problem_.lower[i] && gradient[i] > 0) || (x_[i] >= problem_.upper[i] && gradient[i] < 0);
      const double effect = jacobian.col(i).norm();
      if (rests || !(effect > 0)) continue;
      free.push_back(i);
      all_flat = all_flat && std::abs(gradient[i]) <= kFlatWithin * effect * std::sqrt(sum_);
    }
    if (all_flat) free.clear();
    return free;
  }

  void relax(double ratio) {
    damping_ *= std::max(1.0 / 3, 1 - std::pow(2 * ratio - 1, 3));
    growth_ = 2;
  }

  void damp() {
    damping_ *= growth_;
    growth_ = std::min(2 * growth_, 64.0);
  }

  const LeastSquares& problem_;
  VectorXd x_;
  VectorXd residuals_;
  double sum_;
  double damping_ = kFirstDamping;
  double growth_ = 2;
  int since_blocked_ = kMostIterations;
};

}  // namespace

std::optional<Minimum> minimise(const LeastSquares& problem, const VectorXd& start) {
  auto residuals = problem.residuals(start);
  if (!residuals) return std::nullopt;
  return Search(problem, start, std::move(*residuals)).run();
}

}  // namespace oblique::synthesis
