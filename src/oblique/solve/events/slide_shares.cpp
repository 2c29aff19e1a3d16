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

/// Of the event functions of these places, by how much the rate of each mixed with these shares changes with
/// the share of each.
Eigen::MatrixXd pushes_of(SlideSides& sides, std::vector<double> shares,
                          std::span<const std::size_t> places) {
  const auto size = static_cast<Eigen::Index>(places.size());
  const auto mixed = [&] {
    Eigen::VectorXd rates = Eigen::VectorXd::Zero(size);
    sides.weigh(shares);
    for (const SlideSide& side : sides) {
      for (Eigen::Index i = 0; i < size; ++i)
        rates[i] += side.weight * sides.of_unit(side.rates, places[static_cast<std::size_t>(i)]);
    }
    return rates;
  };
  // The weights are linear in each share: a difference is a derivative.
  const Eigen::VectorXd here = mixed();
  Eigen::MatrixXd pushes(size, size);
  for (Eigen::Index i = 0; i < size; ++i) {
    double& changed = shares[places[static_cast<std::size_t>(i)]];
    const double share = changed;
    changed = share + 1;
    pushes.col(i) = mixed() - here;
    changed = share;
  }
  sides.weigh(shares);
  return pushes;
}

}  // namespace

std::vector<double> drives_apart_of_coupled(SlideSides& sides, std::span<const double> shares,
                                            std::span<const std::size_t> places) {
  constexpr double kNone = 1e-9;  // of the largest: without it the others hold nothing
  std::vector<double> drives(places.size(), 0.0);
  const Eigen::MatrixXd all = pushes_of(sides, {shares.begin(), shares.end()}, places);
  std::vector<Eigen::Index> acting;
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    if (all.col(k).cwiseAbs().maxCoeff() > kNone * all.cwiseAbs().maxCoeff()) acting.push_back(k);
  }
  const Eigen::FullPivLU<Eigen::MatrixXd> pushes(all(acting, acting));
  if (acting.empty() || !pushes.isInvertible()) return drives;
  const Eigen::MatrixXd inverse = pushes.inverse();
  const bool drives_apart = (acting.size() % 2 == 0 ? 1 : -1) * pushes.determinant() < 0;
  for (std::size_t k = 0; k < acting.size(); ++k) {
    const double own = inverse.diagonal()[static_cast<Eigen::Index>(k)];
    if (std::abs(own) > kNone * inverse.cwiseAbs().maxCoeff())
      drives[static_cast<std::size_t>(acting[k])] = drives_apart ? 1 / own : -std::abs(1 / own);
  }
  return drives;
}

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
  Eigen::VectorXd residual(size);
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
    decomposition.compute(pushes_of(sides, trial, places));
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
