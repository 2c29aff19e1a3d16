// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/assembly.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/solver/free_turn.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/rank.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/mechanism/triad/triangle.h>

namespace oblique::mechanism {
namespace {

/// Distances from the sketch that differ by less than this, relative to the largest length, do not decide.
constexpr double kUndecidedWithin = 1e-9;

bool is_placed(const Configuration& configuration, std::size_t point) {
  return !std::isnan(configuration.points[point].position.x());
}

/// A pose tried out: where it puts the group's points.
struct Candidate {
  GroupPose pose;
  Status status = Status::open;
  Configuration configuration;
};

std::vector<Candidate> candidates(GroupSolver& solver, std::span<const DriveState> drives,
                                  const GroupPoses& poses, const Configuration& before) {
  std::vector<Candidate> all;
  for (const GroupPose& pose : poses.poses) {
    Candidate candidate{pose, Status::open, before};
    candidate.status = solver.place(drives, pose, candidate.configuration);
    if (candidate.status != Status::open) all.push_back(std::move(candidate));
  }
  return all;
}

class ModeChooser {
 public:
  ModeChooser(const Mechanism& mechanism, Structure& structure)
      : mechanism_(mechanism),
        structure_(structure),
        kinematics_(mechanism, structure),
        drives_(mechanism.drives.size()),
        here_(frame_configuration(mechanism)) {
    DriveClock(mechanism).at(0, drives_);
  }

  /// A group without a mode leaves its points NaN; the groups that hang on it are passed over, all others are
  /// judged.
  void run() {
    for (std::size_t g = 0; g < structure_.groups.size(); ++g) {
      if (stands_on_placed(structure_.groups[g])) choose(g);
    }
    if (!findings_.empty()) throw MechanismError(kind_, std::move(findings_));
  }

  /// As `run`, without a finding where only the sketch is wanting.
  std::vector<std::size_t> run_undecided() {
    take_first_ = true;
    run();
    return std::move(undecided_);
  }

 private:
  bool stands_on_placed(const Group& group) const {
    const auto good = [&](const PointRef& point) {
      return point.kind != PointRef::Kind::known || is_placed(here_, point.point);
    };
    return std::all_of(
        group.equations.conditions.begin(), group.equations.conditions.end(), [&](const Condition& c) {
          const bool two = c.kind == Condition::Kind::distance || c.kind == Condition::Kind::coincidence;
          const bool line =
              c.line.kind != LineRef::Kind::known || !std::isnan(here_.bodies[c.line.body].cosine);
          const bool first = c.kind == Condition::Kind::orientation || good(c.a);
          return first && line && (!two || good(c.b));
        });
  }

  /// A guess of the group's pose from the sketched points of its links; the others lie among them.
  GroupPose sketched_pose(const Group& group) const {
    const auto sketched = [&](std::size_t point) -> std::optional<Eigen::Vector2d> {
      if (is_placed(here_, point)) return here_.points[point].position;
      for (const SketchPoint& mark : mechanism_.sketch) {
        if (mark.point == point) return mark.position;
      }
      return std::nullopt;
    };
    GroupPose pose;
    for (const std::size_t platform : group.equations.platforms) {
      std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>> pairs;  // in the link, in the world
      for (const BodyPoint& p : mechanism_.bodies[platform].points) {
        if (const auto at = sketched(p.point)) pairs.emplace_back(p.local, *at);
      }
      Eigen::Vector2d local = Eigen::Vector2d::Zero(), world = local;
      for (const auto& [in_body, in_world] : pairs) {
        local += in_body / static_cast<double>(pairs.size());
        world += in_world / static_cast<double>(pairs.size());
      }
      double cosine = 0, sine = 0;  // the best rotation: the sum of the complex quotients
      for (const auto& [in_body, in_world] : pairs) {
        const Eigen::Vector2d b = in_world - world;
        cosine += in_body.dot(b);
        sine += in_body.x() * b.y() - in_body.y() * b.x();
      }
      const double norm = std::hypot(cosine, sine);
      cosine = norm > 0 ? cosine / norm : 1;
      sine = norm > 0 ? sine / norm : 0;
      pose.platforms.push_back({world - Eigen::Vector2d(cosine * local.x() - sine * local.y(),
                                                        sine * local.x() + cosine * local.y()),
                                cosine, sine});
    }
    for (const std::size_t point : group.equations.free_points)
      pose.points.push_back(sketched(point).value_or(Eigen::Vector2d::Zero()));
    return pose;
  }

