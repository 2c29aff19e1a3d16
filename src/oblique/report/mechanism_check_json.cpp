// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check_json.h>

#include <array>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <oblique/report/json_text.h>
#include <oblique/report/mechanism_check_tables.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json point(const std::optional<Eigen::Vector2d>& value) {
  return value ? Json{value->x(), value->y()} : Json(nullptr);
}

Json reading(const mechanism::Reading& reading) {
  return {{"value", reading.value}, {"drive", reading.drive}, {"time", reading.time}};
}

class JsonReport {
 public:
  explicit JsonReport(const MechanismCheck& check)
      : check_(check), mechanism_(check.mechanism), analysis_(check.analysis) {}

  Json write() const {
    Json groups = Json::array();
    for (const mechanism::Group& group : check_.structure.groups)
      groups.push_back({{"name", group.name}, {"description", describe(mechanism_, group)}});
    Json json{{"file", check_.file},
              {"kind", "mechanism"},
              {"title", mechanism_.title},
              {"bodies", mechanism_.bodies.size()},
              {"mobility", analysis_.mobility.gruebler},
              {"drives", mechanism_.drives.size()},
              {"groups", std::move(groups)},
              {"ok", !check_.finding},
              {"finding", check_.finding ? Json(*check_.finding) : Json(nullptr)},
              {"length_unit", mechanism_.length_unit},
              {"mobility_by_rank", mobility()},
              {"four_bars", four_bars()},
              {"sliders", sliders()}};
    json["tour"] = analysis_.motion_range ? motion_range() : Json(nullptr);
    json["transmissions"] = transmissions();
    json["swings"] = swings();
    json["paths"] = paths();
    json["instant_centres"] = centres();
    json["inertia"] = inertia();
    json["remarks"] = analysis_.motion_range ? Json(remarks(check_)) : Json::array();
    return json;
  }

 private:
  const std::string& group(std::size_t g) const { return check_.structure.groups[g].name; }
  const std::string& body(std::size_t b) const { return mechanism_.bodies[b].name; }

  Json mobility() const {
    constexpr std::array kVerdicts{"agrees", "shaky", "overconstrained"};
    const mechanism::MobilityReport& report = analysis_.mobility;
    return {{"mobility", report.start.mobility()},
            {"rank", report.start.rank},
            {"conditions", report.start.conditions},
            {"coordinates", report.start.coordinates},
            {"least_kept", report.start.least_kept},
            {"largest_lost", report.start.largest_lost},
            {"beside", report.beside ? Json(report.beside->mobility()) : Json(nullptr)},
            {"verdict", kVerdicts[static_cast<std::size_t>(report.verdict)]}};
  }

  Json four_bars() const {
    Json all = Json::array();
    for (const mechanism::FourBarLoop& loop : analysis_.four_bars) {
      Json links = Json::array(), shortest = Json::array();
      for (const mechanism::LoopLink& link : loop.links) {
        links.push_back({{"body", link.body ? Json(body(*link.body)) : Json(nullptr)},
                         {"from", mechanism_.points[link.from].name},
                         {"to", mechanism_.points[link.to].name},
                         {"length", link.length}});
      }
      for (const std::size_t i : loop.shortest) shortest.push_back(i);
      all.push_back({{"group", group(loop.group)},
                     {"class", mechanism::grashof_name(loop.type)},
                     {"links", std::move(links)},
                     {"shortest", std::move(shortest)},
                     {"shortest_and_longest", loop.shortest_and_longest},
                     {"others", loop.others}});
    }
    return all;
  }

  Json sliders() const {
    Json all = Json::array();
    for (const mechanism::SliderLoop& loop : analysis_.sliders) {
      all.push_back({{"group", group(loop.group)},
                     {"kind", loop.is_lever ? "slotted lever" : "slider-crank"},
                     {"crank", body(loop.crank)},
                     {"rod", body(loop.rod)},
                     {"radius", loop.radius},
                     {"length", loop.length},
                     {"offset", loop.offset},
                     {"rotation", mechanism::slider_loop_name(loop.type)}});
    }
    return all;
  }

  Json event(const std::optional<mechanism::MotionEvent>& event) const {
    if (!event) return nullptr;
    return {{"drive", mechanism::DriveClock(mechanism_).at(0, event->time).value},
            {"time", event->time},
            {"group", group(event->group)}};
  }

