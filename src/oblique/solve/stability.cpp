// SPDX-License-Identifier: MIT
#include <oblique/solve/stability.h>

#include <limits>

#include <Eigen/Eigenvalues>

#include <oblique/solve/rest.h>

namespace oblique {

double servo_stability(const Program& program, Workspace& workspace, double t, std::span<const double> states) {
  const std::vector<std::size_t> servos = rest_states(program);
  if (servos.empty()) return -std::numeric_limits<double>::infinity();
  const SparsePattern& pattern = program.jacobian_pattern();
  std::vector<double> values(pattern.entries());
  if (!program.jacobian(t, states.data(), values.data(), workspace)) return std::numeric_limits<double>::quiet_NaN();

  std::vector<Eigen::Index> place(program.n_states(), -1);
  for (std::size_t i = 0; i < servos.size(); ++i) place[servos[i]] = static_cast<Eigen::Index>(i);
  const auto n = static_cast<Eigen::Index>(servos.size());
  Eigen::MatrixXd loops = Eigen::MatrixXd::Zero(n, n);
  for (const std::size_t column : servos) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const Eigen::Index row = place[static_cast<std::size_t>(pattern.rows[entry])];
      if (row >= 0) loops(row, place[column]) = values[entry];
    }
  }
  return Eigen::EigenSolver<Eigen::MatrixXd>(loops, false).eigenvalues().real().maxCoeff();
}

}  // namespace oblique
