// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <fmt/format.h>

#include <oblique/mechanism/model/coefficients.h>
#include <oblique/mechanism/model/expectation.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/text_table.h>
#include "terminal/table_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

/// The rows of a motion that fit on a terminal, and how many stand where.
struct Digest {
  std::vector<std::vector<double>> rows;
  std::vector<oblique::mechanism::Status> statuses;  ///< of `rows`
  std::size_t open = 0, dead_centres = 0;
};

/// The drives' angles and the coordinates of the moving points: what fits on a terminal.
std::string table_of(const mechanism::Mechanism& mechanism, const Digest& digest, int positions) {
  constexpr std::size_t kColumnWidth = 12;
  const std::vector<mechanism::MotionColumnName> names = mechanism::motion_column_names(mechanism);
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const bool coordinate = names[c].name.ends_with(".x") || names[c].name.ends_with(".y");
    if (c <= mechanism.drives.size() || coordinate) columns.push_back(c);
  }
  columns.resize(std::min(columns.size(), columns_that_fit(kColumnWidth) - 1));
  std::vector<std::string> header, units;
  for (const std::size_t c : columns) {
    header.push_back(names[c].name);
    units.push_back("[" + names[c].unit + "]");
  }
  header.emplace_back("status");
  units.emplace_back();
  report::Table table(header);
  table.add(units);
  const double size = mechanism.largest_length();
  for (std::size_t row = 0; row < digest.rows.size(); ++row) {
    std::vector<std::string> cells;
    cells.reserve(columns.size() + 1);
    for (const std::size_t c : columns) cells.push_back(report::short_number(digest.rows[row][c], size));
    cells.emplace_back(mechanism::status_name(digest.statuses[row]));
    table.add(cells);
  }
  return table.text() +
         fmt::format(
             "(positions only, {} of {} rows; -o FILE.csv writes velocities, accelerations and "
             "the bodies' angles too)\n",
             digest.rows.size(), positions);
}

/// The columns of the file: those of the motion and `status`.
std::vector<text::TableColumn> table_columns(const mechanism::Mechanism& mechanism) {
  std::vector<text::TableColumn> columns;
  for (const mechanism::MotionColumnName& column : mechanism::motion_column_names(mechanism))
    columns.push_back({column.name, column.unit});
  text::TableColumn& status = columns.emplace_back(text::TableColumn{"status"});
  using oblique::mechanism::Status;
  for (const Status value : {Status::ok, Status::dead_centre, Status::open})
    status.labels.emplace_back(mechanism::status_name(value));
  return columns;
}

/// "crank = 137.812 deg" at a moment.
std::string drive_at(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = mechanism::DriveClock(mechanism).at(0, time).value;
  return drive.slide ? fmt::format("{} = {:.9g} {}", drive.name, value, mechanism.length_unit)
                     : fmt::format("{} = {:.9g} deg", drive.name, value * 180 / std::numbers::pi);
}

void note_events(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                 const std::vector<mechanism::MotionEvent>& events) {
  constexpr std::size_t kMost = 8;
  for (std::size_t i = 0; i < std::min(events.size(), kMost); ++i) {
    const std::string& group = structure.groups[events[i].group].name;
    const std::string where = drive_at(mechanism, events[i].time);
    switch (events[i].kind) {
      case mechanism::MotionEvent::Kind::limit:
        note(fmt::format("limit at {}: a dead centre of {}, which cannot be assembled beyond\n", where,
                         group));
        break;
      case mechanism::MotionEvent::Kind::return_:
        note(fmt::format("from {} on {} can be assembled again, on the branch that it left\n", where, group));
        break;
      case mechanism::MotionEvent::Kind::change:
        note(fmt::format("change point at {}: the modes of {} meet, and it goes on by its velocity\n", where,
                         group));
        break;
      case mechanism::MotionEvent::Kind::infinity:
        note(fmt::format("infinity at {}: {} goes away without end, and comes back from the other side\n",
                         where, group));
        break;
    }
  }
  if (events.size() > kMost) note(fmt::format("({} more)\n", events.size() - kMost));
}

ExitStatus report_expectations(const mechanism::Mechanism& mechanism) {
  bool all = true;
  for (const mechanism::MechanismFinding& finding : mechanism::check_expectations(mechanism)) {
    all = all && finding.met;
    print(fmt::format("{}  {} = {}, expected {} ± {}\n", finding.met ? "ok    " : "FAILED",
                      finding.expectation.text, finding.actual, finding.expectation.value,
                      finding.expectation.within));
  }
  return all ? ExitStatus::done : ExitStatus::no;
}

mechanism::MotionOptions options_of(const SolveRequest& request) {
  mechanism::MotionOptions options;
  options.positions = request.positions;
  if (!request.until.empty()) {
    options.until = quantity_option("--until", request.until, "s");
    if (!(*options.until > 0 && std::isfinite(*options.until))) {
      throw text::ReadError(
          text::Diagnostic{{}, fmt::format("--until {}", request.until), "a time above 0", {}});
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
  std::vector<text::TableColumn> columns = table_columns(mechanism);
  std::vector<mechanism::MotionColumn> analysis;
  if (request.analysis) {
    analysis = mechanism::analysis_columns(mechanism, structure, mechanism::solve_motion(mechanism, options));
    for (const mechanism::MotionColumn& column : analysis)
      columns.insert(columns.end() - 1, {column.name, column.unit});
  }
  const ColumnChoice choice(columns, request.columns);
  std::optional<TableOutput> table;
  if (!request.output.empty()) table.emplace(request.output, choice, positions);
  Digest digest;
  constexpr std::size_t kMostRows = 13;
  const std::vector<std::size_t> shown = report::spread_rows(positions, kMostRows);
  std::vector<double> values(columns.size());
  std::size_t row = 0;
  const auto events =
      mechanism::visit_motion(mechanism, structure, options, [&](const mechanism::MotionRow& motion) {
        const oblique::mechanism::Status status = motion.configuration.status;
        mechanism::motion_values(mechanism, motion, values);
        for (std::size_t c = 0; c < analysis.size(); ++c) {
          values[values.size() - 1 - analysis.size() + c] = analysis[c].values[row];
        }
        values.back() = static_cast<double>(status);
        if (table) table->add(values);
        if (digest.rows.size() < shown.size() && shown[digest.rows.size()] == row) {
          digest.rows.push_back(values);
          digest.statuses.push_back(status);
        }
        digest.open += status == oblique::mechanism::Status::open ? 1 : 0;
        digest.dead_centres += status == oblique::mechanism::Status::dead_centre ? 1 : 0;
        ++row;
      });
  print(table_of(mechanism, digest, options.positions));
  if (table) table->finish();
  note_events(mechanism, structure, events);
  if (digest.dead_centres > 0) {
    note(fmt::format("{} positions are dead centres: velocities have no value there\n", digest.dead_centres));
  }
  if (digest.open > 0) {
    note(fmt::format(
        "{} of {} positions cannot be assembled; --at-limit stop or reverse keeps the motion within its "
        "range\n",
        digest.open, positions));
  }
  const ExitStatus checked = request.check ? report_expectations(mechanism) : ExitStatus::done;
  return digest.open > 0 ? ExitStatus::no : checked;
}

}  // namespace oblique::cli
