// SPDX-License-Identifier: MIT
#include <oblique/solve/rest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/SparseLU>

#include <oblique/network/dependency_order.h>
#include <oblique/solve/coupled_modes.h>
#include <oblique/solve/ode_system.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability.h>

namespace oblique {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, std::int64_t>;

/// The diagram with its clock stopped: only some states move.
class SettlingSystem final : public OdeSystem {
 public:
  SettlingSystem(const Program& program, Workspace& workspace, double t,
                 const std::vector<std::size_t>& moving)
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

  /// 1/h − df/dx: the matrix of an implicit Euler step. Held states have 1/h alone, so that they stay.
  SparseMatrix step_matrix(const double* x, double h) {
    const SparsePattern& p = pattern();
    std::vector<double> values(p.entries());
    if (!jacobian(0, x, values.data())) return {};
    for (std::size_t column = 0; column < p.size(); ++column) {
      for (auto k = p.column_starts[column]; k < p.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        values[entry] = (static_cast<std::size_t>(p.rows[entry]) == column ? 1 / h : 0) - values[entry];
      }
    }
    const auto n = static_cast<Eigen::Index>(p.size());
    return Eigen::Map<const SparseMatrix>(n, n, static_cast<Eigen::Index>(p.entries()),
                                          p.column_starts.data(), p.rows.data(), values.data());
  }

 private:
  const Program& program_;
  Workspace& workspace_;
  double t_;
  std::vector<bool> moves_;
};

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

/// Lets the states in `moving` run until they rest: implicit Euler steps, short at first so that they follow
/// the way the loops take, then ever longer until they are Newton's method (pseudo-transient continuation). A
/// step that changes a state much, or across which 1/h − df/dx changes the sign of its determinant (there a
/// loop is unstable), is taken again shorter. False, with `states` as they were last, where they do not
/// settle.
bool settle(const Program& program, Workspace& workspace, double t, const std::vector<std::size_t>& moving,
            std::vector<double>& states) {
  constexpr double kMostChange = 0.2;  // of 1 + |x|, in a step
  constexpr double kSmallChange = 0.02;
  constexpr double kLongest =
      1e18;  // of a step, in time constants of the fastest loop: nothing but Newton's method
  constexpr double kShortest = 1e-9;
  constexpr double kAtRest = 1e-12;   // rounding, where a loop has lost most of its gain
  constexpr double kNothing = 1e-17;  // of 1 + |x|
  constexpr double kFarAway = 1e6;    // [machine unit]
  constexpr int kMostSteps = 2000;
  SettlingSystem system(program, workspace, t, moving);
  const double unit = fastest_time_constant(system, states);
  const auto n = static_cast<Eigen::Index>(states.size());
  Eigen::Map<Eigen::VectorXd> x(states.data(), n);
  Eigen::VectorXd slopes(n), next(n), next_slopes(n);
  if (!system.derivatives(0, x.data(), slopes.data())) return false;
  Eigen::SparseLU<SparseMatrix> lu;
  // Where a loop has no gain yet, its fastest time constant says nothing about how fast it moves.
  const auto step_of_change = [&] {
    return kMostChange / (slopes.array().abs() / (1 + x.array().abs())).maxCoeff();
  };
  double h = std::min(unit, step_of_change());
  double shortest = kShortest * h;
  double last = 1;
  for (int step = 0; step < kMostSteps && h > shortest; ++step) {
    const SparseMatrix matrix = system.step_matrix(x.data(), h);
    if (matrix.rows() != n) return false;
    lu.compute(matrix);
    bool good = lu.info() == Eigen::Success && lu.signDeterminant() > 0;
    double change = 0;
    if (good) {
      next = x + lu.solve(slopes);
      change = ((next - x).array() / (1 + x.array().abs())).abs().maxCoeff();
      good = change < kMostChange && system.derivatives(0, next.data(), next_slopes.data()) &&
             next_slopes.allFinite();
    }
    if (!good) {
      h /= 4;
      continue;
    }
    // Rounding has been reached: the steps become no shorter, or move nothing.
    if (h >= kLongest * unit && change < kAtRest && (change >= last || change < kNothing)) return true;
    x = next;
    slopes = next_slopes;
    shortest = kShortest * std::min(unit, step_of_change());
    if (x.cwiseAbs().maxCoeff() > kFarAway) return false;
    last = change;
    if (change < kSmallChange) {
      h *= 10;
    } else if (change < kMostChange / 2) {
      h *= 2;
    }
  }
  return false;
}

/// The states that `group` acts on and that act on it, all of them: where its loops close. Sorted.
std::vector<std::size_t> closed_loop(const Program& program, const std::vector<std::size_t>& group) {
  const SparsePattern& pattern = program.jacobian_pattern();
  std::vector<std::vector<std::uint32_t>> needed(program.n_states());
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      needed[static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])].push_back(
          static_cast<std::uint32_t>(column));
    }
  }
  Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);
  for (const OrderStep& step : dependency_order(dependencies, std::vector<bool>(program.n_states(), true))) {
    std::vector<std::size_t> loop(step.tears.begin(), step.tears.end());
    std::sort(loop.begin(), loop.end());
    if (std::binary_search(loop.begin(), loop.end(), group.front())) return loop;
  }
  return group;
}

