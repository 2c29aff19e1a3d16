// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/QR>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::mechanism {

/// The oracle of the exact kinematics, which shares nothing with it but the mechanism as it was read: a
/// mechanism in natural coordinates, its unknowns the coordinates of its points and nothing else (J. García
/// de Jalón and E. Bayo, Kinematic and Dynamic Simulation of Multibody Systems, Springer 1994, ch. 2). There
/// are no angles, no groups, no order of solution and no branches: one set of equations, in long double,
/// solved as a whole.
///
/// With d = second − first of a link or a line and J d = d turned left by a right angle:
///
///     two points of a link         (d·d − L²) / 2L = 0
///     a further point at (u, v)    p − first − (u d + v J d)/L = 0              two equations
///     a point on a line            d × (p − first)/|d| − offset = 0
///     a link b that keeps α        (cos α (d × b) − sin α (d · b))/|d| = 0      and the other sign of b is
///                                                                               another assembly mode
///     a turned link                d − L (cos θ, sin θ) = 0                     two equations
///     a moved prismatic joint                d · (p − first)/|d| − s = 0
///
/// Every one is a sum of differences of coordinates and of products of two such, less a known function of
/// time, f(x) = c(t). So the derivatives by time are exact and short:
///
///     f′(x) ẋ = ċ,    f′(x) ẍ = c̈ − 2 f₂(ẋ)         f₂: the products alone
///
/// The equations are more than the unknowns where a link is driven; they agree, and the least squares of the
/// QR decomposition do not mind. All residuals are lengths.
class NaturalCoordinates {
 public:
  using Real = long double;
  using Vector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
  using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
  using Planar = Eigen::Matrix<Real, 2, 1>;

  /// What a drive gives: an angle [rad] or a distance [length unit], and its derivatives by time.
  struct Given {
    Real value = 0, rate = 0, acceleration = 0;
  };

  /// Coordinates of all points, x and y in turn, and their derivatives by time. Those of the frame are
  /// constant.
  struct Pose {
    Vector position, velocity, acceleration;
    Real residual = 0;      ///< largest of all equations [length unit]
    Real conditioning = 0;  ///< of the equations: smallest over largest pivot; 0 in a dead centre
  };

  /// Position and its derivatives of a link's angle [rad] or of a prismatic joint [length unit].
  struct Scalar {
    Real value = 0, rate = 0, acceleration = 0;
  };

  explicit NaturalCoordinates(const Mechanism& mechanism) : mechanism_(mechanism) {
    column_.assign(2 * mechanism.points.size(), -1);
    for (std::size_t i = 0; i < mechanism.points.size(); ++i) {
      if (mechanism.points[i].fixed) continue;
      column_[2 * i] = unknowns_++;
      column_[2 * i + 1] = unknowns_++;
    }
    for (const Body& body : mechanism.bodies) add_body(body);
    for (const Slide& slide : mechanism.slides) add_slide(slide);
    for (std::size_t i = 0; i < mechanism.drives.size(); ++i) add_drive(mechanism.drives[i], i);
  }

  Eigen::Index unknowns() const { return unknowns_; }

  /// Largest residual of the equations, those of the drives included, at coordinates of all points [length
  /// unit].
  Real residual(const Vector& position, const std::vector<Given>& given) const {
    return residuals(position, given).cwiseAbs().maxCoeff();
  }

  /// Newton's method from a guess for all points (those of the frame are put in their places), then the
  /// derivatives.
  Pose solve(const Vector& guess, const std::vector<Given>& given) const {
    constexpr int kIterations = 40;
    const Real unit = mechanism_.largest_length();
    Pose pose;
    pose.position = guess;
    put_frame(pose.position);
    for (int i = 0; i < kIterations; ++i) {
      const Vector step = decompose(pose.position).solve(-residuals(pose.position, given));
      move(pose.position, step);
      if (!(step.cwiseAbs().maxCoeff() > 1e-18L * unit)) break;
    }
    pose.residual = residual(pose.position, given);
    differentiate(pose, given);
    return pose;
  }

