// SPDX-License-Identifier: MIT
#include <oblique/solve/stability.h>

#include <algorithm>
#include <limits>

#include <Eigen/Eigenvalues>

#include <oblique/solve/rest.h>

namespace oblique {
namespace {

/// Largest real part of the eigenvalues of a diagonal block of a sparse matrix; `place` is scratch of its
/// size, −1 all over.
double largest_real_part(const SparsePattern& pattern, const std::vector<double>& values,
                         const std::vector<std::size_t>& block, std::vector<Eigen::Index>& place) {
  const auto n = static_cast<Eigen::Index>(block.size());
  for (std::size_t i = 0; i < block.size(); ++i) place[block[i]] = static_cast<Eigen::Index>(i);
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (const std::size_t column : block) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const Eigen::Index row = place[static_cast<std::size_t>(pattern.rows[entry])];
      if (row >= 0) dense(row, place[column]) = values[entry];
    }
  }
  for (const std::size_t i : block) place[i] = -1;
  if (n == 1) return dense(0, 0);
  return Eigen::EigenSolver<Eigen::MatrixXd>(dense, false).eigenvalues().real().maxCoeff();
}

/// Calls `visit(group, pole)` for each group of servo loops until it gives false; false where the Jacobian
/// has no value.
template <class Visit>
bool visit_groups(const Program& program, Workspace& workspace, double t, std::span<const double> states,
                  const Visit& visit) {
  std::vector<double> values(program.jacobian_pattern().entries());
  if (!program.jacobian(t, states.data(), values.data(), workspace)) return false;
  std::vector<Eigen::Index> place(program.n_states(), -1);
  for (const std::vector<std::size_t>& group : servo_groups(program)) {
    if (!visit(group, largest_real_part(program.jacobian_pattern(), values, group, place))) break;
  }
  return true;
}

}  // namespace

double servo_stability(const Program& program, Workspace& workspace, double t,
                       std::span<const double> states) {
  double largest = -std::numeric_limits<double>::infinity();
  const bool solved = visit_groups(program, workspace, t, states, [&](const auto&, double pole) {
    largest = std::max(largest, pole);
    return true;
  });
  return solved ? largest : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> unstable_group(const Program& program, Workspace& workspace, double t,
                                        std::span<const double> states) {
  std::vector<std::size_t> found;
  visit_groups(program, workspace, t, states, [&](const auto& group, double pole) {
    if (pole > 0) found = group;
    return found.empty();
  });
  return found;
}

}  // namespace oblique
