// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/expectation.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include <oblique/text/table_reader.h>

namespace oblique::mechanism {
namespace {

using Kind = MechanismExpectation::Kind;

/// A time [s], or where it is no time, a value of the first drive; false after a finding.
bool read_moment(const std::string& text, const Mechanism& mechanism, const text::Place& place,
                 MechanismExpectation& expectation, text::Diagnostics& diagnostics) {
  const bool slides = !mechanism.drives.empty() && mechanism.drives.front().slide;
  const std::string drive_unit = slides ? mechanism.length_unit : "rad";
  for (const auto& [kind, unit] :
       {std::pair{Kind::at_time, std::string("s")}, std::pair{Kind::at_value, drive_unit}}) {
    try {
      expectation.at = text::parse_quantity(text, text::parse_unit(unit).value());
      expectation.kind = kind;
      return std::isfinite(expectation.at);
    } catch (const text::ExpressionError&) {
      continue;
    }
  }
  diagnostics.add({place,
                   fmt::format("[expect] cannot read '{}' of '{}'", text, expectation.text),
                   fmt::format(R"(a time as "0.25 s", or a value of the first drive as "{}")",
                               slides ? "20 " + drive_unit : "90 deg"),
                   {}});
  return false;
}

bool read_key(const Mechanism& mechanism, MechanismExpectation& expectation, text::Diagnostics& diagnostics) {
  const std::string& key = expectation.text;
  for (const auto& [word, kind] : {std::pair{std::string_view(" maximum"), Kind::maximum},
                                   std::pair{std::string_view(" minimum"), Kind::minimum}}) {
    if (!key.ends_with(word)) continue;
    expectation.kind = kind;
    expectation.column = key.substr(0, key.size() - word.size());
    return true;
  }
  constexpr std::string_view kAt = " at ";
  const std::size_t at = key.rfind(kAt);
  if (at == std::string::npos || at == 0) {
    diagnostics.add({expectation.place,
                     fmt::format("[expect] cannot read '{}'", key),
                     R"("COLUMN at TIME", "COLUMN at ANGLE", "COLUMN maximum" or "COLUMN minimum")",
                     {}});
    return false;
  }
  expectation.column = key.substr(0, at);
  return read_moment(key.substr(at + kAt.size()), mechanism, expectation.place, expectation, diagnostics);
}

/// The first time at which the first drive stands at `value`.
double time_of(const Mechanism& mechanism, const MechanismExpectation& expectation) {
  if (expectation.kind == Kind::at_time) return expectation.at;
  if (const auto time = time_at_value(mechanism, expectation.at)) return *time;
  throw MechanismError(
      MechanismError::Kind::request,
      text::Diagnostic{expectation.place,
                       fmt::format("drive '{}' does not reach the value at which '{}' is expected",
                                   mechanism.drives.front().name, expectation.text),
                       "a value that it reaches",
                       {}});
}

const MotionColumn& column(const std::vector<MotionColumn>& columns,
                           const MechanismExpectation& expectation) {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const MotionColumn& c) { return c.name == expectation.column; });
  if (found != columns.end()) return *found;
  throw MechanismError(
      MechanismError::Kind::file,
      text::Diagnostic{expectation.place,
                       fmt::format("[expect] names '{}', which is no column", expectation.column),
                       {},
                       text::suggest(expectation.column, names_of(columns))});
}

/// The largest value of a column, and of the parabola through it and its neighbours, also of a motion that
/// ends where it begins.
double maximum_of(const std::vector<double>& values) {
  constexpr double kSame = 1e-9;
  const std::size_t n = values.size();
  std::size_t top = n;
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isnan(values[i]) && (top == n || values[i] > values[top])) top = i;
  }
  if (top == n) return std::nan("");
  const bool at_end = top == 0 || top + 1 == n;
  const bool closed =
      n > 2 && std::abs(values.front() - values.back()) <= kSame * (1 + std::abs(values[top]));
  if (at_end && !closed) return values[top];
  const double rise = values[top] - values[top == 0 ? n - 2 : top - 1];
  const double fall = values[top] - values[top + 1 == n ? 1 : top + 1];
  if (!(rise + fall > 0)) return values[top];
  return values[top] + (rise - fall) * (rise - fall) / (8 * (rise + fall));
}

}  // namespace

void read_mechanism_expectations(const text::Value& table, Mechanism& mechanism,
                                 text::Diagnostics& diagnostics) {
  for (const text::Entry& entry : table.entries) {
    MechanismExpectation expectation;
    expectation.text = entry.key;
    expectation.place = {mechanism.file, entry.position};
    const bool good = read_key(mechanism, expectation, diagnostics);
    text::TableReader reader(mechanism.file, entry.value, fmt::format("[expect] '{}'", entry.key),
                             diagnostics);
    if (entry.value.kind != text::Value::Kind::table) continue;
    const auto expected = text::read_expected_value(reader);
    if (!good || !expected) continue;
    expectation.value = expected->value;
    expectation.within = expected->within;
    mechanism.expectations.push_back(std::move(expectation));
  }
}

std::vector<MechanismFinding> check_expectations(const Mechanism& mechanism) {
  std::vector<MechanismFinding> findings;
  const bool extremes =
      std::any_of(mechanism.expectations.begin(), mechanism.expectations.end(),
                  [](const auto& e) { return e.kind == Kind::maximum || e.kind == Kind::minimum; });
  std::vector<MotionColumn> motion;
  constexpr int kPositions = 3601, kMost = 360'007;
  if (extremes)
    motion =
        motion_columns(mechanism, solve_motion(mechanism, rows_over_motion(mechanism, kPositions, kMost)));
  for (const MechanismExpectation& expectation : mechanism.expectations) {
    double actual = 0;
    if (expectation.kind == Kind::at_time || expectation.kind == Kind::at_value) {
      const std::array times{time_of(mechanism, expectation)};
      actual = column(motion_columns(mechanism, solve_motion(mechanism, times)), expectation).values.front();
    } else {
      std::vector<double> values = column(motion, expectation).values;
      const bool lowest = expectation.kind == Kind::minimum;
      if (lowest) {
        for (double& value : values) value = -value;
      }
      actual = lowest ? -maximum_of(values) : maximum_of(values);
    }
    findings.push_back({expectation, actual, std::abs(actual - expectation.value) <= expectation.within});
  }
  return findings;
}

}  // namespace oblique::mechanism
