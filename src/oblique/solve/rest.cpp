// SPDX-License-Identifier: MIT
#include <oblique/solve/rest.h>

#include <algorithm>
#include <cmath>

#include <Eigen/SparseLU>

#include <oblique/network/dependency_order.h>
#include <oblique/solve/cvodes_solver.h>
#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

/// The diagram with its clock stopped: only some states move.
class SettlingSystem final : public OdeSystem {
 public:
  SettlingSystem(const Program& program, Workspace& workspace, double t, const std::vector<std::size_t>& moving)
      : program_(program), workspace_(workspace), t_(t), moves_(program.n_states(), false) {
    for (const std::size_t i : moving) moves_[i] = true;
  }

  std::size_t size() const override { return program_.n_states(); }
  const SparsePattern& pattern() const override { return program_.jacobian_pattern(); }

  bool derivatives(double, const double* x, double* dxdt) override {
    if (!program_.derivatives(t_, x, dxdt, workspace_)) return false;
    for (std::size_t i = 0; i < moves_.size(); ++i) {
      if (!moves_[i]) dxdt[i] = 0;
    }
    return true;
  }

  bool jacobian(double, const double* x, double* values) override {
    if (!program_.jacobian(t_, x, values, workspace_)) return false;
    const SparsePattern& p = pattern();
    for (std::size_t k = 0; k < p.entries(); ++k) {
      if (!moves_[static_cast<std::size_t>(p.rows[k])]) values[k] = 0;
    }
    return true;
  }

  /// df/dx with −1 on the diagonal of held states, whose Newton step is then zero.
  SparseMatrix newton_matrix(const double* x) {
    const SparsePattern& p = pattern();
    std::vector<double> values(p.entries());
    if (!jacobian(0, x, values.data())) return {};
    for (std::size_t column = 0; column < p.size(); ++column) {
      for (auto k = p.column_starts[column]; k < p.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        if (!moves_[column] && static_cast<std::size_t>(p.rows[entry]) == column) values[entry] = -1;
      }
    }
    const auto n = static_cast<Eigen::Index>(p.size());
    return Eigen::Map<const SparseMatrix>(n, n, static_cast<Eigen::Index>(p.entries()), p.column_starts.data(),
                                          p.rows.data(), values.data());
  }

 private:
  const Program& program_;
  Workspace& workspace_;
  double t_;
  std::vector<bool> moves_;
};

/// Newton's method on dx/dt = 0, from nearby only: gives up on a first step that is not small. True: `states` are at
/// rest to rounding.
bool polish(SettlingSystem& system, std::vector<double>& states) {
  constexpr double kNearby = 1e-2;
  constexpr double kAtRest = 1e-12;      // rounding, where a loop has lost most of its gain
  constexpr int kMostIterations = 50;    // a lost gain makes it halve its error a step
  const auto n = static_cast<Eigen::Index>(states.size());
  Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(states.data(), n);
  Eigen::VectorXd slopes(n);
  double last = kNearby;
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    if (!system.derivatives(0, x.data(), slopes.data())) return false;
    const SparseMatrix matrix = system.newton_matrix(x.data());
    Eigen::SparseLU<SparseMatrix> lu;
    lu.compute(matrix);
    if (matrix.rows() != n || lu.info() != Eigen::Success) return false;
    const Eigen::VectorXd step = -lu.solve(slopes);
    if (!step.allFinite()) return false;
    const double size = (step.array() / (1 + x.array().abs())).abs().maxCoeff();
    if (size > last) break;  // far away, or rounding has been reached
    x += step;
    last = size;
    if (size < 1e-15) break;
  }
  if (last > kAtRest) return false;
  std::copy(x.begin(), x.end(), states.begin());
  return true;
}

/// Of the moving states, the fastest first.
std::vector<std::size_t> by_speed(SettlingSystem& system, std::vector<std::size_t> order,
                                  const std::vector<double>& states) {
  std::vector<double> slopes(states.size(), 0.0);
  system.derivatives(0, states.data(), slopes.data());
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return std::abs(slopes[a]) > std::abs(slopes[b]); });
  return order;
}

