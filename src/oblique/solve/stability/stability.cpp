// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/stability.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/stability/eigenvalues.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/stability/rightmost_modes.h>

namespace oblique::solve {
namespace {

constexpr double kNoPole = std::numeric_limits<double>::infinity();

/// The Jacobian of one group of servo loops: a diagonal block of that of the diagram.
class GroupJacobian {
 public:
  /// `place` is scratch of the size of the diagram's Jacobian, −1 all over, and left so.
  GroupJacobian(const network::SparsePattern& pattern, const std::vector<double>& values,
                const std::vector<std::size_t>& group, std::vector<Eigen::Index>& place)
      : diagonal_(Eigen::VectorXd::Zero(static_cast<Eigen::Index>(group.size()))) {
    for (std::size_t i = 0; i < group.size(); ++i) place[group[i]] = static_cast<Eigen::Index>(i);
    for (const std::size_t column : group) {
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        const Eigen::Index row = place[static_cast<std::size_t>(pattern.rows[entry])];
        if (row < 0) continue;
        if (row == place[column]) {
          diagonal_[row] = values[entry];
        } else {
          others_.push_back({row, place[column], values[entry]});
        }
      }
    }
    for (const std::size_t i : group) place[i] = -1;
  }

  Eigen::Index size() const { return diagonal_.size(); }

  /// Largest real part of the eigenvalues, by the QR algorithm: some 10 n³ operations.
  double largest_real_part() const {
    if (size() == 1) return diagonal_[0];
    Eigen::MatrixXd dense = diagonal_.asDiagonal();
    for (const Entry& entry : others_) dense(entry.row, entry.column) = entry.value;
    return eigenvalues_of(dense).real().maxCoeff();
  }

  /// A bound of it, or infinity (see real_part_bound).
  double bound() const {
    std::vector<Eigen::Triplet<double>> entries;
    for (Eigen::Index i = 0; i < size(); ++i)
      entries.emplace_back(static_cast<int>(i), static_cast<int>(i), diagonal_[i]);
    for (const Entry& entry : others_)
      entries.emplace_back(static_cast<int>(entry.row), static_cast<int>(entry.column), entry.value);
    Eigen::SparseMatrix<double> matrix(size(), size());
    matrix.setFromTriplets(entries.begin(), entries.end());
    return real_part_bound(matrix);
  }

 private:
  struct Entry {
    Eigen::Index row, column;
    double value;
  };
  Eigen::VectorXd diagonal_;
  std::vector<Entry> others_;
};

/// Calls `visit(group, jacobian)` for each group of servo loops until it gives false; false where the
/// Jacobian has no value.
template <class Visit>
bool visit_groups(const network::Program& program, network::Workspace& workspace, double t,
                  std::span<const double> states, const Visit& visit) {
  std::vector<double> values(program.jacobian_pattern().entries());
  if (!program.jacobian(t, states.data(), values.data(), workspace)) return false;
  std::vector<Eigen::Index> place(program.n_states(), -1);
  for (const std::vector<std::size_t>& group : servo_groups(program)) {
    if (!visit(group, GroupJacobian(program.jacobian_pattern(), values, group, place))) break;
  }
  return true;
}

}  // namespace

double servo_stability(const network::Program& program, network::Workspace& workspace, double t,
                       std::span<const double> states) {
  double largest = -kNoPole;
  const bool known =
      visit_groups(program, workspace, t, states, [&](const auto&, const GroupJacobian& group) {
        const double pole =
            group.size() <= kMostLoopsForEigenvalues ? group.largest_real_part() : group.bound();
        largest = std::max(largest, pole);
        return pole < kNoPole;
      });
  return known && largest < kNoPole ? largest : std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::size_t> unstable_group(const network::Program& program, network::Workspace& workspace,
                                        double t, std::span<const double> states) {
  std::vector<std::size_t> found;
  visit_groups(program, workspace, t, states, [&](const auto& loops, const GroupJacobian& group) {
    const bool judged = group.size() <= kMostLoopsForEigenvalues;
    if (judged && !(group.bound() < 0) && group.largest_real_part() > 0) found = loops;
    return found.empty();
  });
  return found;
}

}  // namespace oblique::solve
