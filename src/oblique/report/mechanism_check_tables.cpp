// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check_tables.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::report {
namespace {

class Tables {
 public:
  explicit Tables(const MechanismCheck& check)
      : check_(check),
        mechanism_(check.mechanism),
        analysis_(check.analysis),
        unit_(check.mechanism.length_unit),
        size_(check.mechanism.largest_length()) {}

  std::vector<CheckTable> all() {
    four_bars();
    sliders();
    if (!analysis_.motion_range) return std::move(tables_);
    transmissions();
    bodies();
    slides();
    paths();
    centres();
    inertia();
    return std::move(tables_);
  }

 private:
  std::string length(double value) const {
    constexpr double kRounding = 1e-9;
    return fmt::format("{:.5g}", std::abs(value) < kRounding * size_ ? 0.0 : value);
  }
  static std::string degrees(double value) {
    const double shown = std::round(value / kDegree * 100) / 100;
    return fmt::format("{:.2f}", shown + 0.0);
  }
  static std::string number(double value) { return fmt::format("{:.4g}", value + 0.0); }
  std::string at(const mechanism::Reading& reading) const { return bare(drive_text(check_, reading.drive)); }
  /// Without its unit, which stands in the header.
  static std::string bare(const std::string& text) { return text.substr(0, text.find_first_of(" \xC2")); }
  const mechanism::Drive& drive() const { return mechanism_.drives.front(); }
  std::string at_header() const {
    return fmt::format("at {} [{}]", drive().name, drive().slide ? unit_ : "°");
  }

  std::string name_of(const mechanism::LoopLink& link) const {
    return link.body ? mechanism_.bodies[*link.body].name : "frame";
  }

  void four_bars() {
    if (analysis_.four_bars.empty()) return;
    Table table({"loop", "class", "shortest link", fmt::format("s + l [{}]", unit_),
                 fmt::format("p + q [{}]", unit_)});
    for (const mechanism::FourBarLoop& loop : analysis_.four_bars) {
      std::vector<std::string> links, shortest;
      for (const mechanism::LoopLink& link : loop.links) links.push_back(name_of(link));
      for (const std::size_t i : loop.shortest) shortest.push_back(name_of(loop.links[i]));
      table.add({fmt::format("{}", fmt::join(links, "-")), std::string(mechanism::grashof_name(loop.type)),
                 fmt::format("{}", fmt::join(shortest, ", ")), length(loop.shortest_and_longest),
                 length(loop.others)});
    }
    tables_.push_back(
        {"four-bar loops (shortest and longest link against the two others)", std::move(table), 3,
         "A link of a loop can turn fully where the shortest and the longest one together are no "
         "longer than the two others (Grashof)."});
  }

  void sliders() {
    if (analysis_.sliders.empty()) return;
    Table table({"loop", "kind", "rotation", fmt::format("r [{}]", unit_), fmt::format("l or d [{}]", unit_),
                 fmt::format("e [{}]", unit_)});
    for (const mechanism::SliderLoop& loop : analysis_.sliders) {
      table.add({fmt::format("{}-{}", mechanism_.bodies[loop.crank].name, mechanism_.bodies[loop.rod].name),
                 loop.is_lever ? "slotted lever" : "slider-crank",
                 std::string(mechanism::slider_loop_name(loop.type)), length(loop.radius),
                 length(loop.length), length(loop.offset)});
    }
    tables_.push_back({"cranks with slides (crank r, rod l or distance d of the pivots, offset e)",
                       std::move(table), 3,
                       "Three lengths decide whether the crank turns fully, and with it a slotted lever."});
  }

  void transmissions() {
    if (analysis_.transmissions.empty()) return;
    Table table({"group", "measure", "least", at_header(), "greatest", at_header(), ""});
    for (const mechanism::Transmission& t : analysis_.transmissions) {
      const bool angle = t.measure != mechanism::Transmission::Measure::determinant;
      const auto shown = [&](double value) {
        return angle ? degrees(value) + "°" : fmt::format("{:.4f}", value);
      };
      table.add({check_.structure.groups[t.group].name, std::string(mechanism::measure_name(t.measure)),
                 shown(t.least.value), at(t.least), shown(t.greatest.value), at(t.greatest),
                 t.is_poor() ? "poor" : ""});
    }
    tables_.push_back(
        {"transmission (best: angle 90°, pressure angle 0°, determinant 1)", std::move(table), 2,
         "How well each group passes forces on where it does so worst and best; an angle more than 60° from "
         "its best is called poor."});
  }

