// SPDX-License-Identifier: MIT
#include <oblique/solve/operating_point/run_start.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/operating_point/rest.h>
#include <oblique/solve/operating_point/singular_start.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

void refuse_singular_rates(const StartParts& parts, double t, const std::vector<double>& derivatives) {
  for (std::size_t i = 0; i < derivatives.size(); ++i) {
    if (std::isfinite(derivatives[i])) continue;
    throw SolveError(
        SolveError::Kind::blow_up, t,
        {{parts.diagram.file, {}},
         fmt::format("the rate of '{}' is no finite number where the run starts, at t = {:.6g} s",
                     parts.program.states()[i].name, t),
         "equations that have a value there",
         "start a little beside it, or write a quotient of zeros as its limit, with an if(…) in a block"});
  }
}

/// An amplifier that stands at a limit that is the machine's: what runs to it is a loop that the machine does
/// not hold, which is to be told. (One that the diagram gives is meant.)
const diagram::FlatBlock* find_saturated(const StartParts& parts, const std::vector<double>& states) {
  constexpr double kAt = 1e-6;  // of the limit
  const auto is_saturated = [&](const diagram::FlatBlock& block) {
    if (!block.saturation) return false;
    for (std::size_t i = 0; i < states.size(); ++i) {
      const std::string& name = parts.program.states()[i].name;
      const bool is_own = name == block.path || name.starts_with(block.path + ".");
      if (is_own && std::abs(states[i]) >= (1 - kAt) * block.parameters[*block.saturation]) return true;
    }
    return false;
  };
  const std::vector<diagram::FlatBlock>& blocks = parts.diagram.blocks;
  const auto found = std::find_if(blocks.begin(), blocks.end(), is_saturated);
  return found == blocks.end() ? nullptr : &*found;
}

}  // namespace

std::vector<text::Diagnostic> settle_start(const StartParts& parts, double t, std::vector<double>& states) {
  const network::Program& program = parts.program;
  const std::string& file = parts.diagram.file;
  if (parts.loop_start.loop) {
    const std::vector<std::size_t>& unknowns = program.loops()[*parts.loop_start.loop].unknowns;
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      parts.workspace.set_unknown(unknowns[i], parts.loop_start.unknowns[i]);
    parts.switching.place_loop(*parts.loop_start.loop, parts.loop_start.unknowns, t, states);
  }
  std::vector<text::Diagnostic> warnings;
  std::vector<double> signals(program.n_signals());
  bool held = false;  // a singular loop is, which has no derivatives
  bool runs = false;  // amplifiers may
  const auto settle_all = [&] {
    const auto rest = [&] {
      if (!parts.options.settle) return;
      parts.workspace.pass_failing_loops(held);
      auto where_they_run =
          runs ? rest_where_they_run(program, parts.workspace, t, states, file) : std::nullopt;
      warnings = where_they_run ? *std::move(where_they_run)
                                : bring_to_rest(program, parts.workspace, t, states, file);
      parts.workspace.pass_failing_loops(false);
    };
    parts.switching.start(t, states, rest, parts.loop_start.goes);
    // A run does not pass through where it begins: what another side of a switch left is no solution there.
    for (std::size_t l = 0; l < program.loops().size() && !held; ++l)
      parts.workspace.hold_loop(l, std::numeric_limits<double>::quiet_NaN(), {}, false);
    if (!parts.switching.signals(t, states.data(), signals.data()))
      throw loop_error(program, parts.workspace.trouble(), t, file);
  };
  const std::vector<double> begun = states;
  const auto trouble_of_settling = [&]() -> std::optional<SolveError> {
    try {
      settle_all();
      return std::nullopt;
    } catch (const SolveError& error) {
      return error;
    }
  };
  const std::optional<SolveError> trouble = trouble_of_settling();
  if (!trouble) return warnings;
  // Where a loop has no solution yet, nothing comes to rest either.
  if (trouble->kind() != SolveError::Kind::singular_loop && trouble->kind() != SolveError::Kind::no_rest)
    throw SolveError(*trouble);
  // What an ideal amplifier's loop is made of may have to come to rest before it has a solution.
  if (parts.options.settle && rest_past_loops(program, parts.workspace, t, states) && !trouble_of_settling())
    return warnings;
  states = begun;
  parts.workspace.reset();
  runs = trouble->kind() == SolveError::Kind::no_rest;
  if (runs && !trouble_of_settling()) {
    const diagram::FlatBlock* const saturated = find_saturated(parts, states);
    if (saturated == nullptr) return warnings;
    text::Diagnostic told = trouble->diagnostics().front();
    told.remedy += fmt::format(
        ". If '{}' is to run to its limit, as a Schmitt trigger does, give it that in the "
        "diagram: {} = {:.6g}",
        saturated->path, saturated->definition->parameters[*saturated->saturation].name,
        saturated->parameters[*saturated->saturation]);
    throw SolveError(SolveError::Kind::no_rest, t, std::move(told));
  }
  runs = false;
  states = begun;
  parts.workspace.reset();
  if (!hold_singular_start(program, parts.workspace, t, states, parts.options.until - t))
    throw SolveError(*trouble);
  held = true;
  settle_all();
  return warnings;
}

std::vector<text::Diagnostic> start_run(const StartParts& parts, double t, std::vector<double>& states) {
  std::vector<text::Diagnostic> warnings = settle_start(parts, t, states);
  std::vector<double> derivatives(states.size());
  if (parts.switching.derivatives(t, states.data(), derivatives.data()))
    refuse_singular_rates(parts, t, derivatives);
  for (text::Diagnostic& warning :
       unstable_branches(parts.program, parts.workspace, t, states, parts.diagram.file))
    warnings.push_back(std::move(warning));
  return warnings;
}

}  // namespace oblique::solve
