// SPDX-License-Identifier: MIT
#include <oblique/mechanism/triad/triad.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include <oblique/mechanism/triad/triad_closure.h>
#include <oblique/mechanism/triad/triad_equation.h>

namespace oblique::mechanism {
namespace triad {
namespace {

using Eigen::Vector2d;

Complex complex(const Vector2d& v) {
  return {v.x(), v.y()};
}

/// The three conditions as those of a group of size 1 about a reference point.
struct Normalised {
  std::array<Condition, 3> conditions;
  bool circular = false;  ///< the last condition is the reference circle
  double rounding = 0;    ///< of the given coordinates, relative to `size`
  double size = 1;        ///< [length unit]
  Vector2d origin;        ///< the reference point's place q = 0
  Vector2d local;         ///< the reference point in the platform's frame

  explicit Normalised(const std::array<Leg, 3>& legs);
  PlatformPose placed(const Pose& pose) const;
};

Normalised::Normalised(const std::array<Leg, 3>& legs) {
  // the longest circle for reference: a short one would leave F a difference of nearly equal squares
  std::size_t reference = 2;
  for (std::size_t i = 0; i < 3; ++i) {
    if (legs[i].kind != Leg::Kind::circle) continue;
    if (!circular || legs[i].length > legs[reference].length) reference = i;
    circular = true;
  }
  origin = legs[reference].anchor;
  local = legs[reference].local;
  for (const Leg& leg : legs) {  // rather a point of the group than one that only names a line
    if (circular) break;
    (leg.kind == Leg::Kind::platform_line ? origin : local) =
        leg.kind == Leg::Kind::platform_line ? leg.anchor : leg.local;
  }

  double extent = 0;
  double largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Leg& leg = legs[(reference + 1 + i) % 3];  // the reference comes last
    Condition& condition = conditions[i];
    condition = {leg.kind, complex(leg.local - local), complex(leg.anchor - origin),
                 kQuarterTurn * complex(leg.direction), 0};
    if (leg.kind == Leg::Kind::circle) {
      condition.length = leg.length;
    } else {  // of a line only its distance counts
      Complex& on_line = leg.kind == Leg::Kind::fixed_line ? condition.anchor : condition.local;
      on_line = condition.normal * dot(condition.normal, on_line);
    }
    extent = std::max({extent, std::abs(condition.local), std::abs(condition.anchor), condition.length});
    largest = std::max({largest, leg.local.cwiseAbs().maxCoeff(), leg.anchor.cwiseAbs().maxCoeff()});
  }
  size = extent > 0 ? extent : 1;
  rounding = std::numeric_limits<double>::epsilon() * (1 + largest / size);
  for (Condition& condition : conditions) {
    condition.local /= size;
    condition.anchor /= size;
    condition.length /= size;
  }
}

PlatformPose Normalised::placed(const Pose& pose) const {
  const double c = pose.z.real();
  const double s = pose.z.imag();
  const Vector2d turned(c * local.x() - s * local.y(), s * local.x() + c * local.y());
  return {origin + size * Vector2d(pose.q.real(), pose.q.imag()) - turned, c, s};
}

/// The search for the modes of one group.
class Triad {
 public:
  explicit Triad(const std::array<Leg, 3>& legs);

  PlatformModes modes();

 private:
  void add_line(const Condition& condition);
  void visit(Complex z);
  void visit_crossing(const Line& line, Complex z);
  void visit_parallel(Complex z);
  void consider(const Pose& guess);
  void keep(const Pose& pose);

