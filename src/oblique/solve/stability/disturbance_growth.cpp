// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/stability/disturbance_growth.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/SVD>
#include <unsupported/Eigen/MatrixFunctions>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostStates = 60;
constexpr double kMostWork = 2e9;  ///< operations: rows times n³ times about 30
constexpr double kGreatestLogarithm = 700;

/// ln‖Φ‖ of δ′ = A(t) δ at the middle and at the end: in variables that are scaled against each other, which
/// tells rates best, and, at the end, of the largest δ itself (the spectral norm).
struct Logarithms {
  double middle = 0, end = 0, largest = 0;
};

/// From every `stride`-th of the matrices, which are equally far apart: by three of them and Magnus' series
/// of fourth order, Ω = h (A₀ + 4 A₁ + A₂)/6 + h² [A₂ − A₀, A₁]/12, where the last term is small; else by the
/// mean of two.
Logarithms grow(const std::vector<double>& times, const std::vector<Eigen::MatrixXd>& matrices,
                std::size_t stride) {
  const Eigen::VectorXd scale = balance(matrices.front());
  const Eigen::Index n = matrices.front().rows();
  // Powers of 2 keep the numbers and make the exponential of stiff matrices better.
  const auto scaled = [&](std::size_t k) -> Eigen::MatrixXd {
    return scale.cwiseInverse().asDiagonal() * matrices[k] * scale.asDiagonal();
  };
  constexpr double kSmallTurning = 1;
  Eigen::MatrixXd solution = Eigen::MatrixXd::Identity(n, n);
  const double middle_time = (times.front() + times.back()) / 2;
  Logarithms result;
  double logarithm = 0;
  std::size_t from = 0;
  while (from + 1 < times.size()) {
    std::size_t to = std::min(from + stride, times.size() - 1);
    Eigen::MatrixXd step = (times[to] - times[from]) / 2 * (scaled(from) + scaled(to));
    if (const std::size_t third = from + 2 * stride; third < times.size()) {
      const double h = times[third] - times[from];
      const Eigen::MatrixXd middle = scaled(to), change = scaled(third) - scaled(from);
      const Eigen::MatrixXd turning = h * h / 12 * (change * middle - middle * change);
      if (turning.norm() < kSmallTurning) {
        step = h / 6 * (scaled(from) + 4 * middle + scaled(third)) + turning;
        to = third;
      }
    }
    solution = Eigen::MatrixXd(step.exp()) * solution;
    const double norm = solution.norm();
    if (!std::isfinite(norm)) return {std::numeric_limits<double>::quiet_NaN(), 0, 0};
    if (norm == 0) return {-kGreatestLogarithm, -kGreatestLogarithm, -kGreatestLogarithm};
    solution /= norm;
    logarithm += std::log(norm);
    if (times[to] <= middle_time) result.middle = logarithm;
    from = to;
  }
  const Eigen::MatrixXd unscaled = scale.asDiagonal() * solution * scale.cwiseInverse().asDiagonal();
  result.largest = logarithm + std::log(Eigen::JacobiSVD<Eigen::MatrixXd>(unscaled).singularValues()[0]);
  result.end = logarithm - std::log(std::sqrt(static_cast<double>(n)));
  result.middle -= std::log(std::sqrt(static_cast<double>(n)));
  return result;
}

}  // namespace

std::optional<DisturbanceGrowth> disturbance_growth(const network::Program& program,
                                                    const std::vector<Instant>& rows) {
  constexpr std::size_t kFewest = 9;
  if (rows.size() < kFewest) return std::nullopt;
  std::vector<std::vector<std::size_t>> groups = coupled_groups(program);
  std::vector<std::vector<Eigen::MatrixXd>> matrices(groups.size());
  std::vector<bool> varies(groups.size(), false);
  std::vector<double> times;
  network::Workspace workspace(program);
  // First which groups vary, at a few rows; then these at all.
  const auto look = [&](std::size_t row) { return Linearisation::at(program, workspace, rows[row]); };
  const auto first = look(0);
  if (!first) return std::nullopt;
  for (std::size_t row = rows.size() / 8; row < rows.size(); row += rows.size() / 8) {
    const auto linear = look(row);
    if (!linear) return std::nullopt;
    for (std::size_t g = 0; g < groups.size(); ++g) {
      varies[g] = varies[g] || (first->sparse_block(groups[g]) - linear->sparse_block(groups[g])).norm() != 0;
    }
  }
  double work = 0;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!varies[g]) continue;
    if (groups[g].size() > kMostStates) return std::nullopt;
    work += 30 * std::pow(static_cast<double>(groups[g].size()), 3) * static_cast<double>(rows.size());
  }
  if (work == 0) return std::nullopt;
  const auto stride = static_cast<std::size_t>(std::ceil(work / kMostWork));
  for (std::size_t row = 0; row < rows.size(); row += stride) {
    const auto linear = look(row);
    if (!linear) return std::nullopt;
    times.push_back(rows[row].t);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (varies[g]) matrices[g].push_back(linear->block(groups[g]));
    }
  }
  if (times.size() < kFewest) return std::nullopt;
  Logarithms most{-kGreatestLogarithm, -kGreatestLogarithm, -kGreatestLogarithm};
  double largest = -kGreatestLogarithm;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (!varies[g]) continue;
    const Logarithms fine = grow(times, matrices[g], 1), coarse = grow(times, matrices[g], 2);
    const double late = fine.end - fine.middle, coarse_late = coarse.end - coarse.middle;
    constexpr double kAgree = 0.2;
    if (!(std::abs(late - coarse_late) <= kAgree * std::max(1.0, std::abs(late)))) return std::nullopt;
    largest = std::max(largest, fine.largest);
    if (fine.end - fine.middle > most.end - most.middle || most.end <= -kGreatestLogarithm) most = fine;
  }
  DisturbanceGrowth growth;
  growth.from = times.front();
  growth.to = times.back();
  growth.factor = std::exp(std::min(largest, kGreatestLogarithm));
  growth.exponent = (most.end - most.middle) / ((growth.to - growth.from) / 2);
  return growth;
}

}  // namespace oblique::solve
