// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/settling.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/switch_placing.h>
#include <oblique/solve/stability/linear_factors.h>

namespace oblique::solve {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The switches at which signals only bend: those of magnitudes and limiters, and those that move tables
/// along.
std::vector<std::uint32_t> bends_of(const network::Program& program) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t s = 0; s < program.switches().size(); ++s) {
    const network::Switch& made = program.switches()[s];
    if (made.moves_along || (made.turning == network::Turning::bends && !made.rate)) found.push_back(s);
  }
  return found;
}

/// The diagram with its clock stopped: only the states of the groups move, and with them those of the
/// switches at which signals bend that are to.
class Settling {
 public:
  Settling(const network::Program& program, network::Workspace& workspace, double t,
           const StateGroups& groups, std::vector<std::uint32_t> bends)
      : program_(program),
        workspace_(workspace),
        t_(t),
        groups_(groups),
        bends_(program, std::move(bends)),
        values_(program.jacobian_pattern().entries()),
        group_of_(program.n_states(), kHeld),
        place_(program.n_states(), 0) {
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (std::size_t i = 0; i < groups[g].size(); ++i) {
        group_of_[groups[g][i]] = g;
        place_[groups[g][i]] = static_cast<Index>(i);
      }
    }
  }

  bool derivatives(const VectorXd& x, VectorXd& dxdt) {
    if (!bends_.place(t_, x.data(), workspace_)) return false;
    if (!program_.derivatives(t_, x.data(), dxdt.data(), workspace_)) return false;
    for (std::size_t i = 0; i < group_of_.size(); ++i) {
      if (group_of_[i] == kHeld) dxdt[static_cast<Index>(i)] = 0;
    }
    return true;
  }

  /// The largest magnitude of those that settle.
  double farthest(const VectorXd& x) const {
    double farthest = 0;
    for (std::size_t i = 0; i < group_of_.size(); ++i) {
      if (group_of_[i] != kHeld) farthest = std::max(farthest, std::abs(x[static_cast<Index>(i)]));
    }
    return farthest;
  }

  /// The states x, of those that settle those as zero that are smaller than `rounding`.
  VectorXd without_rounding(VectorXd x, double rounding) const {
    for (std::size_t i = 0; i < group_of_.size(); ++i) {
      double& state = x[static_cast<Index>(i)];
      if (group_of_[i] != kHeld && std::abs(state) < rounding) state = 0;
    }
    return x;
  }

  /// Takes the Jacobian at x; false where there is none.
  bool linearise(const VectorXd& x) { return program_.jacobian(t_, x.data(), values_.data(), workspace_); }

  /// Time constant of the fastest loop [s], from the largest entry of the Jacobian in rows that move.
  double fastest_time_constant() const {
    double rate = 0;
    const network::SparsePattern& p = program_.jacobian_pattern();
    for (std::size_t k = 0; k < p.entries(); ++k) {
      if (group_of_[row(k)] != kHeld && std::isfinite(values_[k]))
        rate = std::max(rate, std::abs(values_[k]));
    }
    return rate > 0 ? 1 / rate : 1;
  }

  /// The change (1/h − df/dx)⁻¹ `rest`, group by group along the flow of the signals; nothing where a group's
  /// determinant is not above 0.
  std::optional<VectorXd> step(double h, VectorXd rest) const {
    VectorXd change = VectorXd::Zero(rest.size());
    for (std::size_t g = 0; g < groups_.size(); ++g) {
      const auto solved = solve(g, h, rest);
      if (!solved) return std::nullopt;
      for (std::size_t i = 0; i < groups_[g].size(); ++i) {
        const std::size_t column = groups_[g][i];
        const double by = change[static_cast<Index>(column)] = (*solved)[static_cast<Index>(i)];
        for_entries(column, [&](std::size_t k) {
          const std::size_t other = group_of_[row(k)];
          if (other != kHeld && other != g) rest[static_cast<Index>(row(k))] += values_[k] * by;
        });
      }
    }
    return change;
  }

 private:
  static constexpr std::size_t kHeld = static_cast<std::size_t>(-1);

  std::size_t row(std::size_t entry) const {
    return static_cast<std::size_t>(program_.jacobian_pattern().rows[entry]);
  }

  template <class Work>
  void for_entries(std::size_t column, const Work& work) const {
    const network::SparsePattern& p = program_.jacobian_pattern();
    for (auto k = p.column_starts[column]; k < p.column_starts[column + 1]; ++k)
      work(static_cast<std::size_t>(k));
  }

  std::optional<VectorXd> solve(std::size_t g, double h, const VectorXd& rest) const {
    const auto n = static_cast<Index>(groups_[g].size());
    VectorXd right(n);
    std::vector<Eigen::Triplet<double>> matrix;
    for (const std::size_t column : groups_[g]) {
      const Index at = place_[column];
      right[at] = rest[static_cast<Index>(column)];
      matrix.emplace_back(at, at, 1 / h);
      for_entries(column, [&](std::size_t k) {
        if (group_of_[row(k)] == g) matrix.emplace_back(place_[row(k)], at, -values_[k]);
      });
    }
    const LinearFactors factors(n, matrix);
    if (factors.sign() <= 0) return std::nullopt;
    return factors.solve(right);
  }

  const network::Program& program_;
  network::Workspace& workspace_;
  double t_;
  const StateGroups& groups_;
  SwitchPlacing bends_;
  std::vector<double> values_;         ///< of the Jacobian
  std::vector<std::size_t> group_of_;  ///< of each state
  std::vector<Index> place_;           ///< of each state in its group
};