/// Largest real part [1/s] of the eigenvalues of these states with all others held; NaN where the equations
/// have no linearisation, or those that act on each other are too many.
double largest_real_part(const Program& program, Workspace& workspace, double t,
                         const std::vector<std::size_t>& members, const std::vector<double>& states) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> values(program.jacobian_pattern().entries());
  if (!program.jacobian(t, states.data(), values.data(), workspace)) return kUnknown;
  std::vector<bool> moves(program.n_states(), false);
  for (const std::size_t member : members) moves[member] = true;
  double largest = -std::numeric_limits<double>::infinity();
  for (const CoupledModes& group : coupled_modes(program.jacobian_pattern(), values, moves)) {
    if (group.eigenvalues.empty()) return kUnknown;
    for (const std::complex<double>& mode : group.eigenvalues) largest = std::max(largest, mode.real());
  }
  return largest;
}

/// Whether a group that does not come to rest by itself is held by the rest of its closed loop: what is left
/// of its growth there is nothing beside its own (a problem may grow, but not at the speed of an amplifier).
/// Judged where the whole loop rests; or at the start, for a group that is unstable by itself.
bool settles_when_let_loose(const Program& program, Workspace& workspace, double t,
                            const std::vector<std::size_t>& group, const std::vector<std::size_t>& loop,
                            const std::vector<double>& states) {
  constexpr double kNothing = 1e-3;
  if (loop.size() <= group.size()) return false;
  workspace.reset();
  const double alone = largest_real_part(program, workspace, t, group, states);
  if (alone > 0 && largest_real_part(program, workspace, t, loop, states) < kNothing * alone) return true;
  std::vector<double> loose = states;
  const bool held = settle(program, workspace, t, loop, loose) &&
                    largest_real_part(program, workspace, t, loop, loose) < kNothing * std::max(alone, 0.0);
  workspace.reset();
  return held;
}

Diagnostic loose_start(const Program& program, const std::vector<std::size_t>& group,
                       const std::vector<std::size_t>& loop, const std::vector<double>& states,
                       const std::string& file) {
  const auto name = [&](std::size_t i) { return fmt::format("'{}'", program.states()[i].name); };
  std::vector<std::string> servos, through;
  for (const std::size_t i : group) servos.push_back(fmt::format("{} at {:.4g}", name(i), states[i]));
  for (const std::size_t i : loop) {
    if (std::find(group.begin(), group.end(), i) == group.end()) through.push_back(name(i));
  }
  return {{file, {}},
          fmt::format("the run does not start at rest: {} cannot settle before the clock starts, because {} "
                      "closes through {}, which {} held until then; the closed loop is stable, and the run "
                      "begins with its transient",
                      fmt::join(servos, ", "), group.size() == 1 ? "its loop" : "their loop",
                      shortened(through), through.size() == 1 ? "is" : "are"),
          {},
          "give the amplifier the 'initial' that it shall start from"};
}

}  // namespace

std::vector<std::size_t> rest_states(const Program& program) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    if (program.states()[i].at_rest) found.push_back(i);
  }
  return found;
}

std::vector<std::vector<std::size_t>> servo_groups(const Program& program) {
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

std::vector<Diagnostic> bring_to_rest(const Program& program, Workspace& workspace, double t,
                                      std::vector<double>& states, const std::string& file) {
  if (rest_states(program).empty()) return {};
  SettlingSystem all(program, workspace, t, rest_states(program));
  std::vector<double> slopes(states.size());
  if (!all.derivatives(t, states.data(), slopes.data()))
    throw loop_error(program, workspace.trouble(), t, file);

  // All at once, as on the machine. A loop that follows others may be driven over its edge while those still
  // move (a triangle that does not close for a moment): then one group after the other, along the flow of the
  // signals.
  std::vector<double> settled = states;
  if (settle(program, workspace, t, rest_states(program), settled) &&
      unstable_group(program, workspace, t, settled).empty()) {
    states = settled;
    return {};
  }
  workspace.reset();
  std::vector<Diagnostic> warnings;
  for (const std::vector<std::size_t>& group : servo_groups(program)) {
    settled = states;
    if (settle(program, workspace, t, group, settled) &&
        !(largest_real_part(program, workspace, t, group, settled) > 0)) {
      states = settled;
      continue;
    }
    const std::vector<std::size_t> loop = closed_loop(program, group);
    if (!settles_when_let_loose(program, workspace, t, group, loop, states)) {
      SettlingSystem system(program, workspace, t, group);
      throw rest_error(program, by_speed(system, group, settled), settled, loop, file);
    }
    warnings.push_back(loose_start(program, group, loop, states, file));
  }
  return warnings;
}

}  // namespace oblique
