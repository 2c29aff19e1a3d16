// SPDX-License-Identifier: MIT
#include <oblique/solve/coupled_modes.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

#include <oblique/network/dependency_order.h>

namespace oblique {
namespace {

constexpr std::size_t kMostTogether = 200;  ///< the eigenvalues of so many take a tenth of a second

constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

struct MatrixElement {
  std::uint32_t row, column;
  double value;
};

std::vector<std::complex<double>> eigenvalues_of(Eigen::Index size, const std::vector<MatrixElement>& part) {
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(size, size);
  for (const MatrixElement& element : part) dense(element.row, element.column) = element.value;
  if (!dense.allFinite()) return {};
  if (size == 1) return {dense(0, 0)};
  const Eigen::VectorXcd values = Eigen::EigenSolver<Eigen::MatrixXd>(dense, false).eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace

std::vector<CoupledModes> coupled_modes(const SparsePattern& pattern, std::span<const double> jacobian,
                                        const std::vector<bool>& among) {
  std::vector<std::uint32_t> place(pattern.size(), kNowhere);
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    if (!among[i]) continue;
    place[i] = static_cast<std::uint32_t>(members.size());
    members.push_back(i);
  }
  std::vector<MatrixElement> elements;
  std::vector<std::vector<std::uint32_t>> needed(members.size());
  for (const std::size_t column : members) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const std::uint32_t row = place[static_cast<std::size_t>(pattern.rows[entry])];
      if (row == kNowhere || jacobian[entry] == 0) continue;
      elements.push_back({row, place[column], jacobian[entry]});
      if (row != place[column]) needed[row].push_back(place[column]);
    }
  }
  Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);

  std::vector<CoupledModes> groups;
  std::vector<std::uint32_t> group_of(members.size()), place_in_group(members.size());
  for (const OrderStep& step : dependency_order(dependencies, std::vector<bool>(members.size(), true))) {
    CoupledModes& group = groups.emplace_back();
    for (const std::uint32_t member : step.tears) {
      group_of[member] = static_cast<std::uint32_t>(groups.size() - 1);
      place_in_group[member] = static_cast<std::uint32_t>(group.states.size());
      group.states.push_back(members[member]);
    }
  }
  std::vector<std::vector<MatrixElement>> parts(groups.size());
  for (const MatrixElement& element : elements) {
    const std::uint32_t group = group_of[element.row];
    if (group_of[element.column] == group)
      parts[group].push_back({place_in_group[element.row], place_in_group[element.column], element.value});
  }
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].states.size() <= kMostTogether)
      groups[g].eigenvalues = eigenvalues_of(static_cast<Eigen::Index>(groups[g].states.size()), parts[g]);
  }
  return groups;
}

CoupledModes closed_modes(const SparsePattern& pattern, std::span<const double> jacobian,
                          std::size_t member) {
  // Those that it acts on, and those that act on it.
  std::vector<std::vector<std::size_t>> followers(pattern.size()), leaders(pattern.size());
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      if (jacobian[entry] == 0) continue;
      followers[column].push_back(static_cast<std::size_t>(pattern.rows[entry]));
      leaders[static_cast<std::size_t>(pattern.rows[entry])].push_back(column);
    }
  }
  const auto reach = [&](const std::vector<std::vector<std::size_t>>& next) {
    std::vector<bool> reached(pattern.size(), false);
    reached[member] = true;
    for (std::vector<std::size_t> open{member}; !open.empty();) {
      const std::size_t at = open.back();
      open.pop_back();
      for (const std::size_t i : next[at]) {
        if (!reached[i]) open.push_back(i);
        reached[i] = true;
      }
    }
    return reached;
  };
  std::vector<bool> group = reach(followers);
  const std::vector<bool> acting = reach(leaders);
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = group[i] && acting[i];
  return coupled_modes(pattern, jacobian, group).front();
}

}  // namespace oblique