  Normalised group_;
  Closure closure_;
  double radius_ = 0;          ///< of the reference circle
  std::array<Line, 3> lines_;  ///< the first two where there is a reference circle
  std::size_t n_lines_ = 0;
  double smallest_factor_ = 1;  ///< by which a line was divided to bring it to size 1
  std::array<Pose, 8> found_;
  std::size_t n_found_ = 0;
  bool movable_ = false;
};

Triad::Triad(const std::array<Leg, 3>& legs)
    : group_(legs), closure_(group_.conditions, group_.rounding), radius_(group_.conditions[2].length) {
  for (const Condition& condition : std::span(group_.conditions).first(group_.circular ? 2 : 3))
    add_line(condition);
}

void Triad::add_line(const Condition& condition) {
  const auto& [kind, b, a, n, length] = condition;
  Line& line = lines_[n_lines_++];
  if (kind == Leg::Kind::fixed_line) {
    line = {n, 0, dot(n, a), -std::conj(n) * b};
  } else if (kind == Leg::Kind::platform_line) {
    line = {0, n, -dot(n, b), std::conj(a) * n};
  } else {
    const double squares = std::norm(a) + std::norm(b) + (radius_ - length) * (radius_ + length);
    const double size = modulus(a) + modulus(b);
    const double factor = size > group_.rounding ? size : 1;  // two circles that are one: 0·q = w
    smallest_factor_ = std::min(smallest_factor_, factor);
    line = {-a / factor, b / factor, -squares / (2 * factor), std::conj(a) * b / factor};
  }
}

void Triad::keep(const Pose& pose) {
  // a dead centre that closes to 1e-13 stands for the modes within some roots of that
  constexpr double kNear = 1e-5;
  for (std::size_t i = 0; i < n_found_; ++i) {
    Pose& known = found_[i];
    const double distance =
        std::max(modulus(pose.q - known.q) / (1 + modulus(pose.q)), modulus(pose.z - known.z));
    if (distance > 1e-2) continue;
    if (!closure_.are_one(pose, known) && !((pose.singular || known.singular) && distance < kNear)) continue;
    if (known.singular) known = pose;
    return;
  }
  if (n_found_ < found_.size()) found_[n_found_++] = pose;
}

void Triad::consider(const Pose& guess) {
  const auto pose = closure_.polished(guess);
  if (!pose) return;
  if (closure_.lies_on_curve(*pose))
    movable_ = true;
  else
    keep(*pose);
}

/// Where the line crosses the reference circle; where it misses it, the nearest place on the circle.
void Triad::visit_crossing(const Line& line, Complex z) {
  const Complex u = line.u(z);
  const double length = modulus(u);
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
  if (modulus(alike) == 0) return;
  const Complex nearest = -alike / modulus(alike);
  const Complex a = kQuarterTurn * lines_[0].u1 * nearest;
  const Complex b = kQuarterTurn * lines_[1].u1 * nearest;
  const Complex p = -kQuarterTurn * (lines_[0].w(nearest) * b - lines_[1].w(nearest) * a) / cross(a, b);
  const double length = modulus(p);
  if (!(length > 0 && length < radius_)) return;
  consider({p / length * radius_, turned(nearest, length / radius_)});
  consider({-p / length * radius_, turned(nearest, -length / radius_)});
}

/// The poses of the platform in direction z.
void Triad::visit(Complex z) {
  constexpr double kWellCrossed =
      1e-3;                        // sine of the angle; it costs N/D three digits, and Newton returns them
  constexpr double kShort = 3e-3;  // of u; its direction may then be unknown
  std::array<Complex, 3> u;
  for (std::size_t i = 0; i < n_lines_; ++i) u[i] = lines_[i].u(z);
  std::size_t a = 0, b = 1;
  double d = cross(u[0], u[1]);
  for (std::size_t i = 0; i < n_lines_ && !group_.circular; ++i) {  // the two of three lines that cross best
    const double other = cross(u[(i + 1) % 3], u[(i + 2) % 3]);
    if (std::abs(other) <= std::abs(d)) continue;
    d = other;
    a = (i + 1) % 3;
    b = (i + 2) % 3;
  }
  const double sine = std::abs(d) / (modulus(u[a]) * modulus(u[b]));
  const bool cross_well = sine > (group_.circular ? kWellCrossed : 16 * group_.rounding);
  if (cross_well) consider({crossing(lines_[a], lines_[b], z, d), z});
  if (!group_.circular) {
    if (!cross_well) consider({u[0] * lines_[0].w(z) / std::norm(u[0]), z});
    return;
  }
  const auto [shorter, longer] = std::minmax({modulus(u[0]), modulus(u[1])});
  if (longer < kShort) {
    visit_parallel(z);
  } else if (!cross_well || shorter < kShort) {
    // a parallelogram holds z alone, and both crossings are modes
    visit_crossing(modulus(u[0]) > modulus(u[1]) ? lines_[0] : lines_[1], z);
  }
}

PlatformModes Triad::modes() {
  const double rounding = group_.rounding / smallest_factor_;
  const auto& [a, b, c] = lines_;
  const auto [f, terms] = group_.circular ? characteristic(a, b, radius_) : characteristic(a, b, c);
  const double negligible = std::min(64 * rounding / smallest_factor_, 1e-6) * terms;
  PlatformModes result;
  if (f.size() <= negligible) {  // every direction may have its pose
    for (int k = 0; k < 16 && !movable_; ++k) visit(std::polar(1.0, 0.1 + k * 0.3926));
    result.movable = movable_;
    if (movable_ || f.size() == 0) return result;
    n_found_ = 0;
  }
  const Directions directions = zeros(f, negligible);
  for (int i = 0; i < directions.count; ++i) visit(directions.z[static_cast<std::size_t>(i)]);

  for (std::size_t i = 0; i < n_found_; ++i) result.poses[i] = group_.placed(found_[i]);
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
}  // namespace triad

PlatformModes platform_modes(const std::array<Leg, 3>& legs) {
  return triad::Triad(legs).modes();
}

}  // namespace oblique::mechanism
