// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <optional>
#include <tuple>

#include <Eigen/Dense>

#include <oblique/mechanism/trigonometric_zeros.h>

namespace oblique {
namespace {

using Complex = std::complex<double>;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Complex kI(0, 1);
constexpr double kClosure = 1e-13;  // of the group's size
constexpr double kFar = 1e6;        // in sizes of the group: lines that meet there are parallel

Complex complex(const Vector2d& v) {
  return {v.x(), v.y()};
}

double dot(Complex a, Complex b) {
  return a.real() * b.real() + a.imag() * b.imag();
}

double cross(Complex a, Complex b) {
  return a.real() * b.imag() - a.imag() * b.real();
}

/// A lead seen from the reference point, lengths divided by the group's size.
struct Condition {
  Lead::Kind kind = Lead::Kind::circle;
  Complex local, anchor;
  Complex normal;  ///< of a line, in its own frame
  double length = 0;
};

/// A pose of the platform: q the place of the reference point, z = e^{iθ}.
struct Pose {
  Complex q, z;
  bool singular = false;  ///< it closes and Newton knows no better: a dead centre
};

/// u(z)·q = w(z) with u = u₀ + u₁z and w = w₀ + Re(w₁z).
struct Line {
  Complex u0, u1;
  double w0 = 0;
  Complex w1;

  Complex u(Complex z) const { return u0 + u1 * z; }
  double w(Complex z) const { return w0 + dot(std::conj(w1), z); }
};

/// Real trigonometric polynomial of degree 1: c₀ + Re(c₁z).
struct Wave {
  double constant = 0;
  Complex first;
};

TrigonometricCubic product(const Wave& a, const Wave& b) {
  return {a.constant * b.constant + dot(a.first, b.first) / 2,
          {a.constant * b.first + b.constant * a.first, a.first * b.first / 2.0, 0}};
}

TrigonometricCubic sum(const TrigonometricCubic& a, const TrigonometricCubic& b, double factor) {
  TrigonometricCubic result{a.constant + factor * b.constant, {}};
  for (std::size_t i = 0; i < 3; ++i) result.harmonics[i] = a.harmonics[i] + factor * b.harmonics[i];
  return result;
}

Wave right_hand_side(const Line& line) {
  return {line.w0, line.w1};
}

/// u_a × u_b
Wave determinant(const Line& a, const Line& b) {
  return {cross(a.u0, b.u0) + cross(a.u1, b.u1), -kI * (std::conj(a.u0) * b.u1 - a.u1 * std::conj(b.u0))};
}

/// u_a · u_b
Wave scalar_product(const Line& a, const Line& b) {
  return {dot(a.u0, b.u0) + dot(a.u1, b.u1), std::conj(a.u0) * b.u1 + a.u1 * std::conj(b.u0)};
}

bool vanishes(const Wave& wave, double rounding) {
  return std::abs(wave.constant) + std::abs(wave.first) <= 16 * rounding;
}

/// |w_a u_b − w_b u_a|² − l²(u_a × u_b)². `scale` becomes the size of the two squares.
TrigonometricCubic on_circle(const Line& a, const Line& b, double length, double& scale) {
  // m₋₁z⁻¹ + m₀ + m₁z + m₂z²
  const std::array<Complex, 4> m = {
      (std::conj(a.w1) * b.u0 - std::conj(b.w1) * a.u0) / 2.0,
      a.w0 * b.u0 - b.w0 * a.u0 + (std::conj(a.w1) * b.u1 - std::conj(b.w1) * a.u1) / 2.0,
      a.w0 * b.u1 - b.w0 * a.u1 + (a.w1 * b.u0 - b.w1 * a.u0) / 2.0, (a.w1 * b.u1 - b.w1 * a.u1) / 2.0};
  TrigonometricCubic square;
  for (const Complex& coefficient : m) square.constant += std::norm(coefficient);
  for (std::size_t shift = 1; shift < 4; ++shift) {
    for (std::size_t i = 0; i + shift < 4; ++i)
      square.harmonics[shift - 1] += 2.0 * m[i + shift] * std::conj(m[i]);
  }
  const Wave d = determinant(a, b);
  const TrigonometricCubic d2 = product(d, d);
  // of the lines as they stand, before anything cancels
  const double terms = (std::abs(a.w0) + std::abs(a.w1)) * (std::abs(b.u0) + std::abs(b.u1)) +
                       (std::abs(b.w0) + std::abs(b.w1)) * (std::abs(a.u0) + std::abs(a.u1));
  scale = terms * terms + length * length;
  return sum(square, d2, -length * length);
}

/// The three conditions for a group of size 1 with a reference point, and the way back to the platform's
/// frame.
class Triad {
 public:
  explicit Triad(const std::array<Lead, 3>& leads);