  /// Follows the motion from `pose` at `from` to `to`, in `steps` equal steps of the drives' values. Each
  /// begins with a Taylor polynomial of degree 2, so that in a regular motion Newton's method has next to
  /// nothing left to do and cannot reach another branch.
  Pose follow(Pose pose, const std::vector<Given>& from, const std::vector<Given>& to, int steps) const {
    const Real h = 1 / static_cast<Real>(steps);
    for (int k = 1; k <= steps; ++k) {
      std::vector<Given> here(from.size()), next(from.size());
      for (std::size_t d = 0; d < from.size(); ++d) {
        const Real way = to[d].value - from[d].value;
        here[d] = {from[d].value + way * static_cast<Real>(k - 1) * h, way, 0};
        next[d] = {from[d].value + way * static_cast<Real>(k) * h, way, 0};
      }
      differentiate(pose, here);
      const Vector guess = pose.position + h * pose.velocity + h * h / 2 * pose.acceleration;
      pose = solve(guess, k == steps ? to : next);
    }
    return pose;
  }

  Planar point(const Vector& coordinates, std::size_t point) const {
    return coordinates.segment<2>(2 * static_cast<Eigen::Index>(point));
  }

  /// A link's angle of first → second point from +x, the one nearest to `near`.
  Scalar angle(const Pose& pose, std::size_t body, Real near) const {
    const auto& points = mechanism_.bodies[body].points;
    const Line line{points[0].point, points[1].point};
    const Planar d = along(pose.position, line);
    const Planar rate = along(pose.velocity, line);
    const Planar acceleration = along(pose.acceleration, line);
    // ω = (d × ḋ)/L² and, as ḋ × ḋ = 0, α = (d × d̈)/L²
    const Real wrapped = std::atan2(d.y(), d.x());
    return {near + std::remainder(wrapped - near, 2 * kPi), cross(d, rate) / d.squaredNorm(),
            cross(d, acceleration) / d.squaredNorm()};
  }

  /// A prismatic joint's distance from the first point of its line.
  Scalar slide(const Pose& pose, std::size_t index) const {
    const Slide& s = mechanism_.slides[index];
    const Line line{s.first, s.second}, arm{s.first, s.point};
    const Planar d0 = along(pose.position, line), d1 = along(pose.velocity, line),
                 d2 = along(pose.acceleration, line);
    const Planar p0 = along(pose.position, arm), p1 = along(pose.velocity, arm),
                 p2 = along(pose.acceleration, arm);
    const Real length = d0.norm();
    return {d0.dot(p0) / length, (d1.dot(p0) + d0.dot(p1)) / length,
            (d2.dot(p0) + 2 * d1.dot(p1) + d0.dot(p2)) / length};
  }

  /// Whether every link that keeps an angle to a line points the right way along it.
  bool guides_agree(const Vector& position) const {
    for (const Slide& s : mechanism_.slides) {
      if (!s.of) continue;
      const auto& points = mechanism_.bodies[*s.of].points;
      const Planar d = along(position, {s.first, s.second});
      const Planar b = along(position, {points[0].point, points[1].point});
      const Real angle = s.angle;
      if (std::cos(angle) * d.dot(b) + std::sin(angle) * cross(d, b) <= 0) return false;
    }
    return true;
  }

  static constexpr Real kPi = 3.141592653589793238462643383279502884L;

 private:
  struct Line {
    std::size_t from, to;  // indices of points
  };
  struct Difference {
    Eigen::Index to, from;  // indices of coordinates
  };
  struct Linear {
    Real factor;
    Difference a;
  };
  struct Product {
    Real factor;
    Difference a, b;
  };
  enum class Kind { constant, cosine, sine, distance };
  struct Equation {
    std::vector<Linear> linear;
    std::vector<Product> products;
    Real constant = 0;  // or the factor of what the drive gives
    Kind kind = Kind::constant;
    std::size_t drive = 0;
  };

