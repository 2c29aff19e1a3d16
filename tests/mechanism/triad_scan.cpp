// SPDX-License-Identifier: MIT
#include "triad_scan.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

namespace oblique::mechanism {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

Vector2d quarter_turn(const Vector2d& v) {
  return {-v.y(), v.x()};
}

Matrix2d rotation(const PlatformPose& pose) {
  return (Matrix2d() << pose.cosine, -pose.sine, pose.sine, pose.cosine).finished();
}

/// A motion of the platform, closed: a pose for each τ in [0, 2π).
using PlatformMotion = std::function<PlatformPose(double tau)>;

/// The motions that a circle and a second leg leave. The circle's point P lies at along·d ± height·d⊥ from
/// its anchor, with d and `along` given by the second leg. That needs h = h₀ + h₁cos(θ − θ₀) in [low, high].
/// Where θ turns round at the end of such an interval the two signs meet, so θ = middle − half·cos τ with the
/// sign of sin τ walks through both smoothly.
class TwoLegs {
 public:
  TwoLegs(const Leg& circle, const Leg& other) : circle_(circle), other_(other) {
    const Vector2d a = other.anchor - circle.anchor;
    const Vector2d b = circle.local - other.local;
    const double l = circle.length;
    Vector2d wave;                          // h = h₀ + wave·(cos θ, sin θ)
    if (other.kind == Leg::Kind::circle) {  // h = the squared distance of the two centres
      h0_ = a.squaredNorm() + b.squaredNorm();
      wave = 2 * Vector2d(a.dot(b), a.dot(quarter_turn(b)));
      low_ = (l - other.length) * (l - other.length);
      high_ = (l + other.length) * (l + other.length);
    } else {  // h = the distance of the line from the circle's anchor
      const Vector2d n = quarter_turn(other.direction);
      const bool fixed = other.kind == Leg::Kind::fixed_line;
      h0_ = n.dot(fixed ? a : b);
      wave = fixed ? Vector2d(n.dot(b), n.dot(quarter_turn(b))) : Vector2d(a.dot(n), a.dot(quarter_turn(n)));
      low_ = -l;
      high_ = l;
    }
    h1_ = wave.norm();
    start_ = std::atan2(wave.y(), wave.x());
  }

  std::vector<PlatformMotion> motions() const {
    std::vector<PlatformMotion> result;
    const auto whole_turn = [&](double sign) {
      result.emplace_back([*this, sign](double tau) { return pose(tau, sign); });
    };
    const auto swing = [&](double from, double to) {
      result.emplace_back([*this, from, to](double tau) {
        return pose(start_ + (from + to) / 2 - (to - from) / 2 * std::cos(tau), std::sin(tau) < 0 ? -1 : 1);
      });
    };
    if (h0_ + h1_ < low_ || h0_ - h1_ > high_) return result;
    const bool top = h0_ + h1_ <= high_;
    const bool bottom = h0_ - h1_ >= low_;
    if (top && bottom) {
      whole_turn(1);
      whole_turn(-1);
      return result;
    }
    const double from = top ? 0 : std::acos((high_ - h0_) / h1_);
    const double to = bottom ? std::numbers::pi : std::acos((low_ - h0_) / h1_);
    if (top) {
      swing(-to, to);
    } else if (bottom) {
      swing(from, 2 * std::numbers::pi - from);
    } else {
      swing(from, to);
      swing(-to, -from);
    }
    return result;
  }

 private:
  PlatformPose pose(double theta, double sign) const {
    PlatformPose pose{Vector2d::Zero(), std::cos(theta), std::sin(theta)};
    const Matrix2d turn = rotation(pose);
    const double l = circle_.length;
    Vector2d d;
    double along = 0;
    if (other_.kind == Leg::Kind::circle) {
      const Vector2d centre = other_.anchor - circle_.anchor + turn * (circle_.local - other_.local);
      const double distance = centre.norm();
      d = centre / distance;
      along = (l * l - other_.length * other_.length + distance * distance) / (2 * distance);
    } else {
      const Vector2d n = quarter_turn(other_.direction);
      d = other_.kind == Leg::Kind::fixed_line ? n : turn * n;
      along = d.dot(other_.anchor - circle_.anchor + turn * (circle_.local - other_.local));
    }
    const double height = std::sqrt(std::max(0.0, (l - along) * (l + along)));
    pose.position = circle_.anchor + along * d + sign * height * quarter_turn(d) - turn * circle_.local;
    return pose;
  }