bool settle(const network::Program& program, network::Workspace& workspace, double t,
            const StateGroups& groups, std::vector<std::uint32_t> bends, std::vector<double>& states) {
  constexpr double kMostChange = 0.2;  // of 1 + |x|, in a step
  constexpr double kSmallChange = 0.02;
  constexpr double kLongest =
      1e18;  // of a step, in time constants of the fastest loop: nothing but Newton's method
  constexpr double kShortest = 1e-9;
  constexpr double kAtRest = 1e-12;   // rounding, where a loop has lost most of its gain
  constexpr double kNothing = 1e-17;  // of 1 + |x|
  constexpr double kFarAway = 1e6;    // [machine unit]
  constexpr int kMostSteps = 600;     // the longest way known to a rest took 330
  Settling system(program, workspace, t, groups, std::move(bends));
  const auto n = static_cast<Index>(states.size());
  VectorXd x = VectorXd::Map(states.data(), n), derivatives(n), next(n), next_derivatives(n);
  if (!system.derivatives(x, derivatives) || !system.linearise(x)) return false;
  const double unit = system.fastest_time_constant();
  // Where a loop has no gain yet, its fastest time constant says nothing about how fast it moves.
  const auto step_of_change = [&] {
    return kMostChange / (derivatives.array().abs() / (1 + x.array().abs())).maxCoeff();
  };
  double h = std::min(unit, step_of_change());
  double shortest = kShortest * h;
  double last = 1;
  for (int step = 0; step < kMostSteps && h > shortest; ++step) {
    const auto moved = system.step(h, derivatives);
    bool good = moved.has_value();
    double change = 0;
    if (good) {
      next = x + *moved;
      change = (moved->array() / (1 + x.array().abs())).abs().maxCoeff();
      good =
          change < kMostChange && system.derivatives(next, next_derivatives) && next_derivatives.allFinite();
    }
    if (!good) {
      h /= 4;
      continue;
    }
    // Rounding has been reached: the steps become no shorter, or move nothing.
    if (h >= kLongest * unit && change < kAtRest && (change >= last || change < kNothing)) {
      // Out of an unstable equilibrium rounding would grow.
      next = system.without_rounding(x, kAtRest);
      if (system.derivatives(next, next_derivatives) &&
          next_derivatives.cwiseAbs().maxCoeff() <= derivatives.cwiseAbs().maxCoeff())
        VectorXd::Map(states.data(), n) = next;
      return true;
    }
    x = next;
    derivatives = next_derivatives;
    VectorXd::Map(states.data(), n) = x;
    shortest = kShortest * std::min(unit, step_of_change());
    if (system.farthest(x) > kFarAway || !system.linearise(x)) return false;
    last = change;
    if (change < kSmallChange) {
      h *= 10;
    } else if (change < kMostChange / 2) {
      h *= 2;
    }
  }
  return false;
}

}  // namespace

bool settle(const network::Program& program, network::Workspace& workspace, double t,
            const StateGroups& groups, std::vector<double>& states) {
  const std::vector<std::uint32_t> bends = bends_of(program);
  if (!bends.empty()) {
    const std::vector<double> before(workspace.discrete_states().begin(), workspace.discrete_states().end());
    std::vector<double> moved = states;
    if (settle(program, workspace, t, groups, bends, moved)) {
      states = std::move(moved);
      return true;
    }
    workspace.load_discrete_states(before);  // a rest at a bend has no side of its own
  }
  return settle(program, workspace, t, groups, {}, states);
}

}  // namespace oblique::solve
