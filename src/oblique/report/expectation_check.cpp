// SPDX-License-Identifier: MIT
#include <oblique/report/expectation_check.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/mechanism/model/expectation.h>

namespace oblique::report {
namespace {

double value_at(const solve::Trajectory& extra, double time, std::size_t column) {
  for (std::size_t row = 0; row < extra.rows(); ++row) {
    if (extra.at(row, 0) == time) return extra.at(row, column);
  }
  return std::nan("");  // the run was made without expectation_times
}

/// `column` counts the time too.
double actual_value(const diagram::Expectation& expectation, const solve::Run& run, std::size_t column) {
  switch (expectation.kind) {
    case diagram::Expectation::Kind::maximum:
      return run.extremes.at(column - 1).maximum.value;
    case diagram::Expectation::Kind::minimum:
      return run.extremes.at(column - 1).minimum.value;
    case diagram::Expectation::Kind::at_time:
      break;
  }
  return value_at(run.extra, expectation.time, column);
}

template <class Result>
std::string lines_of(const std::vector<Result>& results) {
  std::string text;
  for (const Result& result : results) {
    text += fmt::format("{}  {} = {}, expected {} ± {}\n", result.met ? "ok    " : "FAILED",
                        result.expectation.text, result.actual, result.expectation.value,
                        result.expectation.within);
  }
  return text;
}

}  // namespace

void ask_for_expectations(std::span<const diagram::Expectation> expectations, const std::string& file,
                          solve::RunOptions& options) {
  options.extra_times = expectation_times(expectations, options.until);
  if (options.from && !options.extra_times.empty() && options.extra_times.front() < options.from->time) {
    throw diagram::DiagramError(
        text::Diagnostic{{file, {}},
                         fmt::format("[expect] asks for t = {} s, and the run goes on from t = {} s",
                                     options.extra_times.front(), options.from->time),
                         "expectations at later times",
                         "check the whole run, without a saved state"});
  }
  for (const diagram::Expectation& e : expectations)
    options.extremes = options.extremes || e.kind != diagram::Expectation::Kind::at_time;
}

void ask_for_expectations(const diagram::Diagram& diagram, solve::RunOptions& options) {
  ask_for_expectations(diagram.expectations, diagram.file, options);
}

std::vector<double> expectation_times(const diagram::Diagram& diagram, double until) {
  return expectation_times(diagram.expectations, until);
}

std::vector<double> expectation_times(std::span<const diagram::Expectation> expectations, double until) {
  std::vector<double> times;
  text::Diagnostics diagnostics;
  for (const diagram::Expectation& e : expectations) {
    if (e.kind != diagram::Expectation::Kind::at_time) continue;
    if (e.time < 0 || e.time > until) {
      diagnostics.add({e.place,
                       fmt::format("'{}' is at t = {} s, outside the run", e.text, e.time),
                       fmt::format("a time from 0 to {} s", until),
                       {"let the run last longer: ", text::Setting{"until"}}});
    }
    times.push_back(e.time);
  }
  diagnostics.throw_if_any<diagram::DiagramError>();
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

std::vector<ExpectationResult> check_expectations(const diagram::Diagram& diagram, const solve::Run& run) {
  return check_expectations(diagram.expectations, run);
}

std::vector<ExpectationResult> check_expectations(std::span<const diagram::Expectation> expectations,
                                                  const solve::Run& run) {
  std::vector<ExpectationResult> results;
  text::Diagnostics diagnostics;
  std::vector<std::string> names;
  for (const auto& column : run.trajectory.columns()) names.push_back(column.name);
  for (const diagram::Expectation& e : expectations) {
    const auto column = run.trajectory.find(e.output);
    if (!column) {
      diagnostics.add({e.place,
                       fmt::format("'{}': there is no output '{}'", e.text, e.output),
                       {},
                       text::suggest(e.output, names)});
      continue;
    }
    const double actual = actual_value(e, run, *column);
    results.push_back({e, actual, std::abs(actual - e.value) <= e.within});
  }
  diagnostics.throw_if_any<diagram::DiagramError>();
  return results;
}

std::string to_text(const std::vector<ExpectationResult>& results) {
  return lines_of(results);
}

std::string to_text(const std::vector<mechanism::MechanismFinding>& findings) {
  return lines_of(findings);
}

}  // namespace oblique::report
