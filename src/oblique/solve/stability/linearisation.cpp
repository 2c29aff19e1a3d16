// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/linearisation.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/LU>

#include <oblique/solve/stability/eigenvalues.h>

#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/program/program.h>

namespace oblique::solve {
std::vector<std::vector<std::size_t>> coupled_groups(const network::Program& program) {
  const network::SparsePattern& pattern = program.jacobian_pattern();
  std::vector<std::vector<std::uint32_t>> needed(program.n_states());
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      needed[static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])].push_back(
          static_cast<std::uint32_t>(column));
    }
  }
  network::Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);
  std::vector<std::vector<std::size_t>> groups;
  for (const network::OrderStep& step :
       network::dependency_order(dependencies, std::vector<bool>(needed.size(), true))) {
    groups.emplace_back(step.tears.begin(), step.tears.end());
    std::sort(groups.back().begin(), groups.back().end());
  }
  return groups;
}

std::optional<Linearisation> Linearisation::at(const network::Program& program, network::Workspace& workspace,
                                               const Instant& instant) {
  std::vector<double> values(program.jacobian_pattern().entries());
  workspace.load_discrete_states(instant.discrete_states);
  if (!program.jacobian(instant.t, instant.states.data(), values.data(), workspace)) return std::nullopt;
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    return std::nullopt;
  }
  return Linearisation(program, std::move(values));
}

Eigen::MatrixXd Linearisation::block(const std::vector<std::size_t>& group) const {
  const network::SparsePattern& pattern = program_->jacobian_pattern();
  const auto n = static_cast<Eigen::Index>(group.size());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index column = 0; column < n; ++column) {
    const std::size_t state = group[static_cast<std::size_t>(column)];
    for (auto k = pattern.column_starts[state]; k < pattern.column_starts[state + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const auto wanted = static_cast<std::size_t>(pattern.rows[entry]);
      const auto found = std::lower_bound(group.begin(), group.end(), wanted);
      if (found != group.end() && *found == wanted) dense(found - group.begin(), column) = values_[entry];
    }
  }
  return dense;
}

Eigen::SparseMatrix<double> Linearisation::sparse_block(const std::vector<std::size_t>& group) const {
  const network::SparsePattern& pattern = program_->jacobian_pattern();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t column = 0; column < group.size(); ++column) {
    for (auto k = pattern.column_starts[group[column]]; k < pattern.column_starts[group[column] + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const auto wanted = static_cast<std::size_t>(pattern.rows[entry]);
      const auto found = std::lower_bound(group.begin(), group.end(), wanted);
      if (found == group.end() || *found != wanted) continue;
      entries.emplace_back(static_cast<int>(found - group.begin()), static_cast<int>(column), values_[entry]);
    }
  }
  const auto n = static_cast<Eigen::Index>(group.size());
  Eigen::SparseMatrix<double> sparse(n, n);
  sparse.setFromTriplets(entries.begin(), entries.end());
  return sparse;
}

std::vector<double> Linearisation::largest_in_rows() const {
  const network::SparsePattern& pattern = program_->jacobian_pattern();
  std::vector<double> largest(pattern.size(), 0);
  for (std::size_t entry = 0; entry < pattern.entries(); ++entry) {
    double& row = largest[static_cast<std::size_t>(pattern.rows[entry])];
    row = std::max(row, std::abs(values_[entry]));
  }
  return largest;
}

Eigen::VectorXd balance(const Eigen::MatrixXd& matrix) {
  Eigen::MatrixXd balanced = matrix;
  balanced.diagonal().setZero();  // it stays as it is, and may be so large beside the rest that this is lost
  Eigen::VectorXd scale = Eigen::VectorXd::Ones(matrix.rows());
  constexpr int kMostSweeps = 300;  // of a ring of states it takes about half as many as there are
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    bool changed = false;
    for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
      const double column = balanced.col(i).lpNorm<1>(), row = balanced.row(i).lpNorm<1>();
      if (!(column > 0) || !(row > 0)) continue;
      const double factor = std::exp2(std::round(std::log2(row / column) / 2));
      if (factor == 1) continue;
      balanced.col(i) *= factor;
      balanced.row(i) /= factor;
      scale[i] *= factor;
      changed = true;
    }
    if (!changed) break;
  }
  return scale;
}

std::vector<Mode> modes_of(const Eigen::MatrixXd& block, const std::vector<std::size_t>& group) {
  std::vector<Mode> modes;
  if (!block.allFinite()) return modes;
  const Eigen::VectorXd scale = balance(block);
  const Eigen::MatrixXd balanced = scale.cwiseInverse().asDiagonal() * block * scale.asDiagonal();
  const double size = balanced.cwiseAbs().maxCoeff();
  const auto system = eigensystem_of(balanced);
  if (!system) return modes;
  const Eigen::MatrixXcd& right = system->vectors;
  const Eigen::MatrixXcd left = right.partialPivLu().inverse();  // a row for each mode
  const double error = std::numeric_limits<double>::epsilon() * balanced.norm();
  const double greatest_error = std::sqrt(std::numeric_limits<double>::epsilon()) * balanced.norm();
  for (Eigen::Index m = 0; m < block.rows(); ++m) {
    const std::complex<double> pole = system->values[m];
    if (pole.imag() < 0 || std::abs(pole) <= kZeroPole * size) continue;
    Mode& mode = modes.emplace_back();
    mode.pole = pole;
    const double condition = left.row(m).norm() * right.col(m).norm();
    mode.rounding = condition * error < greatest_error ? condition * error : greatest_error;
    Eigen::VectorXd shares = (left.row(m).transpose().array() * right.col(m).array()).abs();
    // Where eigenvectors coincide (a multiple pole without enough of them) there are no shares: all alike.
    if (!shares.allFinite()) shares.setOnes();
    shares /= shares.sum();
    for (Eigen::Index k = 0; k < shares.size(); ++k) {
      mode.participants.push_back({group[static_cast<std::size_t>(k)], shares[k]});
    }
    std::stable_sort(mode.participants.begin(), mode.participants.end(),
                     [](const Participation& a, const Participation& b) { return a.share > b.share; });
  }
  return modes;
}

}  // namespace oblique::solve
