// SPDX-License-Identifier: MIT
#include <oblique/solve/method.h>

#include <algorithm>
#include <complex>

#include <fmt/format.h>
#include <Eigen/Eigenvalues>

#include <oblique/solve/rest.h>

namespace oblique {
namespace {

constexpr std::size_t kMostStatesForEigenvalues = 100;
constexpr double kStiff =
    100;  ///< ratio of the fastest rate to the slowest from which decays are left to BDF

/// Time constants of the fastest decay in a run from which it is left to BDF: Adams takes a step or more for
/// each.
constexpr double kLongRun = 1e4;

Eigen::VectorXcd eigenvalues_at(const Program& program, Workspace& workspace,
                                std::span<const double> states) {
  const SparsePattern& pattern = program.jacobian_pattern();
  std::vector<double> values(pattern.entries());
  if (!program.jacobian(0, states.data(), values.data(), workspace)) return {};
  const auto n = static_cast<Eigen::Index>(program.n_states());
  Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(n, n);
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto entry = static_cast<std::size_t>(k);
      dense(pattern.rows[entry], static_cast<Eigen::Index>(column)) = values[entry];
    }
  }
  if (!dense.allFinite()) return {};
  return Eigen::EigenSolver<Eigen::MatrixXd>(dense, false).eigenvalues();
}

MethodChoice from_eigenvalues(const Eigen::VectorXcd& eigenvalues, double until) {
  using Method = IntegrationMethod;
  if (eigenvalues.size() == 0) return {Method::bdf, "the equations have no linearisation at the start"};
  std::complex<double> fastest = 0;
  double slowest = 0;
  for (const std::complex<double>& value : eigenvalues) {
    if (std::abs(value) > std::abs(fastest)) fastest = value;
  }
  slowest = std::abs(fastest);
  for (const std::complex<double>& value : eigenvalues) {
    if (std::abs(value) > 0) slowest = std::min(slowest, std::abs(value));
  }
  if (std::abs(fastest.imag()) >= std::abs(fastest.real()) && std::abs(fastest) > 0) {
    return {Method::adams,
            fmt::format("the fastest mode at the start oscillates, at {:.3g} rad/s", std::abs(fastest))};
  }
  if (fastest.real() < 0 && std::abs(fastest) > kStiff * slowest) {
    return {Method::bdf,
            fmt::format("decays from {:.3g} to {:.3g} 1/s at the start", slowest, std::abs(fastest))};
  }
  // Beside what does not move by itself (an integrator that is fed, the clock) a decay may be the only rate
  // there is.
  if (fastest.real() < 0 && std::abs(fastest) * until > kLongRun) {
    return {Method::bdf,
            fmt::format("a decay of {:.3g} 1/s at the start of a run of {:.3g} s", std::abs(fastest), until)};
  }
  return {Method::adams, "nothing is fast at the start"};
}

}  // namespace

MethodChoice choose_method(IntegrationMethod asked, const Program& program, Workspace& workspace,
                           std::span<const double> start, double until) {
  if (asked != IntegrationMethod::automatic) return {asked, "as the diagram asks"};
  const std::size_t servos = rest_states(program).size();
  if (servos > 0) {
    return {
        IntegrationMethod::bdf,
        fmt::format("{} {} faster than what {} {}", servos, servos == 1 ? "servo loop is" : "servo loops are",
                    servos == 1 ? "it" : "they", servos == 1 ? "follows" : "follow")};
  }
  if (program.n_states() > kMostStatesForEigenvalues) {
    return {IntegrationMethod::bdf,
            fmt::format("{} states, too many to look for fast ones", program.n_states())};
  }
  return from_eigenvalues(eigenvalues_at(program, workspace, start), until);
}

}  // namespace oblique
