// SPDX-License-Identifier: MIT
#include <oblique/solve/run.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <iterator>

#include <fmt/format.h>

#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run_warnings.h>
#include <oblique/solve/runner.h>
#include <oblique/solve/sensitivity/sensitivities.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

/// Runs, and where states matter that the tolerance hides, anew and finer. Where no run is fine enough,
/// the last one says so.
Run run_seeing(const network::Program& program, const diagram::FlatDiagram& diagram,
               const RunOptions& options, const LoopStart& loop_start) {
  constexpr int kMostTries = 5;
  constexpr std::int64_t kMostTimesFirst = 100, kAlwaysAllowed = 100'000;  // steps of a finer run
  // For a comparison that lies within errors alone a finer run takes some times as many steps, or it is one
  // of what rests on its level, and no run is fine enough.
  constexpr std::int64_t kMostTimesForFaint = 30, kAlwaysAllowedForFaint = 2'000;
  Refinement refinement;
  RunOptions finer = options;
  bool failed = false, out_of_steps = false;  // the last try
  for (int k = 0; k < kMostTries; ++k) {
    if (k > 0 && options.on_restart) options.on_restart();
    Observed observed;
    Run result;
    try {
      result = run_once(program, diagram, finer, loop_start, refinement, true, observed);
    } catch (const SolveError& failure) {  // what was not seen may be why
      failed = true;
      out_of_steps = failure.kind() == SolveError::Kind::step_budget;
      if (observed.unseen.empty() && k == 0) throw;
      if (observed.unseen.empty()) break;
    }
    if (observed.unseen.empty()) return result;
    if (options.interrupted && options.interrupted()) {  // no finer one comes
      for (text::Diagnostic& warning : warnings_of(observed.unseen, program, diagram))
        result.warnings.push_back(std::move(warning));
      return result;
    }
    if (k == 0) {
      const std::int64_t most = observed.unseen.is_faint_alone()
                                    ? kMostTimesForFaint * observed.steps + kAlwaysAllowedForFaint
                                    : kMostTimesFirst * observed.steps + kAlwaysAllowed;
      finer.max_steps = std::min(options.max_steps, most);
    }
    const Refinement before = refinement;
    refine(observed.unseen, program.n_states(), refinement);
    if (refinement == before) break;
    failed = out_of_steps = false;
  }
  const auto run_to_the_end = [&](const Refinement& how, const RunOptions& with) {
    if (options.on_restart) options.on_restart();
    Observed observed;
    Run result = run_once(program, diagram, with, loop_start, how, false, observed);
    for (text::Diagnostic& warning : warnings_of(observed.unseen, program, diagram, out_of_steps))
      result.warnings.push_back(std::move(warning));
    return result;
  };
  try {
    return failed ? run_to_the_end({}, options) : run_to_the_end(refinement, finer);
  } catch (const SolveError& failure) {  // finer than it can be run
    out_of_steps = failure.kind() == SolveError::Kind::step_budget;
    return run_to_the_end({}, options);
  }
}

/// A longest step that would use up the budget of steps is refused at once, and so is one that the clock
/// cannot show.
void check_longest_step(const diagram::FlatDiagram& diagram, const RunOptions& options) {
  const double span = options.until - (options.from ? options.from->time : 0);
  if (span / options.max_step <= static_cast<double>(options.max_steps)) return;
  throw SolveError(
      SolveError::Kind::step_budget, options.until - span,
      {{diagram.file, {}},
       fmt::format("steps of {} s at most would be more than {} over a run of {} s", options.max_step,
                   options.max_steps, span),
       {},
       {"raise max_step or max_steps in [run], or end the run earlier with ", text::Setting{"until"}}});
}

/// Sensitivities are integrated by CVODES beside the states; the other method does not know them.
void check_sensitivity(const diagram::FlatDiagram& diagram, const RunOptions& options) {
  if (options.sensitivity.empty() || options.method != diagram::IntegrationMethod::rodas) return;
  throw text::ReadError(text::Diagnostic{{diagram.file, {}},
                                         "sensitivities are integrated by CVODES, and the method is 'rodas'",
                                         "'auto', 'bdf' or 'adams'",
                                         "leave out method = \"rodas\" in [run]"});
}

}  // namespace

std::vector<text::TableColumn> output_columns(const diagram::FlatDiagram& diagram) {
  std::vector<text::TableColumn> columns{{"t", "s"}};
  for (const diagram::FlatOutput& output : diagram.outputs) columns.push_back({output.name, output.unit});
  return columns;
}

std::vector<text::TableColumn> run_columns(const diagram::FlatDiagram& diagram, const RunOptions& options) {
  std::vector<text::TableColumn> columns = output_columns(diagram);
  if (options.sensitivity.empty()) return columns;
  const std::vector<SensitivityParameter> parameters = sensitivity_parameters(diagram, options.sensitivity);
  for (const diagram::FlatOutput& output : diagram.outputs) {
    for (const SensitivityParameter& parameter : parameters) {
      const bool plain = parameter.unit.find_first_of("*/") == std::string::npos;
      const std::string unit = parameter.unit == "1" || parameter.unit.empty() ? output.unit
                               : plain ? fmt::format("{}/{}", output.unit, parameter.unit)
                                       : fmt::format("{}/({})", output.unit, parameter.unit);
      columns.push_back({fmt::format("d({})/d({})", output.name, parameter.name), unit});
    }
  }
  return columns;
}

RunOptions options_of(const diagram::RunSettings& settings) {
  RunOptions options;
  options.until = settings.until;
  options.tolerance = settings.tolerance;
  options.absolute_tolerance = settings.absolute_tolerance;
  if (settings.max_step) options.max_step = *settings.max_step;
  options.method = settings.method;
  options.samples = settings.samples;
  options.max_steps = settings.max_steps;
  options.settle = settings.settle;
  return options;
}

Run run(const network::Program& program, const diagram::FlatDiagram& diagram, const RunOptions& options) {
  const auto begin = std::chrono::steady_clock::now();
  if (options.from) check_run_state(*options.from, program, diagram.file);
  check_longest_step(diagram, options);
  check_sensitivity(diagram, options);
  StartChoice start = start_of(program, diagram, options);
  Run result = run_seeing(program, diagram, options, start.from);
  std::move(start.warnings.begin(), start.warnings.end(), std::back_inserter(result.warnings));
  for (text::Diagnostic& warning : warnings_at_end(diagram, options, result))
    result.warnings.push_back(std::move(warning));
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (options.trust) result.trust = estimate_error(program, diagram, options, result);
  return result;
}

Run run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  return run(diagram, library, options_of(diagram.run));
}

Run run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library, const RunOptions& options) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  return run(network::Program(network::assemble(flat)), flat, options);
}

}  // namespace oblique::solve
