// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/redundancy.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/constraint_graph.h>
#include <oblique/mechanism/structure/rank.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using Edge = ConstraintGraph::Edge;
using Eigen::Vector2d;

constexpr double kCloses = 1e-9;  ///< of the largest length

/// A pair of the mechanism that was loosened.
struct Cut {
  Edge edge;
  int conditions = 0;  ///< of the pair that are too much
  std::size_t loose =
      0;  ///< revolute joint: the link's own point, index in the points of the loosened mechanism
};

/// The mechanism with its redundant conditions taken away.
class Loosened {
 public:
  explicit Loosened(const Mechanism& mechanism) : original_(mechanism), loose_(mechanism) {
    const ConstraintGraph graph(mechanism);
    for (const std::size_t index : graph.redundant()) {
      const Edge& edge = graph.edges()[index];
      const auto same = std::find_if(cuts_.begin(), cuts_.end(), [&](const Cut& cut) {
        return is_revolute(edge) == is_revolute(cut.edge) && edge.index == cut.edge.index &&
               edge.point == cut.edge.point;
      });
      if (same != cuts_.end()) {
        ++same->conditions;
        continue;
      }
      cuts_.push_back({edge, 1, 0});
      std::vector<std::size_t> bodies;
      for (const std::size_t vertex : graph.competitors(index)) {
        if (graph.is_body(vertex)) bodies.push_back(vertex);
      }
      loops_.push_back(std::move(bodies));
    }
    possible_ = !cuts_.empty();
    for (Cut& cut : cuts_) possible_ = possible_ && loosen(cut);
  }

  bool is_possible() const { return possible_; }
  const Mechanism& mechanism() const { return loose_; }
  const std::vector<Cut>& cuts() const { return cuts_; }
  const std::vector<std::size_t>& loop(std::size_t cut) const { return loops_[cut]; }

  Excess excess(std::size_t c) const {
    const Cut& cut = cuts_[c];
    Excess excess;
    excess.bodies = loops_[c];
    excess.is_revolute = is_revolute(cut.edge);
    if (excess.is_revolute) {
      excess.pair = fmt::format("the revolute joint of '{}' at '{}'", original_.bodies[cut.edge.index].name,
                                original_.points[cut.edge.point].name);
      excess.place = original_.bodies[cut.edge.index].place;
    } else {
      const Slide& slide = original_.slides[cut.edge.index];
      excess.is_angle = cut.edge.kind == Edge::Kind::angle && cut.conditions == 1;
      excess.pair = fmt::format("{} '{}'", excess.is_angle ? "the angle of slide" : "slide", slide.name);
      excess.place = slide.place;
    }
    return excess;
  }

  double miss(const Cut& cut, const Configuration& here) const {
    if (is_revolute(cut.edge)) {
      return (here.points[cut.edge.point].position - here.points[cut.loose].position).norm();
    }
    const Slide& slide = original_.slides[cut.edge.index];
    const LineRef line = line_of(original_, slide);
    BodyPose carrier{Vector2d::Zero(), 1, 0};
    if (slide.carrier) carrier = poses_of(loose_, here)[*slide.carrier];
    const auto turned = [&](const Vector2d& v) {
      return Vector2d(carrier.cosine * v.x() - carrier.sine * v.y(),
                      carrier.sine * v.x() + carrier.cosine * v.y());
    };
    const Vector2d u = turned(line.direction);
    const Vector2d d = here.points[slide.point].position - carrier.position - turned(line.point);
    const double beside = std::abs(u.x() * d.y() - u.y() * d.x());
    if (!slide.of) return beside;
    const double angle = here.bodies[*slide.of].angle - std::atan2(u.y(), u.x()) - slide.angle;
    const double turn = std::abs(std::remainder(angle, 2 * std::numbers::pi));
    return cut.edge.kind == Edge::Kind::angle && cut.conditions == 1 ? turn : std::max(beside, turn);
  }

