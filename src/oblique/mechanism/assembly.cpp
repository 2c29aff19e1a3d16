// SPDX-License-Identifier: MIT
#include <oblique/mechanism/assembly.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

namespace oblique {
namespace {

/// Distances from the sketch that differ by less than this, relative to r₁ + r₂, do not decide.
constexpr double kUndecidedWithin = 1e-9;

/// A dyad assembled on either side; `status` is the same for both.
struct Candidate {
  int side;
  Status status;
  Configuration configuration;
};

std::array<Candidate, 2> candidates(const Mechanism& mechanism, const DyadGroup& dyad,
                                    const Configuration& before) {
  const auto assemble = [&](int side) {
    DyadGroup on_side = dyad;
    on_side.side = side;
    Candidate candidate{side, Status::open, before};
    candidate.status = place_dyad(mechanism, on_side, candidate.configuration);
    return candidate;
  };
  return {assemble(+1), assemble(-1)};
}

bool is_placed(const Configuration& configuration, std::size_t point) {
  return !std::isnan(configuration.points[point].position.x());
}

class ModeChooser {
 public:
  ModeChooser(const Mechanism& mechanism, Structure& structure)
      : mechanism_(mechanism), structure_(structure), configuration_(frame_configuration(mechanism)) {}

  /// A dyad without a mode leaves its points NaN; the groups that hang on it are passed over, all others are
  /// judged.
  void run() {
    const std::vector<double> angles = drive_angles(mechanism_, 0);
    for (Group& group : structure_.groups) {
      if (const auto* crank = std::get_if<CrankGroup>(&group)) {
        place_crank(mechanism_, *crank, angles[crank->drive], configuration_);
        continue;
      }
      auto& dyad = std::get<DyadGroup>(group);
      if (is_placed(configuration_, dyad.p) && is_placed(configuration_, dyad.q)) choose(dyad);
    }
    if (!findings_.empty()) throw MechanismError(kind_, std::move(findings_));
  }

 private:
  void choose(DyadGroup& dyad) {
    auto both = candidates(mechanism_, dyad, configuration_);
    if (both[0].status == Status::open) {
      report_open(dyad);
      return;
    }
    std::array<double, 2> far{};
    bool sketched = false;
    for (const SketchPoint& mark : mechanism_.sketch) {
      if (mark.point == dyad.p || mark.point == dyad.q) continue;
      if (mechanism_.bodies[dyad.body1].find(mark.point) == nullptr &&
          mechanism_.bodies[dyad.body2].find(mark.point) == nullptr) {
        continue;
      }
      sketched = true;
      for (std::size_t i = 0; i < 2; ++i) {
        far[i] =
            std::hypot(far[i], (both[i].configuration.points[mark.point].position - mark.position).norm());
      }
    }
    if (!sketched || std::abs(far[0] - far[1]) <= kUndecidedWithin * (dyad.r1 + dyad.r2)) {
      report_undecided(dyad, both, sketched);
      return;
    }
    Candidate& chosen = far[0] < far[1] ? both[0] : both[1];
    dyad.side = chosen.side;
    configuration_ = std::move(chosen.configuration);
  }

  void report_open(const DyadGroup& dyad) {
    const std::string& unit = mechanism_.length_unit;
    const double distance =
        (configuration_.points[dyad.q].position - configuration_.points[dyad.p].position).norm();
    add(MechanismError::Kind::assembly, dyad,
        fmt::format("dyad '{}' cannot be assembled at the start: its pivots '{}' and '{}' are {:.6g} {} "
                    "apart, and '{}' "
                    "({} to {}: {:.6g} {}) and '{}' ({} to {}: {:.6g} {}) do not meet",
                    dyad.name, point_name(dyad.p), point_name(dyad.q), distance, unit,
                    mechanism_.bodies[dyad.body1].name, point_name(dyad.p), point_name(dyad.c), dyad.r1, unit,
                    mechanism_.bodies[dyad.body2].name, point_name(dyad.q), point_name(dyad.c), dyad.r2,
                    unit),
        fmt::format("a distance of the pivots from {:.6g} to {:.6g} {}", std::abs(dyad.r1 - dyad.r2),
                    dyad.r1 + dyad.r2, unit),
        "change a length, or the start of the drive");
  }

