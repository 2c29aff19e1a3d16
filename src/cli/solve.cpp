// SPDX-License-Identifier: MIT
#include <algorithm>

#include <fmt/format.h>

#include <oblique/mechanism/coefficients.h>
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

}  // namespace

ExitStatus solve_mechanism(const Session&, const SolveRequest& request) {
  if (!request.output.empty()) check_output(request.output, ".csv");
  if (request.analysis && request.output.empty()) {
    throw ReadError(Diagnostic{{}, "--analysis has no file to write its columns to", "-o FILE.csv", {}});
  }
  const Mechanism mechanism = read_mechanism(request.mechanism);
  const Motion motion = solve_motion(mechanism, request.positions);
  print(table_of(mechanism, motion));
  if (!request.output.empty()) {
    std::vector<MotionColumn> columns = motion_columns(mechanism, motion);
    if (request.analysis) {
      for (MotionColumn& column : analysis_columns(mechanism, decompose(mechanism), motion))
        columns.push_back(std::move(column));
    }
    save(request.output, motion_csv(columns, motion));
  }
  const auto count = [&](oblique::Status status) {
    return std::count_if(motion.configurations.begin(), motion.configurations.end(),
                         [&](const Configuration& c) { return c.status == status; });
  };
  const auto open = count(oblique::Status::open), flat = count(oblique::Status::dead_centre);
  if (flat > 0) note(fmt::format("{} positions are dead centres: velocities have no value there\n", flat));
  if (open == 0) return ExitStatus::done;
  note(fmt::format("{} of {} positions cannot be assembled\n", open, motion.times.size()));
  return ExitStatus::no;
}

}  // namespace oblique::cli
