// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure.h>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/assembly.h>

namespace oblique {
namespace {

constexpr std::size_t kNone = static_cast<std::size_t>(-1);

std::string quoted_names(const Mechanism& mechanism, const std::vector<std::size_t>& bodies) {
  std::vector<std::string> names;
  names.reserve(bodies.size());
  for (const std::size_t body : bodies) names.push_back("'" + mechanism.bodies[body].name + "'");
  return fmt::format("{} {}", names.size() == 1 ? "body" : "bodies", fmt::join(names, ", "));
}

/// Points that only one body names and frame points that none names: where a hinge may have been meant.
std::string loose_ends(const Mechanism& mechanism) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    const std::size_t needed = mechanism.points[i].fixed ? 1 : 2;
    if (mechanism.bodies_at(i).size() < needed) names.push_back(mechanism.points[i].name);
  }
  if (names.empty()) return {};
  return fmt::format("; no hinge at {}: is a name misspelt?", fmt::join(names, ", "));
}

void check_mobility(const Mechanism& mechanism) {
  const int freedom = mobility(mechanism);
  const int drives = static_cast<int>(mechanism.drives.size());
  if (freedom == drives) return;
  Diagnostic finding;
  finding.place = drives > 0 ? mechanism.drives.back().place : mechanism.bodies.front().place;
  finding.what =
      fmt::format("the mechanism has mobility {} (3·{} bodies − 2·{} hinges) but {} {}", freedom,
                  mechanism.bodies.size(), (3 * static_cast<int>(mechanism.bodies.size()) - freedom) / 2,
                  drives, drives == 1 ? "drive" : "drives");
  finding.expected = "one drive for each degree of freedom";
  if (freedom > drives) {
    finding.remedy = fmt::format("under-driven: add {} or join bodies by hinges",
                                 freedom - drives == 1 ? "a drive" : "drives") +
                     loose_ends(mechanism);
  } else {
    finding.remedy = freedom < 0 ? "over-constrained: leave out bodies or hinges"
                                 : "over-driven: leave out drives, or add bodies";
  }
  throw MechanismError(MechanismError::Kind::mobility, std::move(finding));
}

/// Grows the set of known points group by group.
class Decomposition {
 public:
  explicit Decomposition(const Mechanism& mechanism)
      : mechanism_(mechanism), known_(mechanism.points.size()), placed_(mechanism.bodies.size()) {
    for (std::size_t i = 0; i < mechanism.points.size(); ++i) known_[i] = mechanism.points[i].fixed;
  }

  Structure run() {
    while (take_overconstrained() || take_crank() || take_dyad()) {
    }
    report_remainder();
    if (!findings_.empty()) throw MechanismError(kind_, std::move(findings_));
    return std::move(structure_);
  }

 private:
  std::vector<std::size_t> known_points(std::size_t body) const {
    std::vector<std::size_t> points;
    for (const BodyPoint& p : mechanism_.bodies[body].points) {
      if (known_[p.point]) points.push_back(p.point);
    }
    return points;
  }

  void place(std::size_t body) {
    placed_[body] = true;
    for (const BodyPoint& p : mechanism_.bodies[body].points) known_[p.point] = true;
  }

  /// A body on two known points is one constraint too many; it counts as placed to find the rest.
  bool take_overconstrained() {
    for (std::size_t body = 0; body < placed_.size(); ++body) {
      const auto points = placed_[body] ? std::vector<std::size_t>{} : known_points(body);
      if (points.size() < 2) continue;
      add(MechanismError::Kind::mobility, mechanism_.bodies[body].place,
          fmt::format("body '{}' is over-constrained: the other bodies move its points '{}' and '{}' already",
                      mechanism_.bodies[body].name, mechanism_.points[points[0]].name,
                      mechanism_.points[points[1]].name),
          "at most one such point", "leave the body out, or remove another drive or hinge");
      place(body);
      return true;
    }
    return false;
  }

  bool take_crank() {
    for (std::size_t i = 0; i < mechanism_.drives.size(); ++i) {
      const Drive& drive = mechanism_.drives[i];
      if (placed_[drive.body] || !known_[drive.about]) continue;
      structure_.groups.emplace_back(
          CrankGroup{mechanism_.bodies[drive.body].name, drive.body, drive.about, i});
      place(drive.body);
      return true;
    }
    return false;
  }

