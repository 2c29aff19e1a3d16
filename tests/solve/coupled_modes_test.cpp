// SPDX-License-Identifier: MIT
// The modes of groups of states that act on each other, against the eigenvalues of the whole matrix.
#include <algorithm>
#include <complex>
#include <random>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include <oblique/solve/stability/coupled_modes.h>

namespace oblique::solve {
namespace {

/// A full pattern: which elements act is said by the zeros.
network::SparsePattern full_pattern(int n) {
  network::SparsePattern pattern;
  for (int column = 1; column <= n; ++column) pattern.column_starts.push_back(column * n);
  for (int k = 0; k < n * n; ++k) pattern.rows.push_back(k % n);
  return pattern;
}

std::vector<std::complex<double>> sorted(std::vector<std::complex<double>> values) {
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) {
    return std::pair(std::round(1e6 * a.real()), a.imag()) < std::pair(std::round(1e6 * b.real()), b.imag());
  });
  return values;
}

std::vector<std::complex<double>> all_of(const std::vector<CoupledModes>& groups) {
  std::vector<std::complex<double>> values;
  for (const CoupledModes& group : groups)
    values.insert(values.end(), group.eigenvalues.begin(), group.eigenvalues.end());
  return sorted(values);
}

// One finder for matrices of ever other zeros and ever other states that are let go.
TEST(CoupledModes, OfAllGroupsAreTheEigenvaluesOfTheMatrix) {
  constexpr int kSize = 5;
  const network::SparsePattern pattern = full_pattern(kSize);
  ModeFinder finder(pattern);
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int trial = 0; trial < 500; ++trial) {
    const double density = trial % 10 / 10.0;
    std::vector<double> jacobian(kSize * kSize);
    for (double& element : jacobian) element = value(random) < 2 * density - 1 ? value(random) : 0;
    std::vector<bool> among(kSize);
    std::vector<int> members;
    for (int i = 0; i < kSize; ++i) {
      among[static_cast<std::size_t>(i)] = trial % 3 == 0 || value(random) > -0.5;
      if (among[static_cast<std::size_t>(i)]) members.push_back(i);
    }
    const Eigen::Map<const Eigen::MatrixXd> whole(jacobian.data(), kSize, kSize);
    const Eigen::VectorXcd expected = Eigen::MatrixXd(whole(members, members)).eigenvalues();
    for (int again = 0; again < 2; ++again) {  // with the groups found anew, and with those kept
      const auto found = all_of(finder.find(jacobian, among));
      const auto truth = sorted({expected.begin(), expected.end()});
      ASSERT_EQ(found.size(), truth.size());
      // Of a matrix of size 1 with an eigenvalue of fifth order, rounding makes 1e-3.
      for (std::size_t k = 0; k < found.size(); ++k)
        EXPECT_NEAR(std::abs(found[k] - truth[k]), 0, 1e-3) << trial;
    }
  }
}

TEST(CoupledModes, OfTwoStatesAreExact) {
  const network::SparsePattern pattern = full_pattern(2);
  const auto modes = [&](double a, double b, double c, double d) {
    return all_of(ModeFinder(pattern).find(std::vector{a, c, b, d}, {true, true}));
  };
  using Values = std::vector<std::complex<double>>;
  EXPECT_EQ(modes(0, 1, -4, 0), (Values{{0, -2}, {0, 2}}));
  EXPECT_EQ(modes(0, 1, 4, 0), (Values{-2.0, 2.0}));
  EXPECT_EQ(modes(3, 0, 0, 3), (Values{3.0, 3.0}));
  // (1 + 1e9, 1; 1, 1) has a determinant of 1e9 and so an eigenvalue of 1 − 1e-9: no digits are lost.
  EXPECT_NEAR(modes(1 + 1e9, 1, 1, 1).front().real(), 1 - 1e-9, 1e-15);
  EXPECT_THAT(modes(NAN, 1, 1, 1), ::testing::IsEmpty());
}

}  // namespace
}  // namespace oblique::solve
