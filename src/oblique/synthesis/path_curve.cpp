// SPDX-License-Identifier: MIT
#include <oblique/synthesis/path_curve.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace oblique::synthesis {
namespace {

using Eigen::Vector2d;

/// A difference counts as normal to the path where its angle to the normal is below this, or where its part
/// along the path is below kOffsetWithin of the piece's length.
constexpr double kNormalWithin = 1e-6;
constexpr double kOffsetWithin = 1e-9;

}  // namespace

PathCurve::PathCurve(const mechanism::Motion& motion, std::size_t point) {
  for (std::size_t row = 1; row < motion.times.size(); ++row) {
    const mechanism::Configuration& before = motion.configurations[row - 1];
    const mechanism::Configuration& after = motion.configurations[row];
    if (before.status != mechanism::Status::ok || after.status != mechanism::Status::ok) continue;
    const mechanism::PointState& a = before.points[point];
    const mechanism::PointState& b = after.points[point];
    Piece piece;
    piece.begin = motion.times[row - 1];
    piece.duration = motion.times[row] - piece.begin;
    const double h = piece.duration;
    auto c = [&](Eigen::Index power) { return piece.coefficients.col(power); };
    c(0) = a.position;
    c(1) = h * a.velocity;
    c(2) = h * h / 2 * a.acceleration;
    const Vector2d p = b.position - c(0) - c(1) - c(2);
    const Vector2d v = h * b.velocity - c(1) - 2 * c(2);
    const Vector2d w = h * h * b.acceleration - 2 * c(2);
    c(3) = 10 * p - 4 * v + w / 2;
    c(4) = -15 * p + 7 * v - w;
    c(5) = 6 * p - 3 * v + w / 2;
    pieces_.push_back(piece);
  }
}

Vector2d PathCurve::Piece::position(double s) const {
  Vector2d sum = coefficients.col(5);
  for (Eigen::Index power = 4; power >= 0; --power) sum = s * sum + coefficients.col(power);
  return sum;
}

Vector2d PathCurve::Piece::tangent(double s) const {
  Vector2d sum = 5 * coefficients.col(5);
  for (Eigen::Index power = 4; power >= 1; --power) {
    sum = s * sum + static_cast<double>(power) * coefficients.col(power);
  }
  return sum;
}

/// A root of (p(s) − target)·p′(s) by bisection, or the end from which the distance only grows.
double PathCurve::Piece::nearest(const Vector2d& target) const {
  constexpr int kHalvings = 52;  // to the last bit of s
  const auto derivative = [&](double s) { return (position(s) - target).dot(tangent(s)); };
  // At rest at an end, as in a cusp, the tangent there is rounding: what is beside the end tells.
  constexpr double kBeside = 1e-6;
  if (derivative(0) >= 0 && derivative(kBeside) >= 0) return 0;
  if (derivative(1) <= 0 && derivative(1 - kBeside) <= 0) return 1;
  double nearing = 0, leaving = 1;
  for (int k = 0; k < kHalvings; ++k) {
    const double middle = (nearing + leaving) / 2;
    (derivative(middle) < 0 ? nearing : leaving) = middle;
  }
  return (nearing + leaving) / 2;
}

std::optional<PathCurve::Foot> PathCurve::nearest(const Vector2d& target) const {
  // The path of a piece stays within twice its tangents at the ends, so most pieces are too far to matter.
  double least = std::numeric_limits<double>::infinity();
  const Piece* best = nullptr;
  double best_s = 0;
  const auto consider = [&](const Piece& piece, double s) {
    const double distance = (piece.position(s) - target).norm();
    if (distance >= least) return;
    least = distance;
    best = &piece;
    best_s = s;
  };
  for (const Piece& piece : pieces_) consider(piece, 0);
  if (best == nullptr) return std::nullopt;
  for (const Piece& piece : pieces_) {
    const double length = 2 * std::max(piece.tangent(0).norm(), piece.tangent(1).norm());
    if ((piece.coefficients.col(0) - target).norm() - length < least) consider(piece, piece.nearest(target));
  }
  Foot foot{best->begin + best_s * best->duration, best->position(best_s) - target,
            Eigen::Matrix2d::Identity()};
  const Vector2d tangent = best->tangent(best_s);
  const double speed = tangent.norm();
  // At a cusp the tangent is rounding beside the piece's curvature and has no direction.
  const double rounding =
      std::sqrt(std::numeric_limits<double>::epsilon()) * best->coefficients.col(2).norm();
  const double along = speed > rounding ? std::abs(tangent.dot(foot.difference)) / speed : least;
  if (speed > rounding && along <= kNormalWithin * least + kOffsetWithin * speed) {
    const Vector2d normal = Vector2d(-tangent.y(), tangent.x()) / speed;
    foot.projector = normal * normal.transpose();
  }
  return foot;
}

std::optional<Vector2d> PathCurve::at(double time) const {
  auto after = std::upper_bound(pieces_.begin(), pieces_.end(), time,
                                [](double t, const Piece& piece) { return t < piece.begin; });
  if (after == pieces_.begin()) return std::nullopt;
  const Piece& piece = *--after;
  const double s = (time - piece.begin) / piece.duration;
  if (s > 1 + 1e-9) return std::nullopt;
  return piece.position(s);
}

}  // namespace oblique::synthesis