  void choose(std::size_t g) {
    Group& group = structure_.groups[g];
    GroupSolver& solver = kinematics_.solver(g);
    if (group.form.placing == Placing::rotation) {
      solver.place(drives_, 0, here_);
      return;
    }
    if (const auto point = turning_point(group)) {
      add(MechanismError::Kind::constraint, group,
          fmt::format(
              "{} '{}' has all its joints with the rest in one place, at '{}': it turns about it while "
              "the drives stand still",
              noun(group), group.name, point_name(*point)),
          "a group with a definite place",
          "move one of these joints to another place, or leave out a superfluous link");
      return;
    }
    const GroupPose hint = sketched_pose(group);
    const GroupPoses poses = solver.poses(drives_, here_, &hint);
    if (poses.movable) {
      add(MechanismError::Kind::constraint, group,
          fmt::format(
              "the conditions of the group {} depend on each other: it moves while the drives stand still",
              group.name),
          "a group with a definite place",
          "is there one parallelogram too many? leave out the superfluous link, or change a length");
      return;
    }
    std::vector<Candidate> all = candidates(solver, drives_, poses, here_);
    if (all.empty()) {
      report_open(group, poses.complete);
      return;
    }
    std::size_t chosen = 0;
    if (all.size() > 1 || all.front().status == Status::dead_centre) {
      const std::size_t before = findings_.size();
      const auto nearest = nearest_to_sketch(group, all);
      if (!nearest && !take_first_) return;
      if (!nearest) {
        findings_.resize(before);
        undecided_.push_back(g);
      }
      chosen = nearest.value_or(0);
    }
    group.side = all[chosen].pose.side;
    group.start = all[chosen].pose;
    here_ = std::move(all[chosen].configuration);
  }

  /// The point about which a group turns while the rest stands; nothing of a dyad whose bars, of different
  /// lengths, do not close there.
  std::optional<std::size_t> turning_point(const Group& group) const {
    const auto& dyad = group.form.dyad;
    if (dyad && !(std::abs(dyad->r1 - dyad->r2) <= flat_within(dyad->r1 + dyad->r2))) return std::nullopt;
    return free_to_turn_about(group.equations, here_);
  }

  /// What the rank of the conditions says of the links placed so far, where it differs from Grübler's
  /// number.
  std::string shaky_text(const Configuration& here) const {
    const JacobianRank rank = jacobian_rank(mechanism_, poses_of(mechanism_, here));
    if (rank.mobility() == rank.gruebler()) return {};
    return fmt::format(", and it is shaky: by rank its mobility is {} there, by Grübler's formula {}",
                       rank.mobility(), rank.gruebler());
  }