 private:
  static bool is_revolute(const Edge& edge) { return edge.kind == Edge::Kind::revolute; }

  bool loosen(Cut& cut) {
    if (cut.edge.kind == Edge::Kind::turn || cut.edge.kind == Edge::Kind::along) return false;
    if (is_revolute(cut.edge)) {
      loosen_revolute(cut);
      return true;
    }
    Slide& slide = loose_.slides[cut.edge.index];
    if (slide.of && cut.conditions == 1) {
      slide.of.reset();  // the angle: a pin in a slot is left
      cut.edge.kind = Edge::Kind::angle;
      return true;
    }
    // the whole prismatic joint goes, which would shift the numbers of others
    const bool others = std::any_of(cuts_.begin(), cuts_.end(), [&](const Cut& other) {
      return &other != &cut && !is_revolute(other.edge);
    });
    const bool driven = std::any_of(loose_.drives.begin(), loose_.drives.end(),
                                    [](const Drive& drive) { return drive.slide.has_value(); });
    if (others || driven) return false;
    loose_.slides.erase(loose_.slides.begin() + static_cast<std::ptrdiff_t>(cut.edge.index));
    return true;
  }

  void loosen_revolute(Cut& cut) {
    Body& body = loose_.bodies[cut.edge.index];
    Point own;
    own.name = fmt::format("{} of {}", original_.points[cut.edge.point].name, body.name);
    cut.loose = loose_.points.size();
    loose_.points.push_back(own);
    for (BodyPoint& p : body.points) {
      if (p.point == cut.edge.point) p.point = cut.loose;
    }
    for (Slide& slide : loose_.slides) {
      if (slide.carrier != cut.edge.index) continue;
      if (slide.first == cut.edge.point) slide.first = cut.loose;
      if (slide.second == cut.edge.point) slide.second = cut.loose;
    }
    if (cut.conditions == 2) return;
    Slide slot;
    slot.name = own.name;
    slot.point = cut.edge.point;
    slot.first = body.points.front().point == cut.loose ? body.points[1].point : body.points.front().point;
    slot.second = cut.loose;
    slot.carrier = cut.edge.index;
    slot.place = body.place;
    loose_.slides.push_back(slot);
  }

  const Mechanism& original_;
  Mechanism loose_;
  std::vector<Cut> cuts_;
  std::vector<std::vector<std::size_t>> loops_;
  bool possible_ = false;
};

/// Chooses modes as the sketch has them, and where a loosened revolute joint hangs on the choice, those in
/// which it gapes least. False where nothing decides.
bool choose(const Loosened& loosened, Structure& structure) {
  const Mechanism& mechanism = loosened.mechanism();
  Kinematics kinematics(mechanism, structure);
  std::vector<DriveState> drives(mechanism.drives.size());
  DriveClock(mechanism).at(0, drives);
  Configuration here = frame_configuration(mechanism);
  for (std::size_t g = 0; g < structure.groups.size(); ++g) {
    Group& group = structure.groups[g];
    GroupSolver& solver = kinematics.solver(g);
    if (group.form.placing == Placing::rotation) {
      solver.place(drives, 0, here);
      continue;
    }
    const GroupPoses poses = solver.poses(drives, here);
    if (poses.movable) return false;
    double best = std::numeric_limits<double>::infinity();
    bool decided = poses.poses.size() == 1;
    Configuration found;
    for (const GroupPose& pose : poses.poses) {
      Configuration there = here;
      if (solver.place(drives, pose, there) == Status::open) continue;
      double score = 0;
      for (const SketchPoint& mark : mechanism.sketch) {
        if (std::find(group.points.begin(), group.points.end(), mark.point) == group.points.end()) continue;
        score += (there.points[mark.point].position - mark.position).squaredNorm();
        decided = true;
      }
      for (const Cut& cut : loosened.cuts()) {
        if (cut.edge.kind != Edge::Kind::revolute) continue;
        const double gap = loosened.miss(cut, there);
        if (std::isnan(gap)) continue;
        score += gap * gap;
        decided = true;
      }
      if (score >= best) continue;
      best = score;
      found = std::move(there);
      group.side = pose.side;
      group.start = pose;
    }
    if (!decided || !std::isfinite(best)) return false;
    here = std::move(found);
  }
  return true;
}