  bool take_dyad() {
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      if (!hangs_on_one(i)) continue;
      for (std::size_t j = i + 1; j < placed_.size(); ++j) {
        if (!hangs_on_one(j)) continue;
        const std::size_t hinge = common_unknown(i, j);
        if (hinge == kNone) continue;
        add_dyad(i, j, hinge);
        return true;
      }
    }
    return false;
  }

  bool hangs_on_one(std::size_t body) const {
    return !placed_[body] && !mechanism_.drive_of(body) && known_points(body).size() == 1;
  }

  std::size_t common_unknown(std::size_t first, std::size_t second) const {
    for (const BodyPoint& p : mechanism_.bodies[first].points) {
      if (!known_[p.point] && mechanism_.bodies[second].find(p.point) != nullptr) return p.point;
    }
    return kNone;
  }

  void add_dyad(std::size_t first, std::size_t second, std::size_t hinge) {
    const Body& body1 = mechanism_.bodies[first];
    const Body& body2 = mechanism_.bodies[second];
    DyadGroup dyad;
    dyad.name = body1.name + "-" + body2.name;
    dyad.body1 = first;
    dyad.p = known_points(first).front();
    dyad.body2 = second;
    dyad.q = known_points(second).front();
    dyad.c = hinge;
    dyad.r1 = distance(body1, dyad.p, hinge);
    dyad.r2 = distance(body2, dyad.q, hinge);
    structure_.groups.emplace_back(std::move(dyad));
    place(first);
    place(second);
  }

  /// Judges each connected part of what could not be placed.
  void report_remainder() {
    std::vector<bool> seen = placed_;
    for (std::size_t body = 0; body < seen.size(); ++body) {
      if (seen[body]) continue;
      std::vector<std::size_t> part{body};
      seen[body] = true;
      for (std::size_t next = 0; next < part.size(); ++next) {
        for (std::size_t other = 0; other < seen.size(); ++other) {
          if (seen[other] || common_unknown(part[next], other) == kNone) continue;
          seen[other] = true;
          part.push_back(other);
        }
      }
      std::sort(part.begin(), part.end());
      report_part(part);
    }
  }

  void report_part(const std::vector<std::size_t>& part) {
    const std::string names = quoted_names(mechanism_, part);
    const Place& at = mechanism_.bodies[part.front()].place;
    int freedom = 3 * static_cast<int>(part.size());
    std::vector<std::size_t> points;
    for (const std::size_t body : part) {
      if (mechanism_.drive_of(body)) --freedom;
      for (const BodyPoint& p : mechanism_.bodies[body].points) {
        if (known_[p.point] || std::count(points.begin(), points.end(), p.point) > 0) freedom -= 2;
        points.push_back(p.point);
      }
    }
    if (freedom > 0) {
      add(MechanismError::Kind::mobility, at,
          fmt::format("{} can move freely (mobility {} after the drives)", names, freedom),
          "every body held by drives and hinges", "hinge to the rest, or drive" + loose_ends(mechanism_));
    } else if (freedom < 0) {
      add(MechanismError::Kind::mobility, at,
          fmt::format("{} are over-constrained (mobility {})", names, freedom), {},
          "leave out a body or a drive of this part");
    } else if (const auto driven =
                   std::find_if(part.begin(), part.end(),
                                [&](std::size_t b) { return mechanism_.drive_of(b).has_value(); });
               driven != part.end()) {
      const Drive& drive = mechanism_.drives[*mechanism_.drive_of(*driven)];
      add(MechanismError::Kind::group_class, drive.place,
          fmt::format("drive '{}' turns '{}' about '{}', whose motion depends on the driven body itself",
                      drive.name, mechanism_.bodies[drive.body].name, mechanism_.points[drive.about].name),
          "a point of the frame or of a body that is placed before",
          "this version drives cranks; drive a body with a known pivot");
    } else {
      add(MechanismError::Kind::group_class, at,
          fmt::format("{} form a group of class III or higher; this version handles cranks and dyads", names),
          {}, "drive another body so that only dyads remain, if the task allows it");
    }
  }

  void add(MechanismError::Kind kind, const Place& at, std::string what, std::string expected,
           std::string remedy) {
    if (findings_.empty() || kind == MechanismError::Kind::mobility) kind_ = kind;
    findings_.push_back({at, std::move(what), std::move(expected), std::move(remedy)});
  }

  const Mechanism& mechanism_;
  std::vector<bool> known_;
  std::vector<bool> placed_;
  Structure structure_;
  std::vector<Diagnostic> findings_;
  MechanismError::Kind kind_ = MechanismError::Kind::mobility;
};

}  // namespace

const std::string& group_name(const Group& group) {
  return std::visit([](const auto& g) -> const std::string& { return g.name; }, group);
}

std::vector<std::size_t> group_bodies(const Group& group) {
  if (const auto* dyad = std::get_if<DyadGroup>(&group)) return {dyad->body1, dyad->body2};
  return {std::get<CrankGroup>(group).body};
}

int mobility(const Mechanism& mechanism) {
  int hinges = 0;
  for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
    const int sharing = static_cast<int>(mechanism.bodies_at(i).size()) + (mechanism.points[i].fixed ? 1 : 0);
    hinges += std::max(0, sharing - 1);
  }
  return 3 * static_cast<int>(mechanism.bodies.size()) - 2 * hinges;
}

Structure find_groups(const Mechanism& mechanism) {
  check_mobility(mechanism);
  return Decomposition(mechanism).run();
}

Structure decompose(const Mechanism& mechanism) {
  Structure structure = find_groups(mechanism);
  choose_modes(mechanism, structure);
  return structure;
}

}  // namespace oblique