  /// The candidate next to the sketch; nothing after a finding.
  std::optional<std::size_t> nearest_to_sketch(const Group& group, const std::vector<Candidate>& all) {
    std::vector<double> far(all.size());
    bool sketched = false;
    for (const SketchPoint& mark : mechanism_.sketch) {
      if (!std::binary_search(group.points.begin(), group.points.end(), mark.point)) continue;
      sketched = true;
      for (std::size_t i = 0; i < all.size(); ++i) {
        far[i] =
            std::hypot(far[i], (all[i].configuration.points[mark.point].position - mark.position).norm());
      }
    }
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return far[a] < far[b]; });
    const double same = kUndecidedWithin * mechanism_.largest_length();
    const bool decided = all.size() == 1 || (sketched && far[order[1]] - far[order[0]] > same);
    if (decided && all[order[0]].status == Status::dead_centre) {
      add(MechanismError::Kind::sketch, group,
          fmt::format("{} '{}' is at a dead centre at the start: {} assembly modes coincide{}", noun(group),
                      group.name, all.size() == 1 ? "its" : "two of its",
                      shaky_text(all[order[0]].configuration)),
          {}, "start the drive at another place and sketch that position");
      return std::nullopt;
    }
    if (decided) return order[0];
    std::string lines;
    for (const Candidate& candidate : all) lines += "\n    " + sketch_line(group, candidate, all);
    const std::string modes =
        fmt::format("{} assembly modes", all.size() == 2 ? "two" : std::to_string(all.size()));
    const char* const all_or_both = all.size() == 2 ? "both" : "two";
    add(MechanismError::Kind::sketch, group,
        sketched ? fmt::format("the sketch is equally far from {} assembly modes of {} '{}'", all_or_both,
                               noun(group), group.name)
                 : fmt::format("{} '{}' has {} and no point in [sketch]", noun(group), group.name, modes),
        "a rough position at the start of a point that the modes place differently",
        "put one of these lines into [sketch]" + lines);
    return std::nullopt;
  }

  static std::string noun(const Group& group) { return group.form.dyad ? "dyad" : "group"; }

  /// A line for [sketch]: of the point that the modes place most differently.
  std::string sketch_line(const Group& group, const Candidate& candidate,
                          const std::vector<Candidate>& all) const {
    std::size_t telling = group.points.front();
    if (const auto& dyad = group.form.dyad) {
      telling = dyad->c;
    } else {
      double widest = -1;
      for (const std::size_t point : group.points) {
        double nearest = std::numeric_limits<double>::infinity();
        for (std::size_t i = 0; i < all.size(); ++i) {
          for (std::size_t j = 0; j < i; ++j) {
            nearest = std::min(nearest, (all[i].configuration.points[point].position -
                                         all[j].configuration.points[point].position)
                                            .norm());
          }
        }
        if (nearest <= widest) continue;
        widest = nearest;
        telling = point;
      }
    }
    const Eigen::Vector2d& at = candidate.configuration.points[telling].position;
    std::string line = fmt::format("{} = [{:.6g}, {:.6g}]", point_name(telling), at.x(), at.y());
    if (const auto& dyad = group.form.dyad) {
      line += fmt::format("   # {} of {} → {}", candidate.pose.side > 0 ? "left" : "right",
                          point_name(dyad->p), point_name(dyad->q));
    }
    return line;
  }

  void report_open(const Group& group, bool complete) {
    const std::string& unit = mechanism_.length_unit;
    if (const auto& dyad = group.form.dyad) {
      const double distance = (here_.points[dyad->q].position - here_.points[dyad->p].position).norm();
      add(MechanismError::Kind::assembly, group,
          fmt::format("dyad '{}' cannot be assembled at the start: its pivots '{}' and '{}' are {:.6g} {} "
                      "apart, and '{}' "
                      "({} to {}: {:.6g} {}) and '{}' ({} to {}: {:.6g} {}) do not meet",
                      group.name, point_name(dyad->p), point_name(dyad->q), distance, unit,
                      mechanism_.bodies[dyad->body1].name, point_name(dyad->p), point_name(dyad->c), dyad->r1,
                      unit, mechanism_.bodies[dyad->body2].name, point_name(dyad->q), point_name(dyad->c),
                      dyad->r2, unit),
          fmt::format("a distance of the pivots from {:.6g} to {:.6g} {}", std::abs(dyad->r1 - dyad->r2),
                      dyad->r1 + dyad->r2, unit),
          "change a length, or the start of the drive");
      return;
    }
    std::vector<std::string> known;
    for (const Condition& c : group.equations.conditions) {
      for (const PointRef* point : {&c.a, &c.b}) {
        const bool used =
            c.kind != Condition::Kind::orientation &&
            (point == &c.a || c.kind == Condition::Kind::distance || c.kind == Condition::Kind::coincidence);
        if (!used || point->kind != PointRef::Kind::known) continue;
        const Eigen::Vector2d& at = here_.points[point->point].position;
        known.push_back(fmt::format("{} at [{:.6g}, {:.6g}]", point_name(point->point), at.x(), at.y()));
      }
    }
    add(MechanismError::Kind::assembly, group,
        fmt::format("group '{}' cannot be assembled at the start{}{}", group.name,
                    known.empty()
                        ? ""
                        : fmt::format(": its bodies do not reach each other with {}", fmt::join(known, ", ")),
                    complete ? "" : " (no pose was found by a search from many guesses)"),
        "bodies that close",
        complete ? "change a length, or the start of the drive"
                 : "sketch its points more closely, change a length, or the start of the drive");
  }

