// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check.h>

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <fmt/format.h>

#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::report {
namespace {

std::string poor_transmission(const MechanismCheck& check, const mechanism::Transmission& transmission) {
  const std::string& group = check.structure.groups[transmission.group].name;
  const auto say = [&](const char* what, const mechanism::Reading& at, const char* limit) {
    return fmt::format("the {} of {} {} {:.2f}° ({}) at {} = {}",
                       mechanism::measure_name(transmission.measure), group, what, at.value / kDegree, limit,
                       check.mechanism.drives.front().name, drive_text(check, at.drive));
  };
  constexpr double kLow = 30 * kDegree, kHigh = 150 * kDegree;
  switch (transmission.measure) {
    case mechanism::Transmission::Measure::transmission_angle: {
      // the end that is farther away from a right angle
      const bool low = kLow - transmission.least.value > transmission.greatest.value - kHigh;
      return low ? say("falls to", transmission.least, "below 30°")
                 : say("rises to", transmission.greatest, "above 150°");
    }
    case mechanism::Transmission::Measure::pressure_angle:
      return say("rises to", transmission.greatest, "above 60°");
    case mechanism::Transmission::Measure::determinant:
      break;  // is never called poor
  }
  return {};
}

/// What keeps the mechanism from turning; nothing where it turns, or is a structure.
std::optional<std::string> obstacle_of(const mechanism::Mechanism& mechanism,
                                       const mechanism::Structure& structure) {
  if (mechanism.drives.empty()) return std::nullopt;
  // one that moves a prismatic joint goes to and fro between its limits
  if (mechanism.drives.front().slide && !mechanism.motion.until) return std::nullopt;
  const auto obstacle = mechanism::find_obstacle(mechanism, structure);
  if (!obstacle) return std::nullopt;
  const char* const what = obstacle->infinite                                     ? "goes to infinity"
                           : obstacle->status == oblique::mechanism::Status::open ? "cannot be assembled"
                                                                                  : "passes a dead centre";
  return fmt::format("over one turn the group {} {} at t = {:.6g} s", structure.groups[obstacle->group].name,
                     what, obstacle->time);
}

}  // namespace

MechanismCheck examine(mechanism::Mechanism mechanism, const std::string& file) {
  MechanismCheck check;
  check.file = file;
  check.mechanism = std::move(mechanism);
  check.structure = mechanism::decompose(check.mechanism);
  check.finding = obstacle_of(check.mechanism, check.structure);
  check.analysis = mechanism::analyse(check.mechanism, check.structure);
  return check;
}

std::string describe(const mechanism::Mechanism& mechanism, const mechanism::Group& group) {
  using mechanism::GroupKind;
  const auto drive = [&] { return mechanism.drives[group.drives.front()].name; };
  const auto of_higher_class = [&](const char* how) {
    constexpr std::array<const char*, 9> kRoman{"", "I", "II", "III", "IV", "V", "VI", "VII", "VIII"};
    const auto number = static_cast<std::size_t>(group.assur_class);
    return fmt::format("group {} (class {}, order {}): {}{}", group.name,
                       number < kRoman.size() ? kRoman[number] : std::to_string(number), group.order, how,
                       group.drives.empty() ? "" : fmt::format(", driven inside by '{}'", drive()));
  };
  switch (group.form.kind) {
    case GroupKind::crank:
      return fmt::format("crank {}: turns about {} with drive '{}'", group.name,
                         mechanism.points[mechanism::pivot_of(group)].name, drive());
    case GroupKind::slider:
      return fmt::format("slider {}: moved along '{}' by drive '{}'", group.name,
                         mechanism.slides[group.slides.front()].name, drive());
    case GroupKind::rrr:
    case GroupKind::rrp:
    case GroupKind::prp:
    case GroupKind::rpr:
    case GroupKind::rpp:
      if (const auto& dyad = group.form.dyad) {
        return fmt::format("dyad {} (class II, RRR): {} lies {} of {} → {}", group.name,
                           mechanism.points[dyad->c].name, group.side > 0 ? "left" : "right",
                           mechanism.points[dyad->p].name, mechanism.points[dyad->q].name);
      }
      return fmt::format("dyad {} (class II, {})", group.name, mechanism::kind_name(group.form.kind));
    case GroupKind::triad:
      return of_higher_class("a triad, in closed form");
    case GroupKind::general:
      return of_higher_class("by Newton's method");
  }
  throw std::logic_error("a group of no kind");
}

std::string drive_text(const MechanismCheck& check, double value) {
  if (check.mechanism.drives.front().slide) {
    const double rounding = 1e-9 * check.mechanism.largest_length();
    return fmt::format("{:.5g} {}", std::abs(value) < rounding ? 0.0 : value, check.mechanism.length_unit);
  }
  constexpr double kShown = 0.005;  // half of the last digit
  double degrees = value / kDegree;
  if (check.analysis.motion_range->kind == mechanism::MotionRange::Kind::turn) {
    degrees = std::fmod(std::fmod(degrees, 360) + 360, 360);
    if (degrees > 360 - kShown) degrees = 0;
  }
  return fmt::format("{:.2f}°", std::abs(degrees) < kShown ? 0.0 : degrees);
}

std::vector<std::string> remarks(const MechanismCheck& check) {
  std::vector<std::string> all;
  const mechanism::MechanismAnalysis& analysis = check.analysis;
  const mechanism::MobilityReport& mobility = analysis.mobility;
  if (mobility.verdict == mechanism::MobilityReport::Verdict::shaky) {
    all.push_back(fmt::format(
        "shaky: by rank the mobility is {} at the start, but {} a little on, as by Grübler's formula: the "
        "start is a dead centre or a change point",
        mobility.start.mobility(), mobility.gruebler));
  } else if (mobility.verdict == mechanism::MobilityReport::Verdict::overconstrained) {
    all.push_back(fmt::format(
        "overconstrained: by rank the mobility is {} and not {}, wherever it was looked at: conditions are "
        "redundant by its dimensions",
        mobility.start.mobility(), mobility.gruebler));
  }
  for (const mechanism::Transmission& transmission : analysis.transmissions) {
    if (transmission.is_poor()) all.push_back(poor_transmission(check, transmission));
  }
  return all;
}

}  // namespace oblique::report