  PlatformModes modes();

 private:
  void add_line(const Condition& condition);
  TrigonometricCubic characteristic(double& scale) const;
  void visit(Complex z);
  void visit_crossing(const Line& line, Complex z);
  void visit_parallel(Complex z);
  void consider(const Pose& guess);
  std::optional<Pose> closed(const Pose& guess) const;
  double rounding(const Pose& pose) const;
  bool are_one(const Pose& a, const Pose& b) const;
  void differentiate(const Pose& pose, Vector3d& residual, Matrix3d& jacobian) const;
  bool lies_on_curve(const Pose& pose) const;
  void keep(const Pose& pose);
  PlatformPose placed(const Pose& pose) const;

  std::array<Condition, 3> conditions_;
  std::array<Line, 3> lines_;  ///< the first two where there is a reference circle
  std::size_t n_lines_ = 0;
  bool circular_ = false;       ///< the last condition is the reference circle
  double radius_ = 0;           ///< of the reference circle
  double shortest_ = 1;         ///< of the circles' lengths, and 1
  double rounding_ = 0;         ///< of the given coordinates, relative to the group's size
  double smallest_factor_ = 1;  ///< by which a line was divided to bring it to size 1
  double size_ = 1;
  Vector2d origin_;  ///< the reference point's place q = 0
  Vector2d local_;   ///< the reference point in the platform's frame
  std::array<Pose, 8> found_;
  std::size_t n_found_ = 0;
  bool movable_ = false;
};

Triad::Triad(const std::array<Lead, 3>& leads) {
  // the longest circle for reference: a short one would leave F a difference of nearly equal squares
  std::size_t reference = 2;
  for (std::size_t i = 0; i < 3; ++i) {
    if (leads[i].kind != Lead::Kind::circle) continue;
    if (!circular_ || leads[i].length > leads[reference].length) reference = i;
    circular_ = true;
  }
  origin_ = leads[reference].anchor;
  local_ = leads[reference].local;

  double size = 0;
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Lead& lead = leads[(reference + 1 + i) % 3];  // the reference comes last
    Condition& condition = conditions_[i];
    condition = {lead.kind, complex(lead.local - local_), complex(lead.anchor - origin_),
                 kI * complex(lead.direction), 0};
    if (lead.kind == Lead::Kind::circle) {
      condition.length = lead.length;
    } else {  // of a line only its distance counts
      Complex& on_line = lead.kind == Lead::Kind::fixed_line ? condition.anchor : condition.local;
      on_line = condition.normal * dot(condition.normal, on_line);
    }
    size = std::max({size, std::abs(condition.local), std::abs(condition.anchor), condition.length});
    largest = std::max({largest, lead.local.cwiseAbs().maxCoeff(), lead.anchor.cwiseAbs().maxCoeff()});
  }
  size_ = size > 0 ? size : 1;
  rounding_ = std::numeric_limits<double>::epsilon() * (1 + largest / size_);
  for (Condition& condition : conditions_) {
    condition.local /= size_;
    condition.anchor /= size_;
    condition.length /= size_;
    if (condition.kind == Lead::Kind::circle) shortest_ = std::min(shortest_, condition.length);
  }
  radius_ = conditions_[2].length;
  for (std::size_t i = 0; i < (circular_ ? 2 : 3); ++i) add_line(conditions_[i]);
}

void Triad::add_line(const Condition& condition) {
  const auto& [kind, b, a, n, length] = condition;
  Line& line = lines_[n_lines_++];
  if (kind == Lead::Kind::fixed_line) {
    line = {n, 0, dot(n, a), -std::conj(n) * b};
  } else if (kind == Lead::Kind::platform_line) {
    line = {0, n, -dot(n, b), std::conj(a) * n};
  } else {
    const double squares = std::norm(a) + std::norm(b) + (radius_ - length) * (radius_ + length);
    const double size = std::abs(a) + std::abs(b);
    const double factor = size > rounding_ ? size : 1;  // two circles that are one: 0·q = w
    smallest_factor_ = std::min(smallest_factor_, factor);
    line = {-a / factor, b / factor, -squares / (2 * factor), std::conj(a) * b / factor};
  }
}

/// F, or where the lines are parallel in every direction what its square root is: w_a(u_a·u_b) − w_b|u_a|².
TrigonometricCubic Triad::characteristic(double& scale) const {
  const double rounding = rounding_ / smallest_factor_;
  const Wave d = determinant(lines_[0], lines_[1]);
  const bool parallel = vanishes(d, rounding);
  if (circular_ && !parallel) return on_circle(lines_[0], lines_[1], radius_, scale);
  if (!circular_) {
    const Wave d12 = determinant(lines_[1], lines_[2]);
    const Wave d20 = determinant(lines_[2], lines_[0]);
    if (!parallel || !vanishes(d12, rounding) || !vanishes(d20, rounding)) {
      scale = 0;
      for (const Line& line : lines_) scale += std::abs(line.w0) + std::abs(line.w1);
      return sum(sum(product(right_hand_side(lines_[0]), d12), product(right_hand_side(lines_[1]), d20), 1),
                 product(right_hand_side(lines_[2]), d), 1);
    }
  }
  const Line& a = lines_[0];
  const Line& b = lines_[1];
  scale = std::abs(a.w0) + std::abs(a.w1) + std::abs(b.w0) + std::abs(b.w1);
  return sum(product(right_hand_side(a), scalar_product(a, b)),
             product(right_hand_side(b), scalar_product(a, a)), -1);
}

/// The residuals of the conditions, and their derivatives by q_x, q_y and θ.
void Triad::differentiate(const Pose& pose, Vector3d& residual, Matrix3d& jacobian) const {
  for (int i = 0; i < 3; ++i) {
    const auto& [kind, local, anchor, normal, length] = conditions_[static_cast<std::size_t>(i)];
    const Complex arm = pose.z * local;
    Complex gradient;
    double by_angle = 0;
    if (kind == Lead::Kind::platform_line) {
      const Complex across = pose.z * normal;
      const Complex offset = anchor - pose.q;
      residual[i] = dot(across, offset) - dot(normal, local);
      gradient = -across;
      by_angle = dot(kI * across, offset);
    } else {
      const Complex offset = pose.q + arm - anchor;
      if (kind == Lead::Kind::circle) {  // (|p|² − l²)/2l is |p| − l as it goes to zero
        const double inverse = length > 0 ? 1 / length : 1;
        residual[i] = (std::norm(offset) - length * length) * inverse / 2;
        gradient = offset * inverse;
      } else {
        residual[i] = dot(normal, offset);
        gradient = normal;
      }
      by_angle = dot(gradient, kI * arm);
    }
    jacobian.row(i) << gradient.real(), gradient.imag(), by_angle;
  }
}

/// Turned by about δ, and on the unit circle.
Complex turned(Complex z, double delta) {
  const Complex turned = z * Complex(1, delta);
  return turned / std::abs(turned);
}

void move(Pose& pose, const Vector3d& by) {
  pose.q += Complex(by[0], by[1]);
  pose.z = turned(pose.z, by[2]);
}

/// The step of least length that mends what can be mended: the part along a direction in which the platform
/// is free to first order, to `threshold`, is left out.
Vector3d shortest_step(const Matrix3d& jacobian, const Vector3d& residual, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<Matrix3d> solver;
  solver.setThreshold(threshold);
  return -solver.compute(jacobian).solve(residual);
}

/// The pose that Newton finds from `guess`, where it closes.
std::optional<Pose> Triad::closed(const Pose& guess) const {
  constexpr double kNear = 10 * kClosure;
  constexpr double kLost = 1e-4;  // a longer step from a pose that nearly closes is rounding over nothing
  Pose pose = guess;
  Pose best = guess;
  double least = std::numeric_limits<double>::infinity();
  Vector3d residual;
  Matrix3d jacobian;
  for (int step = 0; step < 30; ++step) {
    differentiate(pose, residual, jacobian);
    const double error = residual.cwiseAbs().maxCoeff();
    const bool better = error < least;
    if (better) {
      least = error;
      best = pose;
    }
    if (error <= std::numeric_limits<double>::epsilon()) break;
    const Vector3d first = jacobian.row(0), second = jacobian.row(1), third = jacobian.row(2);
    const Vector3d a = second.cross(third), b = third.cross(first), c = first.cross(second);
    const double det = first.dot(a);
    if (!better && least < kClosure && std::abs(det) > 1e-6) break;
    Vector3d by = -(a * residual[0] + b * residual[1] + c * residual[2]) / det;
    const bool lost = error < kNear && !(by.cwiseAbs().maxCoeff() < kLost);
    if (lost && error < kClosure) {
      best.singular = true;
      break;
    }
    if (lost || (error >= kNear && std::abs(det) < 1e-9)) {  // the shortest step, also onto a curve of poses
      by = shortest_step(jacobian, residual, 1e-9);
    }
    const double longest = by.cwiseAbs().maxCoeff();
    if (!(longest < kFar)) break;
    const double stride = 0.5 * (1 + std::abs(pose.q));
    if (longest > stride) by *= stride / longest;
    move(pose, by);
  }
  if (std::abs(best.q) > kFar || least > kClosure + rounding(best)) return std::nullopt;
  return best;
}

/// To which a pose closes whatever is done. One far out has its own.
double Triad::rounding(const Pose& pose) const {
  return 8 * rounding_ * (1 + std::abs(pose.q));
}

/// Whether two poses are one to rounding: the one midway, put on the curve that the platform is free to
/// follow, closes as they do.
bool Triad::are_one(const Pose& a, const Pose& b) const {
  const Complex between = a.z + b.z;
  Pose midway{(a.q + b.q) / 2.0, between / std::abs(between)};
  Vector3d residual;
  Matrix3d jacobian;
  differentiate(midway, residual, jacobian);
  if (residual.cwiseAbs().maxCoeff() > rounding(a)) {
    move(midway, shortest_step(jacobian, residual, 1e-6));
    differentiate(midway, residual, jacobian);
  }
  return residual.cwiseAbs().maxCoeff() <= rounding(a);
}

/// Whether poses close along the direction in which this one is free to first order, and not this one alone.
bool Triad::lies_on_curve(const Pose& pose) const {
  Vector3d residual;
  Matrix3d jacobian;
  differentiate(pose, residual, jacobian);
  Vector3d tangent = Vector3d::Zero();
  int redundant = 0;
  for (int i = 0; i < 3; ++i) {
    const Vector3d normal = jacobian.row((i + 1) % 3).cross(jacobian.row((i + 2) % 3));
    if (normal.squaredNorm() <= tangent.squaredNorm()) continue;
    tangent = normal;
    redundant = i;
  }
  const double area = tangent.norm();
  if (area == 0 || std::abs(jacobian.row(redundant).dot(tangent)) > 1e-4 * area) return false;
  tangent /= area;
  for (const double way : {0.1, -0.07}) {
    // Newton on the other two conditions, at a distance; at a dead centre the third then fails by its square
    Pose moved = pose;
    const double distance = way * shortest_;
    Vector3d done = Vector3d::Zero();
    for (int step = 0; step < 12; ++step) {
      differentiate(moved, residual, jacobian);
      residual[redundant] = tangent.dot(done) - distance;
      jacobian.row(redundant) = tangent.transpose();
      const Vector3d by = -jacobian.partialPivLu().solve(residual);
      if (!(by.cwiseAbs().maxCoeff() < 1)) return false;
      done += by;
      move(moved, by);
    }
    differentiate(moved, residual, jacobian);
    if (residual.cwiseAbs().maxCoeff() > 10 * kClosure + 64 * rounding_) return false;
  }
  return true;
}

void Triad::keep(const Pose& pose) {
  constexpr double kNear =
      1e-5;  // a dead centre that closes to 1e-13 stands for modes within the root of that
  for (std::size_t i = 0; i < n_found_; ++i) {
    Pose& known = found_[i];
    const double distance =
        std::max(std::abs(pose.q - known.q) / (1 + std::abs(pose.q)), std::abs(pose.z - known.z));
    if (distance > 1e-2) continue;
    if (!are_one(pose, known) && !((pose.singular || known.singular) && distance < kNear)) continue;
    if (known.singular) known = pose;
    return;
  }
  if (n_found_ < found_.size()) found_[n_found_++] = pose;
}

void Triad::consider(const Pose& guess) {
  const auto pose = closed(guess);
  if (!pose) return;
  if (lies_on_curve(*pose))
    movable_ = true;
  else
    keep(*pose);
}

/// Where the line crosses the reference circle; where it misses it, the nearest place on the circle.
void Triad::visit_crossing(const Line& line, Complex z) {
  const Complex u = line.u(z);
  const double length = std::abs(u);
  const Complex across = u / length;
  const double along = std::clamp(line.w(z) / length, -radius_, radius_);
  const double half_chord = std::sqrt((radius_ - along) * (radius_ + along));
  consider({across * Complex(along, half_chord), z});
  consider({across * Complex(along, -half_chord), z});
}

/// Near a direction in which the platform lies parallel to a base like it: the circles are nearly one, and θ
/// tells little of q.
void Triad::visit_parallel(Complex z) {
  // if they are one, any place on them will do; eight, for some may be singular
  for (int k = 0; k < 8; ++k) consider({std::polar(radius_, 0.3 + k * 0.785), z});
  // If they are nearly one: with z turned to where the u come nearest to 0 and by a small δ from there,
  // u ≈ δu', so u'·p = w for p = δq; |q| = l then gives δ and q.
  const Complex alike = std::conj(lines_[0].u1) * lines_[0].u0 + std::conj(lines_[1].u1) * lines_[1].u0;
  if (std::abs(alike) == 0) return;
  const Complex nearest = -alike / std::abs(alike);
  const Complex a = kI * lines_[0].u1 * nearest;
  const Complex b = kI * lines_[1].u1 * nearest;
  const Complex p = -kI * (lines_[0].w(nearest) * b - lines_[1].w(nearest) * a) / cross(a, b);
  const double length = std::abs(p);
  if (!(length > 0 && length < radius_)) return;
  consider({p / length * radius_, turned(nearest, length / radius_)});
  consider({-p / length * radius_, turned(nearest, -length / radius_)});
}

/// The poses of the platform in direction z.
void Triad::visit(Complex z) {
  constexpr double kWellCrossed =
      1e-3;                        // sine of an angle that costs N/D three digits; polishing returns them
  constexpr double kShort = 3e-3;  // of u; its direction may then be unknown
  std::array<Complex, 3> u;
  for (std::size_t i = 0; i < n_lines_; ++i) u[i] = lines_[i].u(z);
  std::size_t a = 0, b = 1;
  double d = cross(u[0], u[1]);
  for (std::size_t i = 0; i < n_lines_ && !circular_; ++i) {  // the two of three lines that cross best
    const double other = cross(u[(i + 1) % 3], u[(i + 2) % 3]);
    if (std::abs(other) <= std::abs(d)) continue;
    d = other;
    a = (i + 1) % 3;
    b = (i + 2) % 3;
  }
  const double sine = std::abs(d) / (std::abs(u[a]) * std::abs(u[b]));
  if (sine > (circular_ ? kWellCrossed : 16 * rounding_)) {
    consider({-kI * (lines_[a].w(z) * u[b] - lines_[b].w(z) * u[a]) / d, z});
  } else if (!circular_) {
    consider({u[0] * lines_[0].w(z) / std::norm(u[0]), z});
  } else if (std::max(std::abs(u[0]), std::abs(u[1])) >= kShort) {
    visit_crossing(std::abs(u[0]) > std::abs(u[1]) ? lines_[0] : lines_[1], z);
  }
  if (circular_ && std::max(std::abs(u[0]), std::abs(u[1])) < kShort) visit_parallel(z);
}

PlatformPose Triad::placed(const Pose& pose) const {
  const double c = pose.z.real();
  const double s = pose.z.imag();
  const Vector2d turned(c * local_.x() - s * local_.y(), s * local_.x() + c * local_.y());
  return {origin_ + size_ * Vector2d(pose.q.real(), pose.q.imag()) - turned, c, s};
}

PlatformModes Triad::modes() {
  double scale = 0;
  const TrigonometricCubic f = characteristic(scale);
  const double negligible = std::min(64 * rounding_ / (smallest_factor_ * smallest_factor_), 1e-6) * scale;
  PlatformModes result;
  if (f.size() <= negligible) {  // every direction may have its pose
    for (int k = 0; k < 16 && !movable_; ++k) visit(std::polar(1.0, 0.1 + k * 0.3926));
    result.movable = movable_;
    if (movable_ || f.size() == 0) return result;
    n_found_ = 0;
  }
  const Directions directions = zeros(f, negligible);
  for (int i = 0; i < directions.count; ++i) visit(directions.z[static_cast<std::size_t>(i)]);

  for (std::size_t i = 0; i < n_found_; ++i) result.poses[i] = placed(found_[i]);
  result.count = static_cast<int>(n_found_);
  result.movable = movable_;
  // grows with θ in (−π, π]
  const auto angle = [](const PlatformPose& p) { return p.sine < 0 ? p.cosine - 1 : 1 - p.cosine; };
  std::sort(result.poses.begin(), result.poses.begin() + result.count,
            [&](const PlatformPose& p, const PlatformPose& q) {
              return std::tuple(angle(p), p.sine, p.position.x(), p.position.y()) <
                     std::tuple(angle(q), q.sine, q.position.x(), q.position.y());
            });
  return result;
}

}  // namespace

PlatformModes platform_modes(const std::array<Lead, 3>& leads) {
  return Triad(leads).modes();
}

}  // namespace oblique