  void report_undecided(const DyadGroup& dyad, const std::array<Candidate, 2>& both, bool sketched) {
    const std::string& hinge = point_name(dyad.c);
    if (both[0].status == Status::dead_centre) {
      add(MechanismError::Kind::sketch, dyad,
          fmt::format("dyad '{}' is at a dead centre at the start: its assembly modes coincide", dyad.name),
          {}, "start the drive at another angle and sketch that position");
      return;
    }
    const auto line = [&](const Candidate& candidate) {
      const Eigen::Vector2d& at = candidate.configuration.points[dyad.c].position;
      return fmt::format("\n    {} = [{:.6g}, {:.6g}]   # {} of {} → {}", hinge, at.x(), at.y(),
                         candidate.side > 0 ? "left" : "right", point_name(dyad.p), point_name(dyad.q));
    };
    add(MechanismError::Kind::sketch, dyad,
        sketched ? fmt::format("the sketch is equally far from both assembly modes of dyad '{}'", dyad.name)
                 : fmt::format("dyad '{}' has two assembly modes and no point in [sketch]", dyad.name),
        "a rough position at the start of a point that the two modes place differently",
        "put one of these lines into [sketch]" + line(both[0]) + line(both[1]));
  }

  void add(MechanismError::Kind kind, const DyadGroup& dyad, std::string what, std::string expected,
           std::string remedy) {
    if (findings_.empty() || kind == MechanismError::Kind::assembly) kind_ = kind;
    findings_.push_back(
        {mechanism_.bodies[dyad.body1].place, std::move(what), std::move(expected), std::move(remedy)});
  }

  const std::string& point_name(std::size_t point) const { return mechanism_.points[point].name; }

  const Mechanism& mechanism_;
  Structure& structure_;
  Configuration configuration_;
  std::vector<Diagnostic> findings_;
  MechanismError::Kind kind_ = MechanismError::Kind::sketch;
};

/// The points that a group places.
std::vector<std::size_t> new_points(const Mechanism& mechanism, const Group& group,
                                    const Configuration& before) {
  std::vector<std::size_t> points;
  for (const std::size_t body : group_bodies(group)) {
    for (const BodyPoint& p : mechanism.bodies[body].points) {
      if (!is_placed(before, p.point) && std::count(points.begin(), points.end(), p.point) == 0)
        points.push_back(p.point);
    }
  }
  return points;
}

AssemblyMode mode_of(int side, bool selected, const std::vector<std::size_t>& points,
                     const Configuration& configuration) {
  AssemblyMode mode{side, selected, points, {}};
  for (const std::size_t point : points) mode.positions.push_back(configuration.points[point].position);
  return mode;
}

}  // namespace

void choose_modes(const Mechanism& mechanism, Structure& structure) {
  ModeChooser(mechanism, structure).run();
}

std::vector<GroupModes> assembly_modes(const Mechanism& mechanism, const Structure& structure,
                                       std::span<const double> angles) {
  Configuration configuration = frame_configuration(mechanism);
  std::vector<GroupModes> all;
  for (std::size_t i = 0; i < structure.groups.size(); ++i) {
    const Group& group = structure.groups[i];
    const auto points = new_points(mechanism, group, configuration);
    GroupModes modes{i, {}};
    if (const auto* crank = std::get_if<CrankGroup>(&group)) {
      if (is_placed(configuration, crank->pivot)) {
        place_crank(mechanism, *crank, angles[crank->drive], configuration);
        modes.modes.push_back(mode_of(0, true, points, configuration));
      }
    } else {
      const auto& dyad = std::get<DyadGroup>(group);
      const Configuration before = configuration;
      for (Candidate& candidate : candidates(mechanism, dyad, before)) {
        const bool selected = candidate.side == dyad.side;
        if (candidate.status == Status::open) continue;
        if (candidate.status == Status::dead_centre && !selected) continue;
        modes.modes.push_back(mode_of(candidate.side, selected, points, candidate.configuration));
        if (selected) configuration = std::move(candidate.configuration);
      }
    }
    all.push_back(std::move(modes));
  }
  return all;
}

}  // namespace oblique