  static Real cross(const Planar& a, const Planar& b) { return a.x() * b.y() - a.y() * b.x(); }

  Planar along(const Vector& coordinates, Line line) const {
    return point(coordinates, line.to) - point(coordinates, line.from);
  }

  static Difference x(Line line) {
    return {2 * static_cast<Eigen::Index>(line.to), 2 * static_cast<Eigen::Index>(line.from)};
  }
  static Difference y(Line line) {
    return {2 * static_cast<Eigen::Index>(line.to) + 1, 2 * static_cast<Eigen::Index>(line.from) + 1};
  }
  static void add_dot(Equation& equation, Real factor, Line a, Line b) {
    equation.products.push_back({factor, x(a), x(b)});
    equation.products.push_back({factor, y(a), y(b)});
  }
  static void add_cross(Equation& equation, Real factor, Line a, Line b) {
    equation.products.push_back({factor, x(a), y(b)});
    equation.products.push_back({-factor, y(a), x(b)});
  }

  void add_body(const Body& body) {
    const Line base{body.points[0].point, body.points[1].point};
    const Real length = body.points[1].local.x();
    Equation rigid;
    add_dot(rigid, 1 / (2 * length), base, base);
    rigid.constant = length / 2;
    equations_.push_back(rigid);
    for (std::size_t i = 2; i < body.points.size(); ++i) {
      const Real u = body.points[i].local.x() / length, v = body.points[i].local.y() / length;
      const Line arm{base.from, body.points[i].point};
      equations_.push_back({{{1, x(arm)}, {-u, x(base)}, {v, y(base)}}, {}});
      equations_.push_back({{{1, y(arm)}, {-u, y(base)}, {-v, x(base)}}, {}});
    }
  }

  /// Distance of the two points that name a line.
  Real length(const Slide& slide) const {
    if (!slide.carrier)
      return (mechanism_.points[slide.second].position - mechanism_.points[slide.first].position)
          .cast<Real>()
          .norm();
    const Body& carrier = mechanism_.bodies[*slide.carrier];
    return (carrier.find(slide.second)->local - carrier.find(slide.first)->local).cast<Real>().norm();
  }

  void add_slide(const Slide& slide) {
    const Line line{slide.first, slide.second}, arm{slide.first, slide.point};
    Equation on_line;
    add_cross(on_line, 1 / length(slide), line, arm);
    on_line.constant = slide.offset;
    equations_.push_back(on_line);
    if (!slide.of) return;
    const auto& points = mechanism_.bodies[*slide.of].points;
    const Line guided{points[0].point, points[1].point};
    const Real angle = slide.angle;
    Equation keeps;
    add_cross(keeps, std::cos(angle) / length(slide), line, guided);
    add_dot(keeps, -std::sin(angle) / length(slide), line, guided);
    equations_.push_back(keeps);
  }

  void add_drive(const Drive& drive, std::size_t index) {
    if (drive.slide) {
      const Slide& slide = mechanism_.slides[*drive.slide];
      Equation moved;
      add_dot(moved, 1 / length(slide), {slide.first, slide.second}, {slide.first, slide.point});
      moved.kind = Kind::distance;
      moved.constant = 1;
      moved.drive = index;
      equations_.push_back(moved);
      return;
    }
    const auto& points = mechanism_.bodies[drive.body].points;
    const Line turned{points[0].point, points[1].point};
    const Real length = points[1].local.x();
    equations_.push_back({{{1, x(turned)}}, {}, length, Kind::cosine, index});
    equations_.push_back({{{1, y(turned)}}, {}, length, Kind::sine, index});
  }