  Json motion_range() const {
    constexpr std::array kKinds{"turn", "until", "limits", "to limit"};
    const mechanism::MotionRange& motion_range = *analysis_.motion_range;
    Json changes = Json::array();
    for (const mechanism::MotionEvent& change : motion_range.changes) changes.push_back(event(change));
    return {{"kind", kKinds[static_cast<std::size_t>(motion_range.kind)]},
            {"begin", motion_range.begin},
            {"end", motion_range.end},
            {"closed", motion_range.closed},
            {"backward_limit", event(motion_range.range.backward)},
            {"forward_limit", event(motion_range.range.forward)},
            {"change_points", std::move(changes)}};
  }

  Json transmissions() const {
    Json all = Json::array();
    for (const mechanism::Transmission& t : analysis_.transmissions) {
      all.push_back({{"group", group(t.group)},
                     {"measure", t.measure == mechanism::Transmission::Measure::determinant
                                     ? "regularity"  // the format's word for it
                                     : mechanism::measure_name(t.measure)},
                     {"least", reading(t.least)},
                     {"greatest", reading(t.greatest)},
                     {"poor", t.is_poor()}});
    }
    return all;
  }

  static Json dwells(const std::vector<mechanism::Dwell>& dwells) {
    Json all = Json::array();
    for (const mechanism::Dwell& dwell : dwells) {
      all.push_back({{"begin", dwell.begin},
                     {"end", dwell.end},
                     {"begin_drive", dwell.begin_drive},
                     {"end_drive", dwell.end_drive}});
    }
    return all;
  }

  Json swings() const {
    constexpr std::array kKinds{"turns", "wavers", "swings", "progresses", "rests"};
    Json all = Json::array();
    for (const mechanism::Sweep& swing : analysis_.swings) {
      all.push_back({{swing.is_slide ? "slide" : "body",
                      swing.is_slide ? mechanism_.slides[swing.index].name : body(swing.index)},
                     {"motion", kKinds[static_cast<std::size_t>(swing.kind)]},
                     {"least", reading(swing.least)},
                     {"greatest", reading(swing.greatest)},
                     {"stroke", swing.stroke()},
                     {"gain", swing.gain},
                     {"reversals", swing.reversals},
                     {"rising", swing.rising},
                     {"falling", swing.falling},
                     {"time_ratio", or_null(swing.time_ratio)},
                     {"dwells", dwells(swing.dwells)}});
    }
    return all;
  }

  Json paths() const {
    Json all = Json::array();
    for (const mechanism::PathReport& path : analysis_.paths) {
      all.push_back({{"point", mechanism_.points[path.measure.point].name},
                     {"length", path.measure.length},
                     {"area", or_null(path.measure.area)},
                     {"left", reading(path.left)},
                     {"right", reading(path.right)},
                     {"bottom", reading(path.bottom)},
                     {"top", reading(path.top)},
                     {"dwells", dwells(path.dwells)}});
    }
    return all;
  }

  Json centres() const {
    Json all = Json::array();
    for (const mechanism::InstantCentre& centre : analysis_.centres) {
      all.push_back(
          {{"bodies", {centre.first ? Json(body(*centre.first)) : Json(nullptr), body(centre.second)}},
           {"position", point(centre.position)},
           {"direction", point(centre.direction)}});
    }
    return all;
  }

  Json inertia() const {
    if (!analysis_.inertia) return nullptr;
    Json bars = Json::array();
    for (const auto& bar : analysis_.inertia->bars)
      bars.push_back({{"body", body(bar.body)}, {"mass", bar.mass}, {"inertia", bar.inertia}});
    return {{"bars", std::move(bars)},
            {"least", reading(analysis_.inertia->least)},
            {"greatest", reading(analysis_.inertia->greatest)},
            {"least_energy", reading(analysis_.inertia->least_energy)},
            {"greatest_energy", reading(analysis_.inertia->greatest_energy)}};
  }

  const MechanismCheck& check_;
  const mechanism::Mechanism& mechanism_;
  const mechanism::MechanismAnalysis& analysis_;
};

}  // namespace

std::string to_json(const MechanismCheck& check) {
  return json_text(JsonReport(check).write());
}

}  // namespace oblique::report