double time_on(const Mechanism& mechanism) {
  constexpr double kOn = 5 * std::numbers::pi / 180;
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) {
    const double rate = std::abs(drive.speed);
    fastest = std::max(fastest, drive.slide ? rate / mechanism.largest_length() : rate);
  }
  return fastest > 0 ? kOn / fastest : 0;
}

std::string quantity(const Mechanism& mechanism, const Excess& excess, double miss) {
  if (excess.is_angle) return fmt::format("{:.3g}°", miss * 180 / std::numbers::pi);
  return fmt::format("{:.3g} {}", miss, mechanism.length_unit);
}

}  // namespace

std::optional<Redundancy> examine_redundancy(const Mechanism& mechanism) {
  const Loosened loosened(mechanism);
  if (!loosened.is_possible()) return std::nullopt;
  Structure structure;
  try {
    structure = find_groups(loosened.mechanism());
  } catch (const MechanismError&) {
    return std::nullopt;
  }
  if (!choose(loosened, structure)) return std::nullopt;
  Follower follower(loosened.mechanism(), structure);
  const Configuration start = follower.advance(0);
  const Configuration beside = follower.advance(time_on(mechanism));
  if (start.status == Status::open) return std::nullopt;
  Redundancy result;
  result.closes_at_start = result.closes_beside = true;
  for (std::size_t c = 0; c < loosened.cuts().size(); ++c) {
    Excess excess = loosened.excess(c);
    excess.miss_at_start = loosened.miss(loosened.cuts()[c], start);
    excess.miss_beside = loosened.miss(loosened.cuts()[c], beside);
    const double limit = excess.is_angle ? kCloses : kCloses * mechanism.largest_length();
    result.closes_at_start = result.closes_at_start && excess.miss_at_start <= limit;
    result.closes_beside = result.closes_beside && excess.miss_beside <= limit;
    result.excesses.push_back(std::move(excess));
  }
  if (result.closes_at_start) {
    result.mobility = jacobian_rank(mechanism, poses_of(loosened.mechanism(), start)).mobility();
  }
  return result;
}

std::vector<text::Diagnostic> redundancy_findings(const Mechanism& mechanism) {
  std::vector<text::Diagnostic> findings;
  const auto redundancy = examine_redundancy(mechanism);
  if (!redundancy) return findings;
  for (const Excess& excess : redundancy->excesses) {
    std::vector<std::string> names;
    for (const std::size_t body : excess.bodies) names.push_back(mechanism.bodies[body].name);
    const std::string loop = fmt::format("{} in the loop {}", excess.pair, fmt::join(names, "-"));
    text::Diagnostic finding;
    finding.place = excess.place;
    if (!redundancy->closes_at_start) {
      finding.what = fmt::format("{} is contradictory: without it the others leave {} there", loop,
                                 quantity(mechanism, excess, excess.miss_at_start));
      finding.expected = "lengths with which it closes";
      finding.remedy = "leave it out, or correct a length";
    } else if (!redundancy->closes_beside) {
      finding.what = fmt::format(
          "{} closes at the start only: 5° of the drive further on, the others leave {} there, so it locks "
          "the "
          "mechanism",
          loop, quantity(mechanism, excess, excess.miss_beside));
      finding.remedy = "leave it out, or correct a length";
    } else {
      finding.what =
          fmt::format("{} is redundant: it closes all the same, and by rank the mechanism has mobility {}",
                      loop, *redundancy->mobility);
      finding.remedy = excess.is_revolute ? "the others move alike without that body: leave it out"
                                          : "the mechanism moves alike without it: leave it out";
    }
    findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace oblique::mechanism
