// SPDX-License-Identifier: MIT
#include <oblique/report/motion_text.h>

#include <algorithm>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {
namespace {

/// "crank = 137.812 deg" at a moment.
std::string drive_at(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = mechanism::DriveClock(mechanism).at(0, time).value;
  return drive.slide ? fmt::format("{} = {:.9g} {}", drive.name, value, mechanism.length_unit)
                     : fmt::format("{} = {:.9g} deg", drive.name, value * 180 / std::numbers::pi);
}

std::string event_text(mechanism::MotionEvent::Kind kind, const std::string& where,
                       const std::string& group) {
  switch (kind) {
    case mechanism::MotionEvent::Kind::limit:
      return fmt::format("limit at {}: a dead centre of {}, which cannot be assembled beyond\n", where,
                         group);
    case mechanism::MotionEvent::Kind::return_:
      return fmt::format("from {} on {} can be assembled again, on the branch that it left\n", where, group);
    case mechanism::MotionEvent::Kind::change:
      return fmt::format("change point at {}: the modes of {} meet, and its velocity carries it on\n", where,
                         group);
    case mechanism::MotionEvent::Kind::infinity:
      return fmt::format("infinity at {}: {} recedes to infinity and comes back from the other side\n", where,
                         group);
    case mechanism::MotionEvent::Kind::lost:
      return fmt::format("lost at {}: no step leads {} on, and that this is a limit is not proven\n", where,
                         group);
  }
  return {};
}

}  // namespace

std::vector<text::TableColumn> motion_table_columns(const mechanism::Mechanism& mechanism) {
  std::vector<text::TableColumn> columns;
  for (const mechanism::MotionColumnName& column : mechanism::motion_column_names(mechanism))
    columns.push_back({column.name, column.unit});
  text::TableColumn& status = columns.emplace_back(text::TableColumn{"status"});
  using mechanism::Status;
  for (const Status value : {Status::ok, Status::dead_centre, Status::open})
    status.labels.emplace_back(mechanism::status_name(value));
  return columns;
}

MotionDigest::MotionDigest(std::size_t positions) : positions_(positions) {
  constexpr std::size_t kMostRows = 13;
  chosen_ = spread_rows(positions, kMostRows);
}

void MotionDigest::add(std::span<const double> values, mechanism::Status status) {
  if (rows_.size() < chosen_.size() && chosen_[rows_.size()] == added_) {
    rows_.emplace_back(values.begin(), values.end());
    statuses_.push_back(status);
  }
  open_ += status == mechanism::Status::open ? 1 : 0;
  dead_centres_ += status == mechanism::Status::dead_centre ? 1 : 0;
  ++added_;
}

Table MotionDigest::table(const mechanism::Mechanism& mechanism, std::size_t most_columns) const {
  const std::vector<mechanism::MotionColumnName> names = mechanism::motion_column_names(mechanism);
  std::vector<std::size_t> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const bool coordinate = names[c].name.ends_with(".x") || names[c].name.ends_with(".y");
    if (c <= mechanism.drives.size() || coordinate) columns.push_back(c);
  }
  columns.resize(std::min(columns.size(), most_columns - 1));
  std::vector<std::string> header, units;
  for (const std::size_t c : columns) {
    header.push_back(names[c].name);
    units.push_back("[" + names[c].unit + "]");
  }
  header.emplace_back("status");
  units.emplace_back();
  Table table(header);
  table.add(units);
  const double size = mechanism.largest_length();
  for (std::size_t row = 0; row < rows_.size(); ++row) {
    std::vector<std::string> cells;
    cells.reserve(columns.size() + 1);
    for (const std::size_t c : columns) cells.push_back(short_number(rows_[row][c], size));
    cells.emplace_back(mechanism::status_name(statuses_[row]));
    table.add(cells);
  }
  return table;
}

std::string MotionDigest::remarks(const text::Vocabulary& vocabulary) const {
  std::string text;
  if (dead_centres_ > 0) {
    text += fmt::format("{} positions are dead centres: velocities have no value there\n", dead_centres_);
  }
  if (open_ > 0) {
    text += fmt::format(
        "{} of {} positions cannot be assembled; {} or reverse keeps the motion within its range\n", open_,
        positions_, vocabulary.setting({"at-limit", "stop"}));
  }
  return text;
}

std::string events_text(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                        const std::vector<mechanism::MotionEvent>& events) {
  constexpr std::size_t kMost = 8;
  std::string text;
  for (std::size_t i = 0; i < std::min(events.size(), kMost); ++i) {
    text += event_text(events[i].kind, drive_at(mechanism, events[i].time),
                       structure.groups[events[i].group].name);
  }
  if (events.size() > kMost) text += fmt::format("({} more)\n", events.size() - kMost);
  return text;
}

}  // namespace oblique::report
