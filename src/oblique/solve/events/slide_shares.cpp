// SPDX-License-Identifier: MIT
#include <oblique/solve/events/slide_shares.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace oblique::solve {
namespace {

/// An event function whose rate depends on the shares by less than this part of what others do stands still
/// whatever they are.
constexpr double kNoDerivative = 1e-8;

}  // namespace

double way_back(const SlideSides& sides, std::size_t unit, double rate, double fastest) {
  return std::clamp(rate * sides.of_unit(sides[0].event_functions, unit), -fastest, fastest);
}

std::optional<std::vector<double>> shares_of_coupled(SlideSides& sides, std::vector<double> trial,
                                                     double rate, double most) {
  constexpr int kMostIterations = 50;
  constexpr double kFar = 1e3;
  constexpr double kSolved = 1e-6;  // of the largest rate of any side
  const std::size_t n = sides.units();
  const auto size = static_cast<Eigen::Index>(n);
  Eigen::VectorXd residual(size), last(size);
  Eigen::MatrixXd jacobian(size, size);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kNoDerivative);
  double scale = std::numeric_limits<double>::min();
  for (const SlideSide& side : sides) {
    for (std::size_t u = 0; u < n; ++u) scale = std::max(scale, std::abs(sides.of_unit(side.rates, u)));
  }
  const auto residuals = [&](std::span<const double> shares, Eigen::Ref<Eigen::VectorXd> result) {
    sides.weigh(shares);
    for (std::size_t u = 0; u < n; ++u) {
      double sum = way_back(sides, u, rate, most * scale);
      for (const SlideSide& side : sides) sum += side.weight * sides.of_unit(side.rates, u);
      result[static_cast<Eigen::Index>(u)] = sum;
    }
  };
  for (double& share : trial) share = std::clamp(share, 0.0, 1.0);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    residuals(trial, residual);
    if (!residual.allFinite()) return std::nullopt;
    // The weights are linear in each share: a difference is a derivative.
    for (std::size_t u = 0; u < n; ++u) {
      const double share = trial[u];
      trial[u] = share + 1;
      residuals(trial, last);
      jacobian.col(static_cast<Eigen::Index>(u)) = last - residual;
      trial[u] = share;
    }
    decomposition.compute(jacobian);
    const Eigen::VectorXd step = decomposition.solve(-residual);
    double change = 0;
    for (std::size_t u = 0; u < n; ++u) {
      trial[u] += step[static_cast<Eigen::Index>(u)];
      change = std::max(change, std::abs(step[static_cast<Eigen::Index>(u)]));
      if (!(std::abs(trial[u]) < kFar)) return std::nullopt;
    }
    if (change < 1e-14) break;
  }
  residuals(trial, residual);
  if (!(residual.cwiseAbs().maxCoeff() <= kSolved * scale)) return std::nullopt;
  return trial;
}

}  // namespace oblique::solve
