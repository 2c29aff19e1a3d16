// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/coupled_modes.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <oblique/solve/stability/eigenvalues.h>

#include <oblique/network/graph/dependency_order.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostTogether = 200;  ///< the eigenvalues of so many take a tenth of a second

constexpr std::uint32_t kNowhere = ~std::uint32_t{0};

/// Of the matrix (a, b; c, d), without a difference of nearly equal numbers.
std::array<std::complex<double>, 2> eigenvalues_of_two(double a, double b, double c, double d) {
  const double half = (a - d) / 2, squared = half * half + b * c;
  if (squared < 0) {
    const double mean = (a + d) / 2, frequency = std::sqrt(-squared);
    return {std::complex<double>(mean, frequency), std::complex<double>(mean, -frequency)};
  }
  const double far = half + std::copysign(std::sqrt(squared), half);
  return {std::complex<double>(d + far), std::complex<double>(far == 0 ? d : d - b * c / far)};
}

}  // namespace

void ModeFinder::find_groups() {
  std::vector<std::uint32_t> place(pattern_.size(), kNowhere);
  std::vector<std::size_t> members;
  for (std::size_t i = 0; i < pattern_.size(); ++i) {
    if (!among_[i]) continue;
    place[i] = static_cast<std::uint32_t>(members.size());
    members.push_back(i);
  }
  std::vector<Element> elements;
  std::vector<std::vector<std::uint32_t>> needed(members.size());
  for (const std::size_t column : members) {
    for (auto k = pattern_.column_starts[column]; k < pattern_.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      const std::uint32_t row = place[static_cast<std::size_t>(pattern_.rows[entry])];
      if (row == kNowhere || !acts_[entry]) continue;
      elements.push_back({entry, row, place[column]});
      if (row != place[column]) needed[row].push_back(place[column]);
    }
  }
  network::Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);

  groups_.clear();
  std::vector<std::uint32_t> group_of(members.size()), place_in_group(members.size());
  for (const network::OrderStep& step :
       network::dependency_order(dependencies, std::vector<bool>(members.size(), true))) {
    CoupledModes& group = groups_.emplace_back();
    for (const std::uint32_t member : step.tears) {
      group_of[member] = static_cast<std::uint32_t>(groups_.size() - 1);
      place_in_group[member] = static_cast<std::uint32_t>(group.states.size());
      group.states.push_back(members[member]);
    }
  }
  elements_.assign(groups_.size(), {});
  for (const Element& element : elements) {
    const std::uint32_t group = group_of[element.row];
    if (group_of[element.column] == group)
      elements_[group].push_back(
          {element.entry, place_in_group[element.row], place_in_group[element.column]});
  }
}

const std::vector<CoupledModes>& ModeFinder::find(std::span<const double> jacobian,
                                                  const std::vector<bool>& among) {
  acts_now_.resize(jacobian.size());
  for (std::size_t k = 0; k < jacobian.size(); ++k) acts_now_[k] = jacobian[k] != 0;
  if (among != among_ || acts_now_ != acts_) {
    among_ = among;
    acts_ = acts_now_;
    find_groups();
  }
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    auto& eigenvalues = groups_[g].eigenvalues;
    eigenvalues.clear();
    const std::size_t size = groups_[g].states.size();
    const bool finite = std::all_of(elements_[g].begin(), elements_[g].end(), [&](const Element& element) {
      return std::isfinite(jacobian[element.entry]);
    });
    if (size > kMostTogether || !finite) continue;
    if (size <= 2) {
      std::array<double, 4> block{};
      for (const Element& element : elements_[g])
        block[2 * element.row + element.column] = jacobian[element.entry];
      if (size == 1) {
        eigenvalues.emplace_back(block[0]);
      } else {
        const auto both = eigenvalues_of_two(block[0], block[1], block[2], block[3]);
        eigenvalues.assign(both.begin(), both.end());
      }
      continue;
    }
    Eigen::MatrixXd dense =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
    for (const Element& element : elements_[g]) dense(element.row, element.column) = jacobian[element.entry];
    const Eigen::VectorXcd values = eigenvalues_of(dense);
    eigenvalues.assign(values.begin(), values.end());
  }
  return groups_;
}

std::vector<CoupledModes> coupled_modes(const network::SparsePattern& pattern,
                                        std::span<const double> jacobian, const std::vector<bool>& among) {
  return ModeFinder(pattern).find(jacobian, among);
}

CoupledModes closed_modes(const network::SparsePattern& pattern, std::span<const double> jacobian,
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

}  // namespace oblique::solve