/// Time constant of the fastest loop [s], from the diagonal of the Jacobian.
double fastest_time_constant(SettlingSystem& system, const std::vector<double>& states) {
  const SparsePattern& p = system.pattern();
  std::vector<double> values(p.entries(), 0.0);
  system.jacobian(0, states.data(), values.data());
  double rate = 0;
  for (const double value : values) {
    if (std::isfinite(value)) rate = std::max(rate, std::abs(value));
  }
  return rate > 0 ? 1 / rate : 1;
}

/// Lets the states in `moving` run until Newton's method finds them at rest nearby. False, with `states` as they were
/// last, where they do not settle.
bool settle(const Program& program, Workspace& workspace, double t, const std::vector<std::size_t>& moving,
            std::vector<double>& states) {
  // Loops differ in speed by orders of magnitude: each time wait ten times longer.
  constexpr int kMostDecades = 18;
  constexpr long kMostSteps = 20'000;
  SettlingSystem system(program, workspace, t, moving);
  double wait = fastest_time_constant(system, states);
  for (int decade = 0; decade < kMostDecades; ++decade, wait *= 10) {
    try {
      CvodesSolver solver(system, 0, states, wait, {1e-6, 1e-6, kMostSteps});
      while (solver.step() < wait) {
      }
      std::copy(solver.states().begin(), solver.states().end(), states.begin());
    } catch (const SolverFailure&) {
      return false;
    }
    if (polish(system, states)) return true;
  }
  return false;
}

/// Groups of servo states that act on each other, each after the groups whose signals it follows.
std::vector<std::vector<std::size_t>> groups_in_order(const Program& program) {
  const std::vector<std::size_t> servos = rest_states(program);
  std::vector<std::uint32_t> place(program.n_states(), 0);
  std::vector<bool> is_servo(program.n_states(), false);
  for (std::size_t i = 0; i < servos.size(); ++i) {
    place[servos[i]] = static_cast<std::uint32_t>(i);
    is_servo[servos[i]] = true;
  }
  std::vector<std::vector<std::uint32_t>> needed(servos.size());
  const SparsePattern& pattern = program.jacobian_pattern();
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)]);
      if (is_servo[row] && is_servo[column]) needed[place[row]].push_back(place[column]);
    }
  }
  Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);
  std::vector<std::vector<std::size_t>> groups;
  for (const OrderStep& step : dependency_order(dependencies, std::vector<bool>(servos.size(), true))) {
    std::vector<std::size_t>& group = groups.emplace_back();
    for (const std::uint32_t member : step.tears) group.push_back(servos[member]);
  }
  return groups;
}

}  // namespace

std::vector<std::size_t> rest_states(const Program& program) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    if (program.states()[i].at_rest) found.push_back(i);
  }
  return found;
}

void bring_to_rest(const Program& program, Workspace& workspace, double t, std::vector<double>& states,
                   const std::string& file) {
  if (rest_states(program).empty()) return;
  SettlingSystem all(program, workspace, t, rest_states(program));
  std::vector<double> slopes(states.size());
  if (!all.derivatives(t, states.data(), slopes.data())) throw loop_error(program, workspace.trouble(), t, file);

  // All at once, as on the machine. A loop that follows others may be driven over its edge while those still move (a
  // triangle that does not close for a moment): then one group after the other, along the flow of the signals.
  std::vector<double> settled = states;
  if (settle(program, workspace, t, rest_states(program), settled)) {
    states = settled;
    return;
  }
  workspace.reset();
  for (const std::vector<std::size_t>& group : groups_in_order(program)) {
    if (settle(program, workspace, t, group, states)) continue;
    SettlingSystem system(program, workspace, t, group);
    throw rest_error(program, by_speed(system, group, states), states, file);
  }
}

}  // namespace oblique
