// SPDX-License-Identifier: MIT
#include <oblique/mechanism/obstacle.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/triangle.h>

namespace oblique {
namespace {

constexpr double kSampleStep = std::numbers::pi / 360;
/// How much faster than at its ends |PQ| may change within a stretch of time.
constexpr double kRateMargin = 4;
/// A triangle touches flatness like a parabola: its slack is rounding, 1e-14 of its size, over a stretch of
/// 1e-7 of a turn, which 20 halvings of the first stretch reach; the rest is for sharper ones.
constexpr int kMostHalvings = 30;

/// How near a dyad is to its limits, and how fast that may change.
struct Reach {
  double slack = 0;  ///< min(r₁+r₂−|PQ|, |PQ|−|r₁−r₂|) [length unit]
  double rate = 0;   ///< |d|PQ|/dt| [length unit/s]
};

/// All dyads at one moment; `obstacle` where one of them is not `ok`.
struct Moment {
  double time = 0;
  std::vector<Reach> reaches;
  std::optional<Obstacle> obstacle;
};

class Survey {
 public:
  Survey(const Mechanism& mechanism, const Structure& structure)
      : mechanism_(mechanism), structure_(structure) {}

  Moment at(double time) const {
    Moment moment{time, {}, {}};
    const Configuration here = solve_configuration(mechanism_, structure_, drive_angles(mechanism_, time));
    if (here.status != Status::ok) {
      moment.obstacle = Obstacle{time, here.group.value(), here.status};
      return moment;
    }
    for (const Group& group : structure_.groups) {
      const auto* const dyad = std::get_if<DyadGroup>(&group);
      if (dyad == nullptr) continue;
      const PointState& p = here.points[dyad->p];
      const PointState& q = here.points[dyad->q];
      const Eigen::Vector2d d = q.position - p.position;
      const double base = std::hypot(d.x(), d.y());
      moment.reaches.push_back(
          {triangle(base, dyad->r1, dyad->r2).slack, std::abs((d / base).dot(q.velocity - p.velocity))});
    }
    return moment;
  }

  /// The first obstacle between two moments that are none.
  std::optional<Obstacle> between(const Moment& begin, const Moment& end, int halvings) const {
    if (halvings == 0 || !may_meet_one(begin, end)) return std::nullopt;
    const Moment middle = at(begin.time + (end.time - begin.time) / 2);
    if (middle.obstacle) return middle.obstacle;
    if (const auto found = between(begin, middle, halvings - 1)) return found;
    return between(middle, end, halvings - 1);
  }

 private:
  static bool may_meet_one(const Moment& begin, const Moment& end) {
    for (std::size_t i = 0; i < begin.reaches.size(); ++i) {
      const Reach& a = begin.reaches[i];
      const Reach& b = end.reaches[i];
      const double travel = kRateMargin * std::max(a.rate, b.rate) * (end.time - begin.time);
      if (std::min(a.slack, b.slack) < travel) return true;
    }
    return false;
  }

  const Mechanism& mechanism_;
  const Structure& structure_;
};

}  // namespace

std::optional<Obstacle> find_obstacle(const Mechanism& mechanism, const Structure& structure) {
  const double turn = period(mechanism);
  check_travel(mechanism, turn);
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) fastest = std::max(fastest, std::abs(drive.speed));
  const auto steps = static_cast<long>(std::ceil(fastest * turn / kSampleStep));
  const Survey survey(mechanism, structure);
  Moment last = survey.at(0);
  for (long k = 1; !last.obstacle; ++k) {
    const Moment next = survey.at(turn * static_cast<double>(k) / static_cast<double>(steps));
    if (!next.obstacle) {
      if (const auto found = survey.between(last, next, kMostHalvings)) return found;
      if (k == steps) return std::nullopt;
    }
    last = next;
  }
  return last.obstacle;
}

}  // namespace oblique
