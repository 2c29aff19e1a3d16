// SPDX-License-Identifier: MIT
#include <oblique/report/expectation_check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

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

/// Rows of a run that a period is found by. They lie unevenly, by up to this part of their distance, so that
/// a fast signal does not pass for a slow one.
constexpr int kRowsOfPeriods = 32768;
constexpr double kUneven = 0.3;

double time_of_row(int k, double until) {
  const double multiple = k * std::numbers::phi;
  const bool is_end = k == 0 || k == kRowsOfPeriods;
  const double off = is_end ? 0 : kUneven * (2 * (multiple - std::floor(multiple)) - 1);
  return until * (k + off) / kRowsOfPeriods;
}

/// When a signal jumps between the rows `k` − 1 and `k`: the time of the first event there, that of the row
/// before included, which shows the signal as it was then; nothing where it does not jump, or no event is on
/// record.
std::optional<double> jump(const solve::Run& run, std::size_t k, std::size_t column) {
  constexpr double kSteep = 10;  // times what it changes by in the rows beside
  const solve::Trajectory& rows = run.extra;
  const auto change = [&](std::size_t row) {
    return row > 0 && row < rows.rows() ? std::abs(rows.at(row, column) - rows.at(row - 1, column)) : 0;
  };
  if (!(change(k) > kSteep * (change(k - 1) + change(k + 1)))) return std::nullopt;
  const auto event = std::lower_bound(run.event_times.begin(), run.event_times.end(), rows.at(k - 1, 0));
  if (event == run.event_times.end() || *event > rows.at(k, 0)) return std::nullopt;
  return *event;
}

/// When a signal passes a level between the rows `k` − 1 and `k`: the time of the event by which it jumps; or
/// the time as a cubic of the value through four rows where the signal rises through them all, else on the
/// line between the two.
double passage(const solve::Run& run, std::size_t k, std::size_t column, double level) {
  if (const auto event = jump(run, k, column)) return *event;
  const solve::Trajectory& rows = run.extra;
  constexpr std::size_t kPoints = 4;
  bool rises = k >= 2 && k + 1 < rows.rows();
  std::array<double, kPoints> t{}, y{};
  for (std::size_t i = 0; rises && i < kPoints; ++i) {
    t[i] = rows.at(k - 2 + i, 0);
    y[i] = rows.at(k - 2 + i, column) - level;
    rises = i == 0 || y[i] > y[i - 1];
  }
  const double before = rows.at(k - 1, column) - level, after = rows.at(k, column) - level;
  const double from = rows.at(k - 1, 0), to = rows.at(k, 0);
  const double straight = from + (to - from) * before / (before - after);
  if (!rises) return straight;
  double time = 0;  // Lagrange's polynomial at y = 0
  for (std::size_t i = 0; i < kPoints; ++i) {
    double term = t[i];
    for (std::size_t j = 0; j < kPoints; ++j) {
      if (j != i) term *= y[j] / (y[j] - y[i]);
    }
    time += term;
  }
  return time >= from && time <= to ? time : straight;
}

/// The mean time from rise to rise through the middle between the extremes, from a row on; not a number where
/// it does not rise twice, or is above or below the middle for so few rows that others may lie between two.
double period_from(const solve::Run& run, std::size_t first, std::size_t column) {
  const solve::Trajectory& rows = run.extra;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t k = first; k < rows.rows(); ++k) {
    low = std::min(low, rows.at(k, column));
    high = std::max(high, rows.at(k, column));
  }
  const double level = (low + high) / 2;
  constexpr std::size_t kLeastRows = 8, kLeastOfJumps = 3;
  std::vector<double> rises;
  std::optional<std::size_t> since;
  for (std::size_t k = first + 1; k < rows.rows(); ++k) {
    const bool is_above = rows.at(k, column) >= level;
    if ((rows.at(k - 1, column) >= level) == is_above) continue;
    const bool jumps = since && k - *since < kLeastRows && jump(run, k, column) && jump(run, *since, column);
    if (since && k - *since < (jumps ? kLeastOfJumps : kLeastRows)) return std::nan("");
    since = k;
    if (is_above) rises.push_back(passage(run, k, column, level));
  }
  if (rises.size() < 2) return std::nan("");
  return (rises.back() - rises.front()) / static_cast<double>(rises.size() - 1);
}

/// The period in the second half of the rows, or in all of them where that is too short.
double period(const solve::Run& run, std::size_t column) {
  const double late = period_from(run, run.extra.rows() / 2, column);
  return std::isnan(late) ? period_from(run, 0, column) : late;
}

/// `column` counts the time too.
double actual_value(const diagram::Expectation& expectation, const solve::Run& run, std::size_t column) {
  switch (expectation.kind) {
    case diagram::Expectation::Kind::maximum:
      return run.extremes.at(column - 1).maximum.value;
    case diagram::Expectation::Kind::minimum:
      return run.extremes.at(column - 1).minimum.value;
    case diagram::Expectation::Kind::period:
      return period(run, column);
    case diagram::Expectation::Kind::at_time:
      break;
  }
  return value_at(run.extra, expectation.time, column);
}

template <class Result>
std::string lines_of(const std::vector<Result>& results) {
  std::string text;
  for (const Result& result : results) {
    const std::string actual = std::isnan(result.actual) ? "not known" : fmt::format("{}", result.actual);
    text += fmt::format("{}  {} = {}, expected {} ± {}\n", result.met ? "ok    " : "FAILED",
                        result.expectation.text, actual, result.expectation.value, result.expectation.within);
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
    options.extremes = options.extremes || e.kind == diagram::Expectation::Kind::maximum ||
                       e.kind == diagram::Expectation::Kind::minimum;
}

void ask_for_expectations(const diagram::Diagram& diagram, solve::RunOptions& options) {
  ask_for_expectations(diagram.expectations, diagram.file, options);
}

std::vector<double> expectation_times(const diagram::Diagram& diagram, double until) {
  return expectation_times(diagram.expectations, until);
}

std::vector<double> expectation_times(std::span<const diagram::Expectation> expectations, double until) {
  std::vector<double> times;
  bool has_period = false;
  text::Diagnostics diagnostics;
  for (const diagram::Expectation& e : expectations) {
    if (e.kind == diagram::Expectation::Kind::period && !has_period) {
      for (int k = 0; k <= kRowsOfPeriods; ++k) times.push_back(time_of_row(k, until));
      has_period = true;
    }
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
