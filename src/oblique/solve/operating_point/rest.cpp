// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/rest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/network/graph/dependency_order.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/settling.h>
#include <oblique/solve/readings/switch_placing.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/coupled_modes.h>
#include <oblique/solve/stability/stability.h>

namespace oblique::solve {
namespace {

/// Of the moving states, the fastest first.
std::vector<std::size_t> by_speed(const network::Program& program, network::Workspace& workspace, double t,
                                  std::vector<std::size_t> order, const std::vector<double>& states) {
  std::vector<double> derivatives(states.size(), 0.0);
  program.derivatives(t, states.data(), derivatives.data(), workspace);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::abs(derivatives[a]) > std::abs(derivatives[b]);
  });
  return order;
}

/// The states that `group` acts on and that act on it, all of them: where its loops close. Sorted.
std::vector<std::size_t> closed_loop(const network::Program& program, const std::vector<std::size_t>& group) {
  const network::SparsePattern& pattern = program.jacobian_pattern();
  std::vector<std::vector<std::uint32_t>> needed(program.n_states());
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      needed[static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])].push_back(
          static_cast<std::uint32_t>(column));
    }
  }
  network::Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);
  for (const network::OrderStep& step :
       network::dependency_order(dependencies, std::vector<bool>(program.n_states(), true))) {
    std::vector<std::size_t> loop(step.tears.begin(), step.tears.end());
    std::sort(loop.begin(), loop.end());
    if (std::binary_search(loop.begin(), loop.end(), group.front())) return loop;
  }
  return group;
}

/// Largest real part [1/s] of the eigenvalues of these states with all others held; NaN where the equations
/// have no linearisation, or those that act on each other are too many.
double largest_real_part(const network::Program& program, network::Workspace& workspace, double t,
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
bool settles_when_let_loose(const network::Program& program, network::Workspace& workspace, double t,
                            const std::vector<std::size_t>& group, const std::vector<std::size_t>& loop,
                            const std::vector<double>& states) {
  constexpr double kNothing = 1e-3;
  if (loop.size() <= group.size()) return false;
  workspace.reset();
  const double alone = largest_real_part(program, workspace, t, group, states);
  if (alone > 0 && largest_real_part(program, workspace, t, loop, states) < kNothing * alone) return true;
  std::vector<double> loose = states;
  const bool held = settle(program, workspace, t, {loop}, loose) &&
                    largest_real_part(program, workspace, t, loop, loose) < kNothing * std::max(alone, 0.0);
  workspace.reset();
  return held;
}

text::Diagnostic loose_start(const network::Program& program, const std::vector<std::size_t>& group,
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
          "give the amplifier the 'initial' from which it is to start"};
}

}  // namespace

std::vector<std::size_t> rest_states(const network::Program& program) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    if (program.states()[i].at_rest) found.push_back(i);
  }
  return found;
}

std::vector<std::vector<std::size_t>> servo_groups(const network::Program& program) {
  const std::vector<std::size_t> servos = rest_states(program);
  std::vector<std::uint32_t> place(program.n_states(), 0);
  std::vector<bool> is_servo(program.n_states(), false);
  for (std::size_t i = 0; i < servos.size(); ++i) {
    place[servos[i]] = static_cast<std::uint32_t>(i);
    is_servo[servos[i]] = true;
  }
  std::vector<std::vector<std::uint32_t>> needed(servos.size());
  const network::SparsePattern& pattern = program.jacobian_pattern();
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
      const auto row = static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)]);
      if (is_servo[row] && is_servo[column]) needed[place[row]].push_back(place[column]);
    }
  }
  network::Dependencies dependencies;
  for (const auto& row : needed) dependencies.add_row(row);
  std::vector<std::vector<std::size_t>> groups;
  for (const network::OrderStep& step :
       network::dependency_order(dependencies, std::vector<bool>(servos.size(), true))) {
    std::vector<std::size_t>& group = groups.emplace_back();
    for (const std::uint32_t member : step.tears) group.push_back(servos[member]);
  }
  return groups;
}

std::vector<text::Diagnostic> bring_to_rest(const network::Program& program, network::Workspace& workspace,
                                            double t, std::vector<double>& states, const std::string& file) {
  if (rest_states(program).empty()) return {};
  std::vector<double> derivatives(states.size());
  if (!program.derivatives(t, states.data(), derivatives.data(), workspace))
    throw loop_error(program, workspace.trouble(), t, file);

  // All at once, as on the machine. A loop that follows others may be driven over its edge while those still
  // move (a triangle that does not close for a moment): then one group after the other, along the flow of the
  // signals.
  const StateGroups groups = servo_groups(program);
  std::vector<double> settled = states;
  if (settle(program, workspace, t, groups, settled) &&
      unstable_group(program, workspace, t, settled).empty()) {
    states = settled;
    return {};
  }
  workspace.reset();
  std::vector<text::Diagnostic> warnings;
  for (const std::vector<std::size_t>& group : groups) {
    settled = states;
    if (settle(program, workspace, t, {group}, settled) &&
        !(largest_real_part(program, workspace, t, group, settled) > 0)) {
      states = settled;
      continue;
    }
    const std::vector<std::size_t> loop = closed_loop(program, group);
    if (!settles_when_let_loose(program, workspace, t, group, loop, states)) {
      throw rest_error(program, by_speed(program, workspace, t, group, settled), settled, loop, file);
    }
    warnings.push_back(loose_start(program, group, loop, states, file));
  }
  return warnings;
}

bool rest_past_loops(const network::Program& program, network::Workspace& workspace, double t,
                     std::vector<double>& states) {
  if (rest_states(program).empty()) return false;
  std::vector<double> settled = states;
  workspace.pass_failing_loops(true);
  const bool rests = settle(program, workspace, t, servo_groups(program), settled);
  workspace.pass_failing_loops(false);
  if (rests) states = settled;
  return rests;
}

std::optional<std::vector<text::Diagnostic>> rest_where_they_run(const network::Program& program,
                                                                 network::Workspace& workspace, double t,
                                                                 std::vector<double>& states,
                                                                 const std::string& file) {
  constexpr double kFarAway = 100;  // [machine unit]
  const std::vector<double> discrete_states(workspace.discrete_states().begin(),
                                            workspace.discrete_states().end());
  std::vector<double> moved = states;
  settle(program, workspace, t, servo_groups(program), moved);
  bool runs = false;
  for (std::size_t i = 0; i < moved.size(); ++i) runs = runs || std::abs(moved[i] - states[i]) > kFarAway;
  std::vector<std::uint32_t> switches(program.switches().size());
  std::iota(switches.begin(), switches.end(), 0);
  try {
    if (runs && SwitchPlacing(program, std::move(switches)).place(t, moved.data(), workspace)) {
      std::vector<text::Diagnostic> warnings = bring_to_rest(program, workspace, t, moved, file);
      states = moved;
      return warnings;
    }
  } catch (const SolveError&) {  // nothing holds them
  }
  workspace.reset();
  workspace.load_discrete_states(discrete_states);
  return std::nullopt;
}

}  // namespace oblique::solve
