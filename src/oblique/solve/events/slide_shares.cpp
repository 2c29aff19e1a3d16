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
                                                     std::span<const std::size_t> places, double rate,
                                                     double most) {
  constexpr int kMostIterations = 50;
  constexpr double kFar = 1e3;
  constexpr double kSolved = 1e-6;  // of the largest rate of any side
  const auto size = static_cast<Eigen::Index>(places.size());
  Eigen::VectorXd residual(size), last(size);
  Eigen::MatrixXd jacobian(size, size);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(kNoDerivative);
  double scale = std::numeric_limits<double>::min();
  for (const SlideSide& side : sides) {
    for (const std::size_t u : places) scale = std::max(scale, std::abs(sides.of_unit(side.rates, u)));
  }
  const auto residuals = [&](std::span<const double> shares, Eigen::Ref<Eigen::VectorXd> result) {
    sides.weigh(shares);
    for (Eigen::Index i = 0; i < size; ++i) {
      const std::size_t u = places[static_cast<std::size_t>(i)];
      result[i] = way_back(sides, u, rate, most * scale);
      for (const SlideSide& side : sides) result[i] += side.weight * sides.of_unit(side.rates, u);
    }
  };
  for (const std::size_t u : places) trial[u] = std::clamp(trial[u], 0.0, 1.0);
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    residuals(trial, residual);
    if (!residual.allFinite()) return std::nullopt;
    // The weights are linear in each share: a difference is a derivative.
    for (Eigen::Index i = 0; i < size; ++i) {
      double& changed = trial[places[static_cast<std::size_t>(i)]];
      const double share = changed;
      changed = share + 1;
      residuals(trial, last);
      jacobian.col(i) = last - residual;
      changed = share;
    }
    decomposition.compute(jacobian);
    const Eigen::VectorXd step = decomposition.solve(-residual);
    double change = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
      double& share = trial[places[static_cast<std::size_t>(i)]];
      share += step[i];
      change = std::max(change, std::abs(step[i]));
      if (!(std::abs(share) < kFar)) return std::nullopt;
    }
    if (change < 1e-14) break;
  }
  residuals(trial, residual);
  if (!(residual.cwiseAbs().maxCoeff() <= kSolved * scale)) return std::nullopt;
  return trial;
}

}  // namespace oblique::solve
