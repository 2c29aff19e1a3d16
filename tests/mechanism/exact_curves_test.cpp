// SPDX-License-Identifier: MIT
// Curves that are known exactly, at every degree: what the classical mechanisms are for.
#include <oblique/mechanism/motion/motion.h>

#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "catalogue.h"

namespace oblique::mechanism {
namespace {

using Complex = std::complex<double>;
constexpr Complex kI{0, 1};

/// A complex motion: z, ż, z̈.
struct Jet {
  Complex z, v, a;
};

Jet operator*(Complex factor, const Jet& jet) {
  return {factor * jet.z, factor * jet.v, factor * jet.a};
}
Jet operator+(const Jet& a, const Jet& b) {
  return {a.z + b.z, a.v + b.v, a.a + b.a};
}

/// e^{iθ} for an angle with its rates.
Jet unit(double angle, double omega, double alpha) {
  const Complex e = std::polar(1.0, angle);
  return {e, kI * omega * e, (kI * alpha - omega * omega) * e};
}

Complex complex(const Eigen::Vector2d& v) {
  return {v.x(), v.y()};
}

/// The project's accuracy: 1e-12 of `size` for a position, 1e-10 for rates, whose sizes follow from the rate
/// `omega` of the drive; `slack` times that for the acceleration.
void expect_jet(const PointState& ours, const Jet& exact, double size, double omega, double slack = 1) {
  EXPECT_LT(std::abs(complex(ours.position) - exact.z), 1e-12 * size);
  EXPECT_LT(std::abs(complex(ours.velocity) - exact.v), 1e-10 * size * omega);
  EXPECT_LT(std::abs(complex(ours.acceleration) - exact.a), slack * 1e-10 * size * omega * omega);
}

TEST(ExactCurve, OfTheTrammelIsAnEllipse) {
  const MovingMechanism trammel("elliptical-trammel");
  for (std::size_t row = 0; row < trammel.rows(); ++row) {
    const double phi = 2 * std::numbers::pi * trammel.time(row);
    const Jet turn = unit(phi, 2 * std::numbers::pi, 0);
    const auto flat = [&](double across, double up) {
      return Jet{{across * turn.z.real(), up * turn.z.imag()},
                 {across * turn.v.real(), up * turn.v.imag()},
                 {across * turn.a.real(), up * turn.a.imag()}};
    };
    expect_jet(trammel.point("P", row), flat(80, 200), 200, 2 * std::numbers::pi);
    expect_jet(trammel.point("M", row), flat(-60, 60), 200, 2 * std::numbers::pi);
    const Eigen::Vector2d p = trammel.point("P", row).position;
    EXPECT_NEAR(p.x() * p.x() / 6400 + p.y() * p.y() / 40000, 1, 1e-13);
  }
}

TEST(ExactCurve, OfTheTrammelIsTheSameWhicheverPartIsDriven) {
  const MovingMechanism trammel("elliptical-trammel-by-slide");
  for (std::size_t row = 0; row < trammel.rows(); ++row) {
    // the law's integral, −90 sin 2πt
    EXPECT_NEAR(trammel.drive(row).value, -90 * std::sin(2 * std::numbers::pi * trammel.time(row)), 1e-11);
    const Eigen::Vector2d p = trammel.point("P", row).position;
    EXPECT_NEAR(p.x() * p.x() / 6400 + p.y() * p.y() / 40000, 1, 1e-13);
  }
}

/// Q = c + i c tan(φ/2): the straight line on which both inversors draw.
void expect_straight_line(const MovingMechanism& inversor, double c, double power) {
  for (std::size_t row = 0; row < inversor.rows(); ++row) {
    const double t = inversor.time(row);
    const double phi = std::numbers::pi / 2 * std::sin(2 * std::numbers::pi * t),
                 omega = std::numbers::pi * std::numbers::pi * std::cos(2 * std::numbers::pi * t),
                 alpha = -2 * std::numbers::pi * std::numbers::pi * std::numbers::pi *
                         std::sin(2 * std::numbers::pi * t);
    EXPECT_NEAR(inversor.drive(row).value, phi, 1e-13);
    const double tangent = std::tan(phi / 2), slope = (1 + tangent * tangent) / 2;
    const Jet line{
        {c, c * tangent}, {0, c * slope * omega}, {0, c * (slope * alpha + slope * tangent * omega * omega)}};
    // ω stays below 10
    expect_jet(inversor.point("Q", row), line, inversor.mechanism.largest_length(), 10);
    const Complex p = complex(inversor.point("P", row).position),
                  q = complex(inversor.point("Q", row).position);
    EXPECT_NEAR(std::abs(p) * std::abs(q), power, 1e-12 * power);
    EXPECT_NEAR(std::arg(p), std::arg(q), 1e-13);
  }
}

TEST(ExactCurve, OfPeaucellierAndLipkinsInversorIsAStraightLine) {
  expect_straight_line(MovingMechanism("peaucellier-lipkin"), 36, 900);
}

TEST(ExactCurve, OfHartsInversorIsAStraightLine) {
  expect_straight_line(MovingMechanism("hart-inversor"), 32, 1600);
}

TEST(ExactCurve, OfThePantographIsSimilar) {
  const MovingMechanism pantograph("pantograph");
  for (std::size_t row = 0; row < pantograph.rows(); ++row) {
    const Jet circle =
        Complex(20) * unit(2 * std::numbers::pi * pantograph.time(row), 2 * std::numbers::pi, 0) +
        Jet{{60, 20}, 0, 0};
    expect_jet(pantograph.point("T", row), circle, 150, 2 * std::numbers::pi);
    expect_jet(pantograph.point("P", row), Complex(3) * circle, 150, 2 * std::numbers::pi);
  }
}

TEST(ExactCurve, OfTheScotchYokeIsASine) {
  const MovingMechanism straight("scotch-yoke"), inclined("scotch-yoke-inclined");
  for (std::size_t row = 0; row < straight.rows(); ++row) {
    const Jet turn = unit(2 * std::numbers::pi * straight.time(row), 2 * std::numbers::pi, 0);
    const auto expect_across = [&](const MovingMechanism& yoke, double slope) {
      const auto across = [&](Complex z) { return 50 * (z.real() - slope * z.imag()); };
      const Jet exact{across(turn.z), across(turn.v), across(turn.a)};
      expect_jet(yoke.point("C", row), exact, 50, 2 * std::numbers::pi);
      const auto& guide = yoke.slide("guide", row);
      EXPECT_NEAR(guide.position, exact.z.real(), 1e-12 * 50);
      EXPECT_NEAR(guide.velocity, exact.v.real(), 1e-10 * 50 * 2 * std::numbers::pi);
      EXPECT_NEAR(guide.acceleration, exact.a.real(), 1e-10 * 50 * 4 * std::numbers::pi * std::numbers::pi);
      const double stretch = std::hypot(1, slope);  // 1/sin β
      EXPECT_NEAR(yoke.slide("slot", row).position, 50 * stretch * turn.z.imag(), 1e-12 * 50);
      EXPECT_NEAR(yoke.slide("slot", row).velocity, 50 * stretch * turn.v.imag(),
                  1e-10 * 50 * 2 * std::numbers::pi);
      EXPECT_NEAR(yoke.body("yoke", row).omega, 0, 1e-14);
    };
    expect_across(straight, 0);
    expect_across(inclined, 1 / std::tan(std::numbers::pi / 3));
  }
}

TEST(ExactCurve, OfOldhamsCrossIsACircleOfTwiceTheSpeed) {
  const MovingMechanism coupling("oldham");
  for (std::size_t row = 0; row < coupling.rows(); ++row) {
    const double phi = 2 * std::numbers::pi * coupling.time(row);
    expect_jet(coupling.point("C", row), Complex(15) * unit(2 * phi, 4 * std::numbers::pi, 0) + Jet{15, 0, 0},
               50, 4 * std::numbers::pi);
    EXPECT_NEAR(coupling.body("disc2", row).angle, phi + std::numbers::pi / 2, 1e-12);
    EXPECT_NEAR(coupling.body("disc2", row).omega, 2 * std::numbers::pi, 1e-10);
    EXPECT_NEAR(coupling.body("disc2", row).alpha, 0, 1e-10);
    EXPECT_NEAR(coupling.slide("groove1", row).position, 30 * std::cos(phi), 1e-11);
    EXPECT_NEAR(coupling.slide("groove2", row).position, 30 * std::sin(phi), 1e-11);
  }
}

// Cognates: every coupler curve is drawn by three four-bars (S. Roberts 1875, P. L. Chebyshev 1878).

TEST(ExactCurve, OfHoekensIsThatOfItsCognateByChebyshev) {
  const MovingMechanism hoekens("hoekens"), chebyshev("chebyshev");
  for (std::size_t row = 0; row < hoekens.rows(); ++row) {
    const PointState& p = hoekens.point("P", row);
    expect_jet(chebyshev.point("P", row), {complex(p.position), complex(p.velocity), complex(p.acceleration)},
               100, 2 * std::numbers::pi);
  }
}

/// A four-bar in the file's format: its moving points from the first pivot on are the first link's end, the
/// coupler's end and the coupler's mark M.
std::string four_bar_text(Complex first, Complex second, double crank, double coupler, double rocker,
                          Complex mark, const std::string& drive, double start, Complex sketched_first,
                          Complex sketched_second) {
  return fmt::format(
      R"(format = "oblique-mechanism/1"
[frame]
P = [{}, {}]
Q = [{}, {}]
[bodies]
crank   = {{ points = ["P", "R"], length = {} }}
coupler = {{ points = ["R", "S"], length = {}, marks = {{ M = [{}, {}] }} }}
rocker  = {{ points = ["Q", "S"], length = {} }}
[drives]
drive = {{ {}, speed = 1, start = {} }}
[sketch]
R = [{}, {}]
S = [{}, {}]
)",
      first.real(), first.imag(), second.real(), second.imag(), crank, coupler, mark.real(), mark.imag(),
      rocker, drive, start, sketched_first.real(), sketched_first.imag(), sketched_second.real(),
      sketched_second.imag());
}

// With a + b = d + c for crank, coupler, frame and rocker as vectors and M = A + a + ζ b, the loop times ζ
// and times ζ − 1 are the loops of the other two, on the third pivot E = A + ζ d:
//
//     A, E:  M = A + ζ b + a             link ζ b on A, coupler ζ a, link ζ c on E      its coupler turns as
//                                                                                       the first one's crank
//     E, D:  M = E + (1 − ζ) a + ζ c     crank (1 − ζ) a on E, link (ζ − 1) b on D      with coupler (ζ − 1)
//     c
TEST(ExactCurve, OfTheFourBarIsThatOfBothItsCognates) {
  const MovingMechanism four_bar("four-bar");
  const Complex a_pivot = 0, d_pivot = 4, zeta = Complex(1.75, 1) / 3.5;
  const Complex a = complex(four_bar.point("B", 0).position) - a_pivot,
                b = complex(four_bar.point("C", 0).position) - a_pivot - a,
                c = complex(four_bar.point("C", 0).position) - d_pivot;
  const Complex e_pivot = a_pivot + zeta * d_pivot;
  const double la = 1, lb = 3.5, lc = 3, lz = std::abs(zeta), ly = std::abs(zeta - 1.0);

  const MovingMechanism left(
      parse_mechanism(four_bar_text(a_pivot, e_pivot, lz * lb, lz * la, lz * lc, lz * la / zeta,
                                    R"(turns = "coupler", about = "R")", std::arg(zeta), a_pivot + zeta * b,
                                    e_pivot + zeta * c),
                      "left.toml"));
  // its coupler's vector from the crank's pin is (1 − ζ)(c − …) = (ζ − 1) c, M lies ζ/(ζ − 1) of it along
  const MovingMechanism right(parse_mechanism(
      four_bar_text(e_pivot, d_pivot, ly * la, ly * lc, ly * lb, ly * lc * zeta / (zeta - 1.0),
                    R"(turns = "crank", about = "P")", std::arg(1.0 - zeta), e_pivot + (1.0 - zeta) * a,
                    d_pivot + (zeta - 1.0) * b),
      "right.toml"));
  for (std::size_t row = 0; row < four_bar.rows(); ++row) {
    const PointState& m = four_bar.point("M", row);
    const Jet curve{complex(m.position), complex(m.velocity), complex(m.acceleration)};
    expect_jet(left.point("M", row), curve, 3.5, 1);
    expect_jet(right.point("M", row), curve, 3.5, 1);
  }
}

TEST(ExactCurve, OfRobertsLinkageMeetsItsLineInTheMiddle) {
  const MovingMechanism roberts("roberts");
  for (std::size_t row = 0; row < roberts.rows(); ++row) {
    const double swing = 17 * std::numbers::pi / 180 * std::sin(2 * std::numbers::pi * roberts.time(row));
    EXPECT_NEAR(roberts.drive(row).value, std::acos(25.0 / 60) + swing, 1e-13);
    EXPECT_LT(std::abs(roberts.point("P", row).position.y()), 0.683);
  }
  for (const std::size_t row : {0U, 180U, 360U}) {
    EXPECT_NEAR(roberts.point("P", row).position.x(), 50, 1e-10);
    EXPECT_NEAR(roberts.point("P", row).position.y(), 0, 1e-10);
  }
}

// Next to a point of change roundings grow with every derivative by 1/sin φ, up to 1.5e6 ε for the
// acceleration.
TEST(ExactCurve, OfTheParallelogramGoesStraightThroughItsPointsOfChange) {
  const MovingMechanism parallelogram("parallelogram");
  for (std::size_t row = 0; row < parallelogram.rows(); ++row) {
    const double phi = 60.5 * std::numbers::pi / 180 + 2 * std::numbers::pi * parallelogram.time(row);
    const double slack = std::max(1.0, 1e-5 / std::abs(std::pow(std::sin(phi), 3)));
    const Jet turn = Complex(40) * unit(phi, 2 * std::numbers::pi, 0);
    expect_jet(parallelogram.point("M", row), turn + Jet{40, 0, 0}, 80, 2 * std::numbers::pi, slack);
    expect_jet(parallelogram.point("C", row), turn + Jet{80, 0, 0}, 80, 2 * std::numbers::pi, slack);
  }
  ASSERT_EQ(parallelogram.motion.events.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    const MotionEvent& event = parallelogram.motion.events[i];
    EXPECT_EQ(event.kind, MotionEvent::Kind::change);
    EXPECT_NEAR(2 * std::numbers::pi * event.time,
                (119.5 + 180 * static_cast<double>(i)) * std::numbers::pi / 180, 1e-9);
  }
}

// The source's program: theta3, b, xB, xP in 361 positions (Valsamos 2024, eqs. 10, 13, 16).
TEST(ExactCurve, OfTheThreeBarFollowsTheSourcesFormulas) {
  const MovingMechanism three_bar("three-bar");
  const double a = 100, d = 150, p = 300;
  ASSERT_EQ(three_bar.rows(), 361U);
  for (std::size_t row = 0; row < three_bar.rows(); ++row) {
    const double theta2 = static_cast<double>(row) * std::numbers::pi / 180;
    const double theta3 = std::atan2(-a * std::sin(theta2), d - a * std::cos(theta2));
    const double b = (d - a * std::cos(theta2)) / std::cos(theta3);
    const Complex b_point = std::polar(a, theta2), p_point = b_point + std::polar(p, theta3);
    EXPECT_NEAR(three_bar.body("BP", row).angle, theta3, 1e-13);
    EXPECT_NEAR(three_bar.slide("b", row).position, b, 1e-12 * p);
    EXPECT_LT(std::abs(complex(three_bar.point("B", row).position) - b_point), 1e-13 * p);
    EXPECT_LT(std::abs(complex(three_bar.point("P", row).position) - p_point), 1e-12 * p);
  }
}

// The source's classes I_Rod and RRR_II_RodGroup (Linkages in Python), in mm and s throughout.
void expect_six_bar(const std::string& name, double side) {
  const MovingMechanism six_bar(name);
  const double bc = 140, cd = 150, omega = 100, arm = std::hypot(50, 45), arm_angle = std::atan2(45, 50);
  const Complex d_point = 200;
  for (std::size_t row = 0; row < six_bar.rows(); ++row) {
    const Jet b = Complex(80) * unit(static_cast<double>(row) * std::numbers::pi / 180, omega, 0);
    // position of the dyad BCD
    const Complex to_d = d_point - b.z;
    const double a_coefficient = 2 * bc * to_d.real(), b_coefficient = 2 * bc * to_d.imag(),
                 c_coefficient = bc * bc + std::norm(to_d) - cd * cd;
    const double root = std::sqrt(a_coefficient * a_coefficient + b_coefficient * b_coefficient -
                                  c_coefficient * c_coefficient);
    const double phi1 = 2 * std::atan((b_coefficient + side * root) / (a_coefficient + c_coefficient));
    const Complex e1 = std::polar(bc, phi1), c_point = b.z + e1, e2 = c_point - d_point;
    // velocity and acceleration
    const double g = e1.real() * e2.imag() - e2.real() * e1.imag();
    const double omega1 = -(e2.real() * b.v.real() + e2.imag() * b.v.imag()) / g,
                 omega2 = -(e1.real() * b.v.real() + e1.imag() * b.v.imag()) / g;
    const Complex sum = -b.a + omega1 * omega1 * e1 - omega2 * omega2 * e2;
    const double alpha1 = (sum.real() * e2.real() + sum.imag() * e2.imag()) / g;
    expect_jet(six_bar.point("F", row), b + Complex(arm) * unit(phi1 + arm_angle, omega1, alpha1), 200,
               omega);
    EXPECT_NEAR(six_bar.body("CD", row).omega, omega2, 1e-10 * omega);
  }
}

// The source's program takes the root with −.
TEST(ExactCurve, OfTheSixBarFollowsTheSourcesFormulas) {
  expect_six_bar("six-bar", -1);
  expect_six_bar("six-bar-above", 1);
}

/// The seed's vector transformation: `r` turned by `angle` and brought to `length`.
Complex turned(Complex r, double angle, double length) {
  return r * std::polar(length / std::abs(r), angle);
}

/// The angle between the sides l1 and l2 of a triangle.
double corner(double l1, double l2, double l3) {
  return std::acos((l1 * l1 + l2 * l2 - l3 * l3) / (2 * l1 * l2));
}

// The source's chain of vector transformations (Ihnatyshyn et al.), by its lengths a … m.
TEST(ExactCurve, OfJansensFootFollowsTheSourcesTransformations) {
  const MovingMechanism jansen("jansen");
  const double b = 41.5, c = 39.3, d = 40.1, e = 55.8, f = 39.4, g = 36.7, h = 65.7, i = 49, j = 50, k = 61.9,
               m = 15;
  const Complex o2(-38, -7.8);
  for (std::size_t row = 0; row < jansen.rows(); ++row) {
    const Complex p1 = std::polar(m, static_cast<double>(row) * std::numbers::pi / 180);
    const Complex to_o2 = o2 - p1;
    const Complex p2 = p1 + turned(to_o2, -corner(std::abs(to_o2), j, b), j);
    const Complex p3 = o2 + turned(p2 - o2, corner(b, d, e), d);
    const Complex p6 = p1 + turned(to_o2, corner(std::abs(to_o2), k, c), k);
    const Complex to_p6 = p6 - p3;
    const Complex p4 = p3 + turned(to_p6, -corner(std::abs(to_p6), f, g), f);
    const Complex p5 = p4 + turned(p6 - p4, -corner(g, h, i), h);
    const auto expect_at = [&](const char* name, Complex exact) {
      EXPECT_LT(std::abs(complex(jansen.point(name, row).position) - exact), 1e-12 * h)
          << name << ", row " << row;
    };
    expect_at("P2", p2);
    expect_at("P3", p3);
    expect_at("P6", p6);
    expect_at("P4", p4);
    expect_at("P5", p5);
    // the second leg is the first one half a turn of the crank later
    expect_at("Q5", complex(jansen.point("P5", (row + 180) % 360).position));
  }
}

// The reference solution of the test problem after 0.03 s (Test Set for IVP Solvers; F. Mazzia and C.
// Magherini): with its β and β̇ all other angles and rates must follow.
TEST(ExactCurve, OfAndrewsSqueezerMeetsTheReferenceSolution) {
  const double beta = 15.81077119629904, beta_rate = 1139.920302151208;
  MovingMechanism squeezer("andrews-squeezer");
  const double time = (beta - squeezer.mechanism.drives[0].start) / squeezer.mechanism.drives[0].speed;
  squeezer.motion = solve_motion(squeezer.mechanism, std::array{0.0, time});
  struct Reference {
    const char* body;
    double angle, rate;
  };
  // θ: K2 points from R to P against the source's, so half a turn more; γ, Φ, Ω + ε, ε are measured from −y
  const double theta = -15.75637105984298, gamma = 0.04082224013073101, phi = -0.5347301163226948,
               delta = 0.5244099658805304, omega = 0.5347301163226948, epsilon = 1.048080741042263;
  const double theta_rate = -1424.379294994111, gamma_rate = 11.03291221937134, phi_rate = 19.29337464421385,
               delta_rate = 0.5735699284790808, omega_rate = -19.29337464421385,
               epsilon_rate = 0.3231791658026955;
  for (const Reference& reference :
       {Reference{"K2", beta + theta + std::numbers::pi, beta_rate + theta_rate},
        Reference{"K3", gamma - std::numbers::pi / 2, gamma_rate},
        Reference{"K4", phi + delta - std::numbers::pi / 2, phi_rate + delta_rate},
        Reference{"K5", delta, delta_rate}, Reference{"K6", omega + epsilon, omega_rate + epsilon_rate},
        Reference{"K7", epsilon - std::numbers::pi / 2, epsilon_rate}}) {
    const BodyState& ours = squeezer.body(reference.body, 1);
    // the reference was integrated to 14 digits; of an equation of index 3 its velocities keep fewer
    EXPECT_NEAR(std::remainder(ours.angle - reference.angle, 2 * std::numbers::pi), 0, 1e-12)
        << reference.body;
    EXPECT_NEAR(ours.omega / 100, reference.rate / beta_rate, 1e-10) << reference.body;
  }
}

// cos φ = (60² + 100² − 150²)/(2·60·100) at both limits.
TEST(ExactCurve, OfTheDoubleRockerEndsAtItsLimits) {
  const MovingMechanism rocker("double-rocker");
  const double limit = std::acos(-8900.0 / 12000);
  for (std::size_t row = 0; row < rocker.rows(); ++row) {
    const double angle = std::numbers::pi / 6 + 2 * std::numbers::pi * rocker.time(row);
    const bool reaches = angle < limit || angle > 2 * std::numbers::pi - limit;
    EXPECT_EQ(rocker.motion.configurations[row].status, reaches ? Status::ok : Status::open) << "row " << row;
  }
  ASSERT_EQ(rocker.motion.events.size(), 2U);
  EXPECT_EQ(rocker.motion.events[0].kind, MotionEvent::Kind::limit);
  EXPECT_EQ(rocker.motion.events[1].kind, MotionEvent::Kind::return_);
  EXPECT_NEAR(std::numbers::pi / 6 + 2 * std::numbers::pi * rocker.motion.events[0].time, limit, 1e-9);
  EXPECT_NEAR(std::numbers::pi / 6 + 2 * std::numbers::pi * rocker.motion.events[1].time,
              2 * std::numbers::pi - limit, 1e-9);
}

TEST(ExactCurve, OfTheToggleClampStandsStillWhereItIsLocked) {
  const MovingMechanism clamp("toggle-clamp");
  const std::size_t locked = 90;
  EXPECT_NEAR(clamp.drive(locked).value, std::numbers::pi / 6, 1e-13);
  EXPECT_NEAR(clamp.body("arm", locked).angle, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(clamp.body("arm", locked).omega, 0, 1e-10);
  for (std::size_t row = 0; row < clamp.rows(); ++row)
    EXPECT_LE(clamp.point("P", locked).position.y(), clamp.point("P", row).position.y() + 1e-12);
}

// s² = |AD|² + |DC|² − 2 |AD||DC| cos ψ
TEST(ExactCurve, OfTheTipperFulfilsTheCosineRule) {
  const MovingMechanism tipper("hydraulic-tipper");
  for (std::size_t row = 0; row < tipper.rows(); ++row) {
    const double t = tipper.time(row);
    const double s = 1.2 + 0.5 * std::sin(t / 4), s1 = 0.125 * std::cos(t / 4), s2 = -std::sin(t / 4) / 32;
    const double k = 2 * 1.2 * 1.5, cosine = (1.44 + 2.25 - s * s) / k, sine = std::sqrt(1 - cosine * cosine);
    const double omega = 2 * s * s1 / (k * sine);
    const double alpha = (2 * (s1 * s1 + s * s2) / k - cosine * omega * omega) / sine;
    EXPECT_NEAR(tipper.drive(row).value, s, 1e-13);
    EXPECT_NEAR(tipper.slide("ram", row).position, s, 1e-12);
    EXPECT_NEAR(tipper.slide("ram", row).velocity, s1, 1e-10);
    EXPECT_NEAR(tipper.slide("ram", row).acceleration, s2, 1e-10);
    EXPECT_NEAR(tipper.body("bed", row).angle, std::acos(cosine), 1e-12);
    EXPECT_NEAR(tipper.body("bed", row).omega, omega, 1e-11);
    EXPECT_NEAR(tipper.body("bed", row).alpha, alpha, 1e-11);
  }
}

}  // namespace
}  // namespace oblique::mechanism
