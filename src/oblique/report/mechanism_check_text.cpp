// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check_text.h>

#include <fmt/format.h>

#include <oblique/report/mechanism_check_tables.h>
#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

class Report {
 public:
  explicit Report(const MechanismCheck& check)
      : check_(check), mechanism_(check.mechanism), analysis_(check.analysis) {}

  std::string write() {
    contents();
    if (analysis_.motion_range) limits();
    for (const CheckTable& table : tables_of(check_))
      text_ += "\n" + table.title + "\n" + table.table.text(table.left_columns);
    if (!analysis_.motion_range) return text_;
    std::string lines;
    for (const std::string& remark : remarks(check_)) lines += fmt::format("  {}\n", remark);
    if (!lines.empty()) text_ += "\nremarks\n" + lines;
    return text_;
  }

 private:
  void contents() {
    text_ += fmt::format("{}: a mechanism, \"{}\"\n", check_.file, mechanism_.title);
    text_ += fmt::format("  {}, mobility {}, {}\n", count(mechanism_.bodies.size(), "body", "bodies"),
                         analysis_.mobility.gruebler, count(mechanism_.drives.size(), "drive", "drives"));
    if (analysis_.mobility.verdict != mechanism::MobilityReport::Verdict::agrees) {
      const mechanism::JacobianRank& rank = analysis_.mobility.start;
      text_ += fmt::format(
          "  mobility by rank {}: {} of {} conditions on {} coordinates are independent at the start ({})\n",
          rank.mobility(), rank.rank, rank.conditions, rank.coordinates,
          analysis_.mobility.verdict == mechanism::MobilityReport::Verdict::shaky ? "shaky"
                                                                                  : "overconstrained");
    }
    for (const mechanism::Group& group : check_.structure.groups)
      text_ += fmt::format("  {}\n", describe(mechanism_, group));
    if (check_.finding) {
      text_ += fmt::format("no: {}\n", *check_.finding);
    } else if (mechanism_.drives.empty()) {
      text_ += "ok: a structure, which can be assembled and does not move\n";
    } else if (analysis_.motion_range->kind == mechanism::MotionRange::Kind::limits) {
      text_ += "ok: it can be assembled between the limits of its drive\n";
    } else if (analysis_.motion_range->kind == mechanism::MotionRange::Kind::until) {
      text_ += "ok: it can be assembled over the whole motion, without dead centres\n";
    } else {
      text_ += "ok: it can be assembled over the whole turn, without dead centres\n";
    }
  }

  void limits() {
    const mechanism::MotionRange& motion_range = *analysis_.motion_range;
    mechanism::DriveClock clock(mechanism_);
    const auto limit = [&](const char* word, const std::optional<mechanism::MotionEvent>& event) {
      if (!event) return std::string();
      std::string_view kind;
      if (event->kind == mechanism::MotionEvent::Kind::infinity) kind = ", which is at infinity";
      if (event->kind == mechanism::MotionEvent::Kind::lost) kind = ", which is not proven to be a limit";
      return fmt::format(" {} {} ({}{})", word, drive_text(check_, clock.at(0, event->time).value),
                         check_.structure.groups[event->group].name, kind);
    };
    if (motion_range.range.backward || motion_range.range.forward) {
      text_ += fmt::format("  range of '{}':{}{}; what follows is about that range\n",
                           mechanism_.drives.front().name, limit("from", motion_range.range.backward),
                           limit("to", motion_range.range.forward));
    }
    for (const mechanism::MotionEvent& change : motion_range.changes) {
      text_ +=
          fmt::format("  change point of {} at {} = {}\n", check_.structure.groups[change.group].name,
                      mechanism_.drives.front().name, drive_text(check_, clock.at(0, change.time).value));
    }
  }

  const MechanismCheck& check_;
  const mechanism::Mechanism& mechanism_;
  const mechanism::MechanismAnalysis& analysis_;
  std::string text_;
};

}  // namespace

std::string to_text(const MechanismCheck& check) {
  return Report(check).write();
}

}  // namespace oblique::report
