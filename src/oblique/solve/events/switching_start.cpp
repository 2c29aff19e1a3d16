// SPDX-License-Identifier: MIT
#include <oblique/solve/events/switching_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr const char* kCut =
    "give one of them a fixed 'initial', or cut the circle at the start with an electronic-switch";

/// "the initial values of 'a' and 'b' follow from each other in a circle"
std::string circle_of(const network::Program& program, const std::vector<std::size_t>& states) {
  std::vector<std::string> quoted;
  quoted.reserve(states.size());
  for (const std::size_t i : states) quoted.push_back(fmt::format("'{}'", program.states()[i].name));
  return fmt::format("the initial values of {} follow from each other in a circle",
                     shortened(std::move(quoted)));
}

}  // namespace

SolveError starts_in_circle(const network::Program& program, const std::vector<std::size_t>& states, double t,
                            const std::string& file) {
  return {SolveError::Kind::no_rest,
          t,
          {{file, {}}, circle_of(program, states), "initial values that agree", kCut}};
}

void take_starts(const network::Program& program, network::Workspace& workspace, double t,
                 std::vector<double>& x, EventLog& log, const std::string& file) {
  constexpr double kUnitRounding = std::numeric_limits<double>::epsilon();
  constexpr long kMostRoundsInCircle = 10'000;  // each may bring them nearer by a thousandth only
  constexpr long kRoundsToJudge = 100;          // of which a thousandth each leaves nine tenths
  constexpr double kNearer = 0.95;
  constexpr double kRunsAway = 1e6;  // times as far as at first
  const long starts = std::count_if(program.states().begin(), program.states().end(),
                                    [](const network::State& state) { return state.start_node.has_value(); });
  std::vector<double> signals(program.n_signals());
  std::vector<std::size_t> circle;
  // A loop may have no solution, or another one, for as long as states are not there that start from signals:
  // it is passed over, and sought anew from where it stood once they are.
  std::vector<double> unknowns;
  for (std::size_t u = 0; u < program.unknowns().size(); ++u) unknowns.push_back(workspace.unknown(u));
  bool changes = true, finite = true, there = false, moved = false, nearer = true;
  double change = 0, first_change = 0, judged = std::numeric_limits<double>::infinity();
  for (long round = 0; changes && finite && nearer && round <= starts + kMostRoundsInCircle; ++round) {
    workspace.pass_failing_loops(!there);
    const auto here = program.signals(t, x.data(), signals.data(), workspace);
    workspace.pass_failing_loops(false);
    if (!here) throw loop_error(program, workspace.trouble(), t, file);
    changes = false;
    change = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto value = here->start_value(i);
      if (!value) continue;
      const bool same = std::abs(*value - x[i]) <= 4 * kUnitRounding * (1 + std::abs(*value));
      if (same && std::isfinite(*value)) continue;
      changes = true;
      change = std::max(change, std::abs(*value - x[i]));
      finite = finite && std::isfinite(*value);
      // A chain of starts is through after as many rounds as it is long.
      if (round > starts && std::find(circle.begin(), circle.end(), i) == circle.end()) circle.push_back(i);
      if (!finite && circle.empty()) {
        throw SolveError(SolveError::Kind::blow_up, t,
                         {{file, {}},
                          fmt::format("'{}' would start at {}, which the signals at its start give",
                                      program.states()[i].name, *value),
                          "a finite initial value",
                          "look for a division by zero or a logarithm of zero before it"});
      }
      x[i] = *value;
    }
    moved = moved || changes;
    if (round <= starts) first_change = 1 + change;
    if (round > starts && round % kRoundsToJudge == 0) {
      nearer = change < kNearer * judged;
      judged = change;
    }
    nearer = nearer && change < kRunsAway * first_change;
    if (changes || std::exchange(there, true)) continue;
    for (std::size_t u = 0; moved && u < unknowns.size(); ++u) workspace.set_unknown(u, unknowns[u]);
    changes = true;  // as the next rounds may show, in which every loop is to have its solution
    round = -1;
    judged = std::numeric_limits<double>::infinity();
  }
  if (circle.empty()) return;
  std::sort(circle.begin(), circle.end());
  if (changes) throw starts_in_circle(program, circle, t, file);
  const network::State& first = program.states()[circle.front()];
  log.warn({{file, {}},
            fmt::format("{}: the run begins where they agree, at {} = {:.6g}", circle_of(program, circle),
                        first.name, x[circle.front()]),
            {},
            kCut});
}

bool rests_within_limits(const network::Program& program, network::Workspace& workspace,
                         EventFunctions& event_functions, const Announced& announced, double t,
                         std::vector<double>& x, const std::function<void()>& bring_to_rest) {
  if (rest_states(program).empty()) return false;  // a loop without any keeps to the limit at which it begins
  const std::vector<double> states = x;
  const std::vector<double> discrete_states(workspace.discrete_states().begin(),
                                            workspace.discrete_states().end());
  bool any = false;
  for (const network::Switch& made : program.switches()) {
    if (made.turning != network::Turning::limits || workspace.discrete_state(made.discrete_state) == 0)
      continue;
    workspace.set_discrete_state(made.discrete_state, 0);
    any = true;
  }
  if (!any) return false;
  try {
    bring_to_rest();
    event_functions.evaluate(t, x, announced);
    bool within = true;
    for (std::size_t s = 0; s < event_functions.size(); ++s)
      within = within && (program.switches()[s].turning != network::Turning::limits ||
                          event_functions[s] <= event_functions.thresholds()[s]);
    if (within) return true;
  } catch (const SolveError&) {  // what lies between the limits has no rest; they may make one
  }
  x = states;
  for (std::size_t m = 0; m < discrete_states.size(); ++m)
    workspace.set_discrete_state(m, discrete_states[m]);
  return false;
}

}  // namespace oblique::solve