  std::string dwells_of(const std::vector<mechanism::Dwell>& dwells) const {
    std::vector<std::string> texts;
    texts.reserve(dwells.size());
    for (const mechanism::Dwell& dwell : dwells) {
      texts.push_back(fmt::format("{}–{}", bare(drive_text(check_, dwell.begin_drive)),
                                  bare(drive_text(check_, dwell.end_drive))));
    }
    return fmt::format("{}", fmt::join(texts, ", "));
  }

  std::string dwell_header() const {
    return fmt::format("dwell, {} [{}]", drive().name, drive().slide ? unit_ : "°");
  }

  static std::string motion_of(const mechanism::Sweep& swing) {
    switch (swing.kind) {
      case mechanism::Sweep::Kind::turns:
      case mechanism::Sweep::Kind::turns_with_reversals: {
        const auto turns = std::lround(std::abs(swing.gain) / (360 * kDegree));
        return fmt::format(
            "turns{}{}{}", turns == 1 ? "" : fmt::format(" {} times", turns),
            swing.gain > 0 ? " left" : " right",
            swing.kind == mechanism::Sweep::Kind::turns_with_reversals ? ", and back on the way" : "");
      }
      case mechanism::Sweep::Kind::monotone:
        return swing.gain > 0 ? "rises" : "falls";
      case mechanism::Sweep::Kind::stationary:
        return "rests";
      case mechanism::Sweep::Kind::oscillates:
        break;
    }
    return swing.reversals > 2 ? fmt::format("swings, {} reversals", swing.reversals) : "swings";
  }

  void add_swing(Table& table, const mechanism::Sweep& swing, const std::string& name, bool dwells) const {
    const auto shown = [&](double value) { return swing.is_slide ? length(value) : degrees(value); };
    std::vector<std::string> row{name, motion_of(swing)};
    if (swing.kind == mechanism::Sweep::Kind::oscillates || swing.kind == mechanism::Sweep::Kind::monotone) {
      row.insert(row.end(), {shown(swing.least.value), at(swing.least), shown(swing.greatest.value),
                             at(swing.greatest), shown(swing.stroke())});
    } else {  // a place only where it rests
      row.insert(row.end(), {swing.kind == mechanism::Sweep::Kind::stationary ? shown(swing.least.value) : "",
                             "", "", "", ""});
    }
    const bool times = swing.time_ratio.has_value();
    row.insert(row.end(), {times ? number(swing.rising) : "", times ? number(swing.falling) : "",
                           times ? fmt::format("{:.4f}", *swing.time_ratio) : ""});
    if (dwells) row.push_back(dwells_of(swing.dwells));
    table.add(row);
  }

  void swings(bool slides, const std::string& title, const std::string& unit, const char* explanation) {
    bool any = false, dwells = false;
    for (const mechanism::Sweep& swing : analysis_.swings) {
      if (swing.is_slide != slides) continue;
      any = true;
      dwells = dwells || !swing.dwells.empty();
    }
    if (!any) return;
    std::vector<std::string> header{slides ? "slide" : "body",
                                    "motion",
                                    fmt::format("least [{}]", unit),
                                    at_header(),
                                    fmt::format("greatest [{}]", unit),
                                    at_header(),
                                    fmt::format("stroke [{}]", unit),
                                    "rises [s]",
                                    "falls [s]",
                                    "time ratio"};
    if (dwells) header.push_back(dwell_header());
    Table table(header);
    for (const mechanism::Sweep& swing : analysis_.swings) {
      if (swing.is_slide != slides) continue;
      const auto& name = slides ? mechanism_.slides[swing.index].name : mechanism_.bodies[swing.index].name;
      add_swing(table, swing, name, dwells);
    }
    tables_.push_back({title, std::move(table), 2, explanation});
  }

