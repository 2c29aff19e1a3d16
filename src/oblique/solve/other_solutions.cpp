// SPDX-License-Identifier: MIT
#include <oblique/solve/other_solutions.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

bool chooses_blindly(const Program& program, std::size_t loop) {
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  return !program.loop_is_linear(loop) && std::all_of(unknowns.begin(), unknowns.end(), [&](std::size_t u) {
    return program.unknowns()[u].torn;
  });
}

/// Point k of an even sequence in (−1, 1)^n, coordinate i: multiples of the powers of the root of
/// g^(n + 1) = g + 1 (Roberts), which is the golden ratio for n = 1.
double even_point(int k, std::size_t i, std::size_t n) {
  double g = 2;
  for (int round = 0; round < 30; ++round) g = std::pow(1 + g, 1 / static_cast<double>(n + 1));
  const double multiple = k * std::pow(g, -static_cast<double>(i + 1));
  return 2 * (multiple - std::floor(multiple)) - 1;
}

/// An unknown of the loop that differs from what it was in `solution`.
std::optional<std::size_t> changed(const Program& program, const Workspace& workspace, std::size_t loop,
                                   const std::vector<double>& solution) {
  constexpr double kOther = 1e-4;  // of 1 + |z|: far beyond what is left of Newton's method at a double root
  for (const std::size_t u : program.loops()[loop].unknowns) {
    if (std::abs(workspace.unknown(u) - solution[u]) > kOther * (1 + std::abs(solution[u]))) return u;
  }
  return std::nullopt;
}

}  // namespace

std::vector<Diagnostic> other_solutions(const Program& program, Workspace& workspace, double t,
                                        const std::vector<double>& states, const std::string& file) {
  constexpr int kPoints = 24;
  constexpr double kReach = 3;  // [machine unit]
  std::vector<Diagnostic> warnings;
  std::vector<double> solution(program.unknowns().size()), signals(program.n_signals());
  for (std::size_t u = 0; u < solution.size(); ++u) solution[u] = workspace.unknown(u);
  const auto restore = [&] {
    for (std::size_t u = 0; u < solution.size(); ++u) workspace.set_unknown(u, solution[u]);
  };
  bool tried = false;
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    if (!chooses_blindly(program, loop)) continue;
    const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
    for (int k = 1; k <= kPoints; ++k) {
      tried = true;
      restore();
      for (std::size_t i = 0; i < unknowns.size(); ++i)
        workspace.set_unknown(unknowns[i], kReach * even_point(k, i, unknowns.size()));
      if (!program.signals(t, states.data(), signals.data(), workspace)) continue;
      const auto other = changed(program, workspace, loop, solution);
      if (!other) continue;
      std::vector<std::string> members;
      for (const std::string& member : program.loops()[loop].members) members.push_back("'" + member + "'");
      warnings.push_back(
          {{file, {}},
           fmt::format(
               "the algebraic loop of {} has several solutions: at t = {:.6g} s the run begins with {} = "
               "{:.6g}, and {:.6g} is another; nothing in the diagram chooses between them",
               shortened(std::move(members)), t, program.unknowns()[*other].name, solution[*other],
               workspace.unknown(*other)),
           {},
           "put a servo amplifier with an 'initial', or a lag, into the loop: where it starts from chooses"});
      break;
    }
  }
  restore();
  if (tried) program.signals(t, states.data(), signals.data(), workspace);
  return warnings;
}

}  // namespace oblique