  Leg circle_, other_;
  double h0_ = 0, h1_ = 0, start_ = 0, low_ = 0, high_ = 0;
};

/// The zeros of a function of period 2π, also two close ones that lie between two places looked at.
std::vector<double> periodic_zeros(const std::function<double(double)>& g, int steps) {
  std::vector<double> zeros;
  const auto bisect = [&](double from, double to) {
    const bool negative = g(from) < 0;
    for (int i = 0; i < 52; ++i) {
      const double middle = (from + to) / 2;
      ((g(middle) < 0) == negative ? from : to) = middle;
    }
    zeros.push_back((from + to) / 2);
  };
  std::vector<double> values;
  const double step = 2 * std::numbers::pi / steps;
  const double offset = 0.1234;  // so that no place of a symmetric group is hit
  for (int i = 0; i < steps; ++i) values.push_back(g(offset + i * step));
  for (int i = 0; i < steps; ++i) {
    const double before = values[static_cast<std::size_t>(i)];
    const double here = values[static_cast<std::size_t>((i + 1) % steps)];
    const double after = values[static_cast<std::size_t>((i + 2) % steps)];
    double from = offset + i * step;
    if ((before < 0) != (here < 0)) {
      bisect(from, from + step);
      continue;
    }
    if ((after < 0) != (here < 0) || std::abs(here) > std::abs(before) || std::abs(here) > std::abs(after))
      continue;
    double to = from + 2 * step;
    const double golden = (std::sqrt(5) - 1) / 2;
    for (int k = 0; k < 60; ++k) {
      const double first = to - golden * (to - from);
      const double second = from + golden * (to - from);
      const double at_first = g(first);
      const double at_second = g(second);
      const double crossing = (at_first < 0) != (here < 0) ? first : second;
      if ((g(crossing) < 0) != (here < 0)) {
        bisect(offset + i * step, crossing);
        bisect(crossing, offset + (i + 2) * step);
        break;
      }
      (std::abs(at_first) < std::abs(at_second) ? to : from) =
          std::abs(at_first) < std::abs(at_second) ? second : first;
    }
  }
  return zeros;
}

/// Lines only: the three of them cross in one point where the determinant of [normal, distance] vanishes.
std::vector<PlatformPose> scan_lines(const std::array<Leg, 3>& legs, int steps) {
  const auto rows = [&](double theta) {
    const PlatformPose pose{Vector2d::Zero(), std::cos(theta), std::sin(theta)};
    const Matrix2d turn = rotation(pose);
    Eigen::Matrix3d m;
    for (int i = 0; i < 3; ++i) {
      const Leg& leg = legs[static_cast<std::size_t>(i)];
      const Vector2d n = quarter_turn(leg.direction);
      const Vector2d normal = leg.kind == Leg::Kind::fixed_line ? n : turn * n;
      m.row(i) << normal.x(), normal.y(), normal.dot(leg.anchor - turn * leg.local);
    }
    return m;
  };
  std::vector<PlatformPose> poses;
  for (const double theta : periodic_zeros([&](double t) { return rows(t).determinant(); }, steps)) {
    const Eigen::Matrix3d m = rows(theta);
    const Vector2d position = m.leftCols<2>().colPivHouseholderQr().solve(m.col(2));
    poses.push_back({position, std::cos(theta), std::sin(theta)});
  }
  return poses;
}

}  // namespace

double closing_error(const Leg& leg, const PlatformPose& pose) {
  const Matrix2d turn = rotation(pose);
  const Vector2d offset = pose.position + turn * leg.local - leg.anchor;
  switch (leg.kind) {
    case Leg::Kind::circle:
      return offset.norm() - leg.length;
    case Leg::Kind::fixed_line:
      return quarter_turn(leg.direction).dot(offset);
    case Leg::Kind::platform_line:
      return quarter_turn(turn * leg.direction).dot(offset);
  }
  return INFINITY;
}

double closing_error(const std::array<Leg, 3>& legs, const PlatformPose& pose) {
  double largest = 0;
  for (const Leg& leg : legs) largest = std::max(largest, std::abs(closing_error(leg, pose)));
  return largest;
}

std::vector<PlatformPose> scan_poses(const std::array<Leg, 3>& legs, int steps) {
  std::array<Leg, 3> order = legs;
  std::sort(order.begin(), order.end(), [](const Leg& a, const Leg& b) { return a.kind < b.kind; });
  if (order[0].kind != Leg::Kind::circle) return scan_lines(legs, steps);
  std::vector<PlatformPose> poses;
  for (const PlatformMotion& motion : TwoLegs(order[0], order[1]).motions()) {
    const auto error = [&](double tau) { return closing_error(order[2], motion(tau)); };
    for (const double tau : periodic_zeros(error, steps)) poses.push_back(motion(tau));
  }
  return poses;
}

}  // namespace oblique::mechanism