  void bodies() {
    swings(
        false, "bodies (angle of first → second point)", "°",
        "Between which angles the bodies swing and for how long; the time ratio is that of the slower way to "
        "the quicker one.");
  }
  void slides() { swings(true, "slides", unit_, "Between which places the slides go, and for how long."); }

  void paths() {
    if (analysis_.paths.empty()) return;
    bool dwells = false, areas = false;
    for (const mechanism::PathReport& path : analysis_.paths) {
      dwells = dwells || !path.dwells.empty();
      areas = areas || path.measure.area;
    }
    std::vector<std::string> header{"point", fmt::format("length [{}]", unit_)};
    if (areas) header.push_back(fmt::format("area [{}²]", unit_));
    for (const char* side : {"x from", "to", "y from", "to"}) header.emplace_back(side);
    if (dwells) header.push_back(dwell_header());
    Table table(header);
    for (const mechanism::PathReport& path : analysis_.paths) {
      std::vector<std::string> row{mechanism_.points[path.measure.point].name, length(path.measure.length)};
      if (areas) row.push_back(path.measure.area ? area(*path.measure.area) : "");
      for (const mechanism::Reading* side : {&path.left, &path.right, &path.bottom, &path.top})
        row.push_back(length(side->value));
      if (dwells) row.push_back(dwells_of(path.dwells));
      table.add(row);
    }
    tables_.push_back({"paths (area: positive where the path runs counter-clockwise)", std::move(table), 1,
                       "How long the path of each moving point is, and within which rectangle it runs."});
  }

  std::string area(double value) const {
    constexpr double kRounding = 1e-9;
    return fmt::format("{:.5g}", std::abs(value) < kRounding * size_ * size_ ? 0.0 : value);
  }

  void centres() {
    Table table({"body", fmt::format("x [{}]", unit_), fmt::format("y [{}]", unit_), ""});
    for (const mechanism::InstantCentre& centre : analysis_.centres) {
      if (centre.first) continue;
      const std::string& name = mechanism_.bodies[centre.second].name;
      if (centre.position) {
        table.add({name, length(centre.position->x()), length(centre.position->y()), ""});
      } else if (centre.direction) {
        const double angle = std::atan2(centre.direction->y(), centre.direction->x());
        table.add({name, "∞", "∞", fmt::format("in the direction {}°", degrees(angle))});
      } else {
        table.add({name, "–", "–", "it has no velocity"});
      }
    }
    tables_.push_back({"instant centres against the frame, at the start", std::move(table), 1,
                       "The points about which the bodies turn at that moment."});
  }

  void inertia() {
    if (!analysis_.inertia) return;
    const mechanism::InertiaReport& report = *analysis_.inertia;
    Table bars({"body", "mass [kg]", "J [kg m²]"});
    for (const auto& bar : report.bars)
      bars.add({mechanism_.bodies[bar.body].name, number(bar.mass), number(bar.inertia)});
    tables_.push_back({"masses, as uniform bars from first to second point (J about the middle)",
                       std::move(bars), 1, "What the bodies weigh and how hard they are to turn."});
    Table table({"", "least", at_header(), "greatest", at_header()});
    table.add({drive().slide ? "reduced mass [kg]" : "reduced moment of inertia [kg m²]",
               number(report.least.value), at(report.least), number(report.greatest.value),
               at(report.greatest)});
    table.add({"kinetic energy [J]", number(report.least_energy.value), at(report.least_energy),
               number(report.greatest_energy.value), at(report.greatest_energy)});
    tables_.push_back({fmt::format("reduced to '{}'", drive().name), std::move(table), 1,
                       "The mass or moment of inertia that the drive feels, and the energy of the motion."});
  }

  const MechanismCheck& check_;
  const mechanism::Mechanism& mechanism_;
  const mechanism::MechanismAnalysis& analysis_;
  std::string unit_;
  double size_;  ///< largest length [length unit]
  std::vector<CheckTable> tables_;
};

}  // namespace

std::vector<CheckTable> tables_of(const MechanismCheck& check) {
  return Tables(check).all();
}

}  // namespace oblique::report