  /// The known side of an equation and its derivatives by time.
  static Scalar known(const Equation& equation, const std::vector<Given>& given) {
    const Real c = equation.constant;
    if (equation.kind == Kind::constant) return {c, 0, 0};
    const Given& g = given[equation.drive];
    if (equation.kind == Kind::distance) return {c * g.value, c * g.rate, c * g.acceleration};
    const Real cosine = c * std::cos(g.value), sine = c * std::sin(g.value), square = g.rate * g.rate;
    if (equation.kind == Kind::cosine)
      return {cosine, -sine * g.rate, -cosine * square - sine * g.acceleration};
    return {sine, cosine * g.rate, -sine * square + cosine * g.acceleration};
  }

  static Real of(const Vector& v, Difference d) { return v(d.to) - v(d.from); }

  static Real products(const Equation& equation, const Vector& v) {
    Real sum = 0;
    for (const Product& p : equation.products) sum += p.factor * of(v, p.a) * of(v, p.b);
    return sum;
  }

  Vector residuals(const Vector& position, const std::vector<Given>& given) const {
    Vector result(static_cast<Eigen::Index>(equations_.size()));
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      Real sum = products(equations_[i], position) - known(equations_[i], given).value;
      for (const Linear& l : equations_[i].linear) sum += l.factor * of(position, l.a);
      result(static_cast<Eigen::Index>(i)) = sum;
    }
    return result;
  }

  Eigen::ColPivHouseholderQR<Matrix> decompose(const Vector& position) const {
    Matrix jacobian = Matrix::Zero(static_cast<Eigen::Index>(equations_.size()), unknowns_);
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto add = [&](Real factor, Difference d) {
        const Eigen::Index plus = column_[static_cast<std::size_t>(d.to)],
                           minus = column_[static_cast<std::size_t>(d.from)];
        if (plus >= 0) jacobian(row, plus) += factor;
        if (minus >= 0) jacobian(row, minus) -= factor;
      };
      for (const Linear& l : equations_[i].linear) add(l.factor, l.a);
      for (const Product& p : equations_[i].products) {
        add(p.factor * of(position, p.b), p.a);
        add(p.factor * of(position, p.a), p.b);
      }
    }
    Eigen::ColPivHouseholderQR<Matrix> decomposition(jacobian.rows(), jacobian.cols());
    decomposition.setThreshold(1e-15L);
    return decomposition.compute(jacobian);
  }

  void differentiate(Pose& pose, const std::vector<Given>& given) const {
    const auto decomposition = decompose(pose.position);
    const auto pivots = decomposition.matrixQR().diagonal().cwiseAbs();
    pose.conditioning = pivots.minCoeff() / pivots.maxCoeff();
    Vector right(static_cast<Eigen::Index>(equations_.size()));
    for (std::size_t i = 0; i < equations_.size(); ++i)
      right(static_cast<Eigen::Index>(i)) = known(equations_[i], given).rate;
    pose.velocity = Vector::Zero(pose.position.size());
    move(pose.velocity, decomposition.solve(right));
    for (std::size_t i = 0; i < equations_.size(); ++i) {
      right(static_cast<Eigen::Index>(i)) =
          known(equations_[i], given).acceleration - 2 * products(equations_[i], pose.velocity);
    }
    pose.acceleration = Vector::Zero(pose.position.size());
    move(pose.acceleration, decomposition.solve(right));
  }

  void move(Vector& coordinates, const Vector& step) const {
    for (std::size_t i = 0; i < column_.size(); ++i) {
      if (column_[i] >= 0) coordinates(static_cast<Eigen::Index>(i)) += step(column_[i]);
    }
  }

  void put_frame(Vector& position) const {
    for (std::size_t i = 0; i < mechanism_.points.size(); ++i) {
      const Point& p = mechanism_.points[i];
      if (p.fixed) position.segment<2>(2 * static_cast<Eigen::Index>(i)) = p.position.cast<Real>();
    }
  }

  const Mechanism& mechanism_;
  std::vector<Equation> equations_;
  std::vector<Eigen::Index> column_;  // of a coordinate among the unknowns; −1: of the frame
  Eigen::Index unknowns_ = 0;
};

}  // namespace oblique::mechanism