  void add(MechanismError::Kind kind, const Group& group, std::string what, std::string expected,
           std::string remedy) {
    if (findings_.empty() || kind == MechanismError::Kind::assembly) kind_ = kind;
    const text::Place& place = group.bodies.empty() ? mechanism_.slides[group.slides.front()].place
                                                    : mechanism_.bodies[group.bodies.front()].place;
    findings_.push_back({place, std::move(what), std::move(expected), std::move(remedy)});
  }

  const std::string& point_name(std::size_t point) const { return mechanism_.points[point].name; }

  const Mechanism& mechanism_;
  Structure& structure_;
  Kinematics kinematics_;
  std::vector<DriveState> drives_;
  Configuration here_;
  std::vector<text::Diagnostic> findings_;
  MechanismError::Kind kind_ = MechanismError::Kind::sketch;
  bool take_first_ = false;
  std::vector<std::size_t> undecided_;
};

}  // namespace

void choose_modes(const Mechanism& mechanism, Structure& structure) {
  ModeChooser(mechanism, structure).run();
}

std::vector<std::size_t> choose_some_modes(const Mechanism& mechanism, Structure& structure) {
  return ModeChooser(mechanism, structure).run_undecided();
}

std::vector<GroupModes> assembly_modes(const Mechanism& mechanism, const Structure& structure,
                                       std::span<const DriveState> drives, const Configuration& here) {
  Kinematics kinematics(mechanism, structure);
  // where the mechanism does not close the groups before the open one still have their places
  const bool partial = here.status == Status::open;
  Configuration work = partial ? frame_configuration(mechanism) : here;
  if (partial) kinematics.load_start(work);
  std::vector<GroupModes> all;
  for (std::size_t g = 0; g < structure.groups.size(); ++g) {
    const Group& group = structure.groups[g];
    GroupModes modes{g, true, {}};
    GroupSolver& solver = kinematics.solver(g);
    const GroupPoses poses = solver.poses(drives, work);
    modes.complete = poses.complete;
    if (partial && solver.place(drives, group.side, work) == Status::open) {
      const Configuration frame = frame_configuration(mechanism);
      for (const std::size_t point : group.points) work.points[point] = frame.points[point];
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::size_t selected = 0;
    for (Candidate& candidate : candidates(solver, drives, poses, work)) {
      AssemblyMode mode{candidate.pose, false, group.points, {}};
      double far = 0;
      for (const std::size_t point : group.points) {
        mode.positions.push_back(candidate.configuration.points[point].position);
        far += (mode.positions.back() - work.points[point].position).norm();
      }
      if (far < nearest) {
        nearest = far;
        selected = modes.modes.size();
      }
      modes.modes.push_back(std::move(mode));
    }
    if (std::isfinite(nearest)) modes.modes[selected].selected = true;
    all.push_back(std::move(modes));
  }
  return all;
}

}  // namespace oblique::mechanism
