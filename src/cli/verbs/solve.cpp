// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/model/coefficients.h>
#include <oblique/mechanism/model/expectation.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/expectation_check.h>
#include <oblique/report/motion_text.h>
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

mechanism::MotionOptions options_of(const SolveRequest& request) {
  mechanism::MotionOptions options;
  options.positions = request.positions;
  if (!request.until.empty()) {
    options.until = quantity_option("--until", request.until, "s");
    if (!(*options.until > 0 && std::isfinite(*options.until))) {
      throw text::ReadError(
          text::Diagnostic{{}, fmt::format("--until {}", request.until), "a finite time above 0", {}});
    }
  }
  if (!request.at_limit.empty()) {
    options.at_limit = mechanism::parse_at_limit(request.at_limit);
    if (!options.at_limit) {
      throw text::ReadError(text::Diagnostic{{},
                                             fmt::format("--at-limit {}", request.at_limit),
                                             "open, stop or reverse",
                                             text::suggest(request.at_limit, {"open", "stop", "reverse"})});
    }
  }
  return options;
}

}  // namespace

ExitStatus solve_mechanism(const Session&, const SolveRequest& request) {
  check_table_output(request.output, request.columns);
  if (request.analysis && request.output.empty()) {
    throw text::ReadError(
        text::Diagnostic{{}, "--analysis has no file to write its columns to", "-o FILE.csv", {}});
  }
  const mechanism::MotionOptions options = options_of(request);
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(request.mechanism);
  if (request.check && mechanism.expectations.empty()) {
    throw text::ReadError(
        text::Diagnostic{{mechanism.file, {}},
                         "there is nothing to check: the mechanism has no [expect]",
                         R"([expect] with lines such as "P.x at 90 deg" = { value = 12.5, within = 1e-9 })",
                         {}});
  }
  if (mechanism.drives.empty())
    mechanism::period(mechanism);  // says so, where `decompose` would speak of its mobility
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  const auto positions = static_cast<std::size_t>(options.positions);
  std::vector<text::TableColumn> columns = report::motion_table_columns(mechanism);
  std::vector<mechanism::MotionColumn> analysis;
  if (request.analysis) {
    analysis = mechanism::analysis_columns(mechanism, structure, mechanism::solve_motion(mechanism, options));
    for (const mechanism::MotionColumn& column : analysis)
      columns.insert(columns.end() - 1, {column.name, column.unit});
  }
  const ColumnChoice choice(columns, request.columns);
  std::optional<TableOutput> table;
  if (!request.output.empty()) table.emplace(request.output, choice, positions);
  report::MotionDigest digest(positions);
  std::vector<double> values(columns.size());
  std::size_t row = 0;
  const auto events =
      mechanism::visit_motion(mechanism, structure, options, [&](const mechanism::MotionRow& motion) {
        const mechanism::Status status = motion.configuration.status;
        mechanism::motion_values(mechanism, motion, values);
        for (std::size_t c = 0; c < analysis.size(); ++c) {
          values[values.size() - 1 - analysis.size() + c] = analysis[c].values[row];
        }
        values.back() = static_cast<double>(status);
        if (table) table->add(values);
        digest.add(values, status);
        ++row;
      });
  constexpr std::size_t kColumnWidth = 12;
  print(digest.table(mechanism, columns_that_fit(kColumnWidth)).text() +
        fmt::format("(positions only, {} of {} rows; -o FILE.csv writes velocities, accelerations and "
                    "the bodies' angles too)\n",
                    digest.shown(), digest.positions()));
  if (table) table->finish();
  note(report::events_text(mechanism, structure, events));
  note(digest.remarks(command_line()));
  bool all_met = true;
  if (request.check) {
    const std::vector<mechanism::MechanismFinding> checked = mechanism::check_expectations(mechanism);
    print(report::to_text(checked));
    all_met = std::all_of(checked.begin(), checked.end(), [](const auto& finding) { return finding.met; });
  }
  return digest.open() == 0 && all_met ? ExitStatus::done : ExitStatus::no;
}

}  // namespace oblique::cli
