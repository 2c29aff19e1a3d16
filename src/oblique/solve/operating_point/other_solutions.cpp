// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/other_solutions.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/loop_jumps.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// After so many for each loop, which take some tenths of a second, no other points are tried.
constexpr std::size_t kMostEvaluations = 300'000;

LoopStart point(const network::Program& program, std::size_t loop, int k) {
  return {loop, loop_point(program, loop, k), false};
}

/// What stands otherwise in another solution.
struct Difference {
  std::string name;
  double here = 0, there = 0;
};

/// An unknown of the loop that differs between two solutions, or a signal where only switches on it do.
std::optional<Difference> find_difference(const network::Program& program, std::size_t loop,
                                          const StartOutcome& solution, const StartOutcome& other) {
  constexpr double kOther = 1e-4;  // of 1 + |z|: far beyond what is left of Newton's method at a double root
  const auto differ = [](double a, double b) { return std::abs(b - a) > kOther * (1 + std::abs(a)); };
  for (const std::size_t u : program.loops()[loop].unknowns) {
    const double here = solution.unknowns[u], there = other.unknowns[u];
    if (differ(here, there)) return Difference{program.unknowns()[u].name, here, there};
  }
  for (std::size_t s = 0; s < solution.signals.size(); ++s) {
    const double here = solution.signals[s], there = other.signals[s];
    if (differ(here, there)) return Difference{program.signal_names()[s], here, there};
  }
  return std::nullopt;
}

/// Whether an element of the loop is beyond the range that is searched: which of them is the unknown must not
/// matter.
bool leaves_reach(const network::Program& program, std::size_t loop, const std::vector<double>& signals) {
  for (const std::string& member : program.loops()[loop].members) {
    for (std::size_t s = 0; s < signals.size(); ++s) {
      const std::string& name = program.signal_names()[s];
      const bool of_member = name == member || name.starts_with(member + ".");
      if (of_member && std::abs(signals[s]) > kLoopReach) return true;
    }
  }
  return false;
}

text::Diagnostic several_solutions(const network::Program& program, std::size_t loop, double t,
                                   const std::string& file, const Difference& difference) {
  std::vector<std::string> members;
  for (const std::string& member : program.loops()[loop].members) members.push_back("'" + member + "'");
  return {
      {file, {}},
      fmt::format("the algebraic loop of {} has several solutions: at t = {:.6g} s the run begins with {} = "
                  "{:.6g}, and {:.6g} is another; nothing in the diagram chooses between them",
                  shortened(std::move(members)), t, difference.name, difference.here, difference.there),
      {},
      "put a servo amplifier with an 'initial', or a lag, into the loop: where it starts from chooses"};
}

}  // namespace

StartChoice choose_start(const network::Program& program, double t, const std::string& file,
                         const std::function<StartAttempt(const LoopStart&)>& start) {
  StartChoice choice;
  std::vector<std::size_t> blind;
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    if (may_have_several(program, loop)) blind.push_back(loop);
  }
  if (blind.empty()) return choice;
  const std::size_t most_evaluations = kMostEvaluations * program.loops().size();
  std::size_t evaluations = 0;
  const auto outcome = [&](const LoopStart& from) {
    StartAttempt attempt = start(from);
    evaluations += attempt.loop_evaluations;
    return std::move(attempt.outcome);
  };
  std::optional<StartOutcome> solution = outcome({});
  for (const std::size_t loop : blind) {
    for (int k = 1; k <= kLoopPoints && !solution && evaluations < most_evaluations; ++k) {
      choice.from = point(program, loop, k);
      choice.from.goes = true;
      solution = outcome(choice.from);
    }
  }
  if (!solution) return {};
  for (const std::size_t loop : blind) {
    for (int k = 1; k <= kLoopPoints && solution->runs_away[loop] && evaluations < most_evaluations; ++k) {
      LoopStart from = point(program, loop, k);
      from.goes = true;
      auto other = outcome(from);
      if (!other || other->runs_away[loop]) continue;
      choice.from = std::move(from);
      solution = std::move(other);
    }
  }
  for (const std::size_t loop : blind) {
    const bool is_far = leaves_reach(program, loop, solution->signals);
    for (int k = 1; k <= kLoopPoints && evaluations < most_evaluations; ++k) {
      const auto other = outcome(point(program, loop, k));
      if (!other || (!is_far && leaves_reach(program, loop, other->signals))) continue;
      const auto difference = find_difference(program, loop, *solution, *other);
      if (!difference) continue;
      choice.warnings.push_back(several_solutions(program, loop, t, file, *difference));
      break;
    }
  }
  return choice;
}

}  // namespace oblique::solve
