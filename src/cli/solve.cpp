// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/expectation.h>
#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/read_mechanism.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

/// The drives' angles and the coordinates of the moving points: what fits on a terminal.
std::string table_of(const Mechanism& mechanism, const Motion& motion) {
  constexpr std::size_t kMostRows = 13;
  constexpr std::size_t kColumnWidth = 12;
  std::vector<MotionColumn> columns;
  for (MotionColumn& column : motion_columns(mechanism, motion)) {
    const bool coordinate = column.name.ends_with(".x") || column.name.ends_with(".y");
    const bool first = columns.size() <= mechanism.drives.size();
    if (first || coordinate) columns.push_back(std::move(column));
  }
  const std::size_t shown = std::min(columns.size(), columns_that_fit(kColumnWidth) - 1);
  std::vector<std::string> header, units;
  for (std::size_t c = 0; c < shown; ++c) {
    header.push_back(columns[c].name);
    units.push_back("[" + columns[c].unit + "]");
  }
  header.emplace_back("status");
  units.emplace_back();
  Table table(header);
  table.add(units);
  for (const std::size_t row : spread_rows(motion.times.size(), kMostRows)) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < shown; ++c) {
      cells.push_back(short_number(columns[c].values[row], mechanism.largest_length()));
    }
    cells.emplace_back(status_name(motion.configurations[row].status));
    table.add(cells);
  }
  return table.text() +
         fmt::format(
             "(positions only, {} of {} rows; -o FILE.csv writes velocities, accelerations and "
             "the bodies' angles too)\n",
             std::min(kMostRows, motion.times.size()), motion.times.size());
}

/// "crank = 137.812 deg" at a moment.
std::string drive_at(const Mechanism& mechanism, double time) {
  const Drive& drive = mechanism.drives.front();
  const double value = DriveClock(mechanism).at(0, time).value;
  return drive.slide ? fmt::format("{} = {:.9g} {}", drive.name, value, mechanism.length_unit)
                     : fmt::format("{} = {:.9g} deg", drive.name, value * 180 / std::numbers::pi);
}

void note_events(const Mechanism& mechanism, const Structure& structure,
                 const std::vector<MotionEvent>& events) {
  constexpr std::size_t kMost = 8;
  for (std::size_t i = 0; i < std::min(events.size(), kMost); ++i) {
    const std::string& group = structure.groups[events[i].group].name;
    const std::string where = drive_at(mechanism, events[i].time);
    switch (events[i].kind) {
      case MotionEvent::Kind::limit:
        note(fmt::format("limit at {}: a dead centre of {}, which cannot be assembled beyond\n", where,
                         group));
        break;
      case MotionEvent::Kind::return_:
        note(fmt::format("from {} on {} can be assembled again\n", where, group));
        break;
      case MotionEvent::Kind::change:
        note(fmt::format("change point at {}: the modes of {} meet, and it goes on by its velocity\n", where,
                         group));
        break;
    }
  }
  if (events.size() > kMost) note(fmt::format("({} more)\n", events.size() - kMost));
}

ExitStatus report_expectations(const Mechanism& mechanism) {
  bool all = true;
  for (const MechanismFinding& finding : check_expectations(mechanism)) {
    all = all && finding.met;
    print(fmt::format("{}  {} = {}, expected {} ± {}\n", finding.met ? "ok    " : "FAILED",
                      finding.expectation.text, finding.actual, finding.expectation.value,
                      finding.expectation.within));
  }
  return all ? ExitStatus::done : ExitStatus::no;
}

MotionOptions options_of(const SolveRequest& request) {
  MotionOptions options;
  options.positions = request.positions;
  if (!request.until.empty()) {
    options.until = quantity_option("--until", request.until, "s");
    if (!(*options.until > 0 && std::isfinite(*options.until))) {
      throw ReadError(Diagnostic{{}, fmt::format("--until {}", request.until), "a time above 0", {}});
    }
  }
  if (!request.at_limit.empty()) {
    options.at_limit = parse_at_limit(request.at_limit);
    if (!options.at_limit) {
      throw ReadError(Diagnostic{{},
                                 fmt::format("--at-limit {}", request.at_limit),
                                 "open, stop or reverse",
                                 suggest(request.at_limit, {"open", "stop", "reverse"})});
    }
  }
  return options;
}

}  // namespace

ExitStatus solve_mechanism(const Session&, const SolveRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".csv");
  const MotionOptions options = options_of(request);
  const Mechanism mechanism = read_mechanism(request.mechanism);
  if (request.check && mechanism.expectations.empty()) {
    throw ReadError(
        Diagnostic{{mechanism.file, {}},
                   "there is nothing to check: the mechanism has no [expect]",
                   R"([expect] with lines such as "P.x at 90 deg" = { value = 12.5, within = 1e-9 })",
                   {}});
  }
  const Structure structure = decompose(mechanism);
  const Motion motion = solve_motion(mechanism, options);
  print(table_of(mechanism, motion));
  if (!request.output.empty()) save(request.output, motion_csv(mechanism, motion));
  note_events(mechanism, structure, motion.events);
  const auto count = [&](oblique::Status status) {
    return std::count_if(motion.configurations.begin(), motion.configurations.end(),
                         [&](const Configuration& c) { return c.status == status; });
  };
  const auto open = count(oblique::Status::open), flat = count(oblique::Status::dead_centre);
  if (flat > 0) note(fmt::format("{} positions are dead centres: velocities have no value there\n", flat));
  if (open > 0) {
    note(fmt::format(
        "{} of {} positions cannot be assembled; --at-limit stop or reverse keeps the motion within its "
        "range\n",
        open, motion.times.size()));
  }
  const ExitStatus checked = request.check ? report_expectations(mechanism) : ExitStatus::done;
  return open > 0 ? ExitStatus::no : checked;
}

}  // namespace oblique::cli
