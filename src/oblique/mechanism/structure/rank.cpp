// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/rank.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <oblique/mechanism/model/plane.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/structure/singular_values.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {
namespace {

using Eigen::Index;
using Eigen::Vector2d;

Vector2d turned(const BodyPose& pose, const Vector2d& v) {
  return {pose.cosine * v.x() - pose.sine * v.y(), pose.sine * v.x() + pose.cosine * v.y()};
}

class Rows {
 public:
  Rows(const Mechanism& mechanism, const std::vector<BodyPose>& poses)
      : mechanism_(mechanism), poses_(poses), size_(std::max(mechanism.largest_length(), 1e-300)) {}

  Eigen::MatrixXd write() {
    for (std::size_t p = 0; p < mechanism_.points.size(); ++p) {
      const std::vector<std::size_t> bodies = mechanism_.bodies_at(p);
      const std::size_t first = mechanism_.points[p].fixed ? 0 : 1;
      for (std::size_t i = first; i < bodies.size(); ++i) {
        for (const Vector2d& axis : {Vector2d(1, 0), Vector2d(0, 1)}) {
          begin();
          add(bodies[i], p, axis);
          if (first == 1) add(bodies.front(), p, -axis);
        }
      }
    }
    for (const Slide& slide : mechanism_.slides) add_slide(slide);
    Eigen::MatrixXd jacobian(static_cast<Index>(rows_.size()),
                             static_cast<Index>(3 * mechanism_.bodies.size()));
    for (std::size_t r = 0; r < rows_.size(); ++r) jacobian.row(static_cast<Index>(r)) = rows_[r];
    return jacobian;
  }

 private:
  void begin() {
    rows_.emplace_back(Eigen::RowVectorXd::Zero(static_cast<Index>(3 * mechanism_.bodies.size())));
  }

  /// Adds the derivative by the place of a link's material point.
  void add_arm(std::size_t body, const Vector2d& arm, const Vector2d& derivative) {
    const auto column = static_cast<Index>(3 * body);
    rows_.back()(column) += derivative.x();
    rows_.back()(column + 1) += derivative.y();
    rows_.back()(column + 2) += derivative.dot(left_normal(arm)) / size_;
  }

  Vector2d arm(std::size_t body, std::size_t point) const {
    return turned(poses_[body], mechanism_.bodies[body].find(point)->local);
  }

  void add(std::size_t body, std::size_t point, const Vector2d& derivative) {
    add_arm(body, arm(body, point), derivative);
  }

  void add_slide(const Slide& slide) {
    const LineRef line = line_of(mechanism_, slide);
    Vector2d u = line.direction, at = line.point;
    if (slide.carrier) {
      u = turned(poses_[*slide.carrier], u);
      at = poses_[*slide.carrier].position + turned(poses_[*slide.carrier], at);
    }
    const Vector2d n = left_normal(u);
    Vector2d position = mechanism_.points[slide.point].position;
    std::optional<std::size_t> owner = slide.of;
    if (!owner && !mechanism_.points[slide.point].fixed) owner = mechanism_.bodies_at(slide.point).front();
    if (owner) position = poses_[*owner].position + arm(*owner, slide.point);
    begin();
    if (owner) add(*owner, slide.point, n);
    // the carrier's material point under the sliding one
    if (slide.carrier) add_arm(*slide.carrier, position - poses_[*slide.carrier].position, -n);
    if (!slide.of) return;
    begin();
    rows_.back()(static_cast<Index>(3 * *slide.of + 2)) += 1;
    if (slide.carrier) rows_.back()(static_cast<Index>(3 * *slide.carrier + 2)) -= 1;
  }

  const Mechanism& mechanism_;
  const std::vector<BodyPose>& poses_;
  double size_;
  std::vector<Eigen::RowVectorXd> rows_;
};

}  // namespace

std::vector<BodyPose> poses_of(const Mechanism& mechanism, const Configuration& here) {
  std::vector<BodyPose> poses;
  for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
    const BodyPoint& base = mechanism.bodies[b].points.front();
    poses.push_back({here.points[base.point].position, here.bodies[b].cosine, here.bodies[b].sine});
  }
  return poses;
}

Eigen::MatrixXd pair_jacobian(const Mechanism& mechanism, const std::vector<BodyPose>& poses) {
  return Rows(mechanism, poses).write();
}

JacobianRank jacobian_rank(const Mechanism& mechanism, const std::vector<BodyPose>& poses) {
  const Eigen::MatrixXd all = pair_jacobian(mechanism, poses);
  Eigen::MatrixXd jacobian(all.rows(), all.cols());
  Index rows = 0;
  for (Index row = 0; row < all.rows(); ++row) {
    if (all.row(row).allFinite()) jacobian.row(rows++) = all.row(row);
  }
  jacobian.conservativeResize(rows, Eigen::NoChange);
  JacobianRank result;
  result.coordinates =
      3 * static_cast<std::size_t>(std::count_if(poses.begin(), poses.end(), [](const BodyPose& pose) {
        return pose.position.allFinite() && std::isfinite(pose.cosine);
      }));
  result.conditions = static_cast<std::size_t>(rows);
  if (rows == 0) return result;
  const Eigen::VectorXd values = singular_values(jacobian);
  for (Index i = 0; i < values.size(); ++i) {
    const double ratio = values(i) / values(0);
    if (ratio > kRankTolerance) {
      ++result.rank;
      result.least_kept = ratio;
    } else {
      result.largest_lost = std::max(result.largest_lost, ratio);
    }
  }
  return result;
}

MobilityReport mobility_report(const Mechanism& mechanism, const Structure& structure) {
  constexpr double kOn = 5 * std::numbers::pi / 180;
  MobilityReport report;
  report.gruebler = mobility(mechanism);
  Follower follower(mechanism, structure);
  report.start = jacobian_rank(mechanism, poses_of(mechanism, follower.advance(0)));
  report.verdict = MobilityReport::Verdict::agrees;
  if (report.start.mobility() == report.gruebler) return report;
  report.verdict = MobilityReport::Verdict::overconstrained;
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) {
    const double rate = std::abs(drive.speed);
    fastest = std::max(fastest, drive.slide ? rate / mechanism.largest_length() : rate);
  }
  if (fastest == 0) return report;
  for (const double way : {kOn, -kOn}) {
    Follower other(mechanism, structure);
    const Configuration& there = other.advance(way / fastest);
    if (there.status == Status::open) continue;
    report.beside = jacobian_rank(mechanism, poses_of(mechanism, there));
    if (report.beside->mobility() == report.gruebler) report.verdict = MobilityReport::Verdict::shaky;
    break;
  }
  return report;
}

}  // namespace oblique::mechanism
