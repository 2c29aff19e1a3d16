// SPDX-License-Identifier: MIT
#include <oblique/mechanism/analysis/analysis.h>
#include <oblique/mechanism/structure/structure.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "analysed.h"

namespace oblique::mechanism {
namespace {

using namespace analysed;

double angle_opposite(double opposite, double a, double b) {
  return std::acos((a * a + b * b - opposite * opposite) / (2 * a * b));
}

TEST(Transmission, ExtremesOfAFourBarAreWhereCrankAndFrameLieOnALine) {
  const MechanismAnalysis analysis = analysis_of(four_bar(1, 3.5, 3, 4, "17 deg"));
  ASSERT_EQ(analysis.transmissions.size(), 1U);
  const Transmission& t = analysis.transmissions.front();
  EXPECT_EQ(t.measure, Transmission::Measure::transmission_angle);
  EXPECT_NEAR(t.least.value, angle_opposite(4 - 1, 3.5, 3), 1e-12);
  EXPECT_NEAR(t.greatest.value, angle_opposite(4 + 1, 3.5, 3), 1e-12);
  EXPECT_NEAR(t.least.drive, 2 * kPi, kExact);  // from 17° on, the next time
  EXPECT_NEAR(t.greatest.drive, kPi, kExact);
  EXPECT_FALSE(t.is_poor());
  EXPECT_TRUE(analysis_of(four_bar(2.3, 3.5, 3.4, 4)).transmissions.front().is_poor());
}

// At a limit the places go as the square of the time to it; `rate` is the derivative of `time`, here by
// differences, which err by the step's square and by 1e-16 over it.
TEST(MotionRange, HasSmoothPlacesUpToItsLimits) {
  for (const bool from_limit : {false, true}) {
    for (const bool at_limit : {false, true}) {
      MotionRange motion_range;
      motion_range.begin = 1;
      motion_range.end = 3;
      motion_range.from_limit = from_limit;
      motion_range.at_limit = at_limit;
      EXPECT_EQ(motion_range.time(0), 1);
      EXPECT_EQ(motion_range.time(1), 3);
      const double third = from_limit && at_limit ? 0.25
                           : from_limit           ? 1.0 / 9
                           : at_limit             ? 5.0 / 9
                                                  : 1.0 / 3;
      EXPECT_NEAR(motion_range.time(1.0 / 3), 1 + 2 * third, 1e-15);
      constexpr double kStep = 1e-5;
      for (const double u : {0.1, 0.35, 0.5, 0.8}) {
        EXPECT_NEAR(motion_range.rate(u),
                    (motion_range.time(u + kStep) - motion_range.time(u - kStep)) / (2 * kStep), 1e-8)
            << u;
      }
    }
  }
}

// A parallelogram A-B-C-D that a crank about H moves by a coupler to F of BC: F goes round (20, 30) as B
// round A, so that they are a four-bar. Where the parallelogram lies flat, at 132.87°, its modes meet and it
// goes on. Its determinant is at most 0.07 before that, so it is a dead centre, where nothing has a rate, for
// a longer way than of other triads: the motion was lost there, and what came after was left out without a
// word.
TEST(Swings, OfATriadGoOnBeyondAFlatParallelogram) {
  const MechanismAnalysis analysis = analysis_of(parse_mechanism(R"toml(format = "oblique-mechanism/1"
[units]
length = "mm"
[frame]
A = [0, 0]
D = [80, 0]
H = [150, 60]
[bodies]
HG = { points = ["H", "G"], length = 30 }
FG = { points = ["F", "G"], length = 82.9113732680986 }
BC = { points = ["B", "C"], length = 80, marks = { F = [20, 30] } }
AB = { points = ["A", "B"], length = 45 }
DC = { points = ["D", "C"], length = 45 }
[drives]
crank = { turns = "HG", about = "H", speed = "1 rad/s", start = "120 deg" }
[sketch]
G = [134.99531, 85.979541]
F = [60.77697, 49.01577]
B = [40.776468, 19.015017]
C = [120.77848, 19.015017]
)toml",
                                                                 "flat.toml"));
  const auto ab = std::find_if(analysis.swings.begin(), analysis.swings.end(),
                               [](const Sweep& swing) { return !swing.is_slide && swing.index == 3; });
  ASSERT_NE(ab, analysis.swings.end());
  // Least where crank and coupler lie on one line, stretched.
  const double ground = std::hypot(130, 30);
  const double least = std::atan2(30, 130) - angle_opposite(82.9113732680986 + 30, ground, 45);
  EXPECT_NEAR(ab->least.value, least, kExact);
}

TEST(Transmission, IsPoorBeyondWhatTextbooksAllow) {
  Transmission angle;
  angle.measure = Transmission::Measure::transmission_angle;
  const auto is_poor = [&](double least, double greatest) {
    angle.least.value = least;
    angle.greatest.value = greatest;
    return angle.is_poor();
  };
  EXPECT_FALSE(is_poor(kPi / 6, kPi - kPi / 6));  // 30° and 150° are still allowed
  EXPECT_TRUE(is_poor(kPi / 6 - 1e-9, kPi / 2));
  EXPECT_TRUE(is_poor(kPi / 2, kPi - kPi / 6 + 1e-9));
  angle.measure = Transmission::Measure::pressure_angle;
  EXPECT_FALSE(is_poor(0, kPi / 2 - kPi / 6));
  EXPECT_TRUE(is_poor(0, kPi / 2 - kPi / 6 + 1e-9));
  angle.measure = Transmission::Measure::determinant;
  EXPECT_FALSE(is_poor(0, 1));
}

// sin 2πu' with u' = u + 0.1137 has its top at u' = 1/4 and its bottom at 3/4.
TEST(Scan, RefinesTheExtremesOfASignalWithoutARate) {
  const Mechanism crank = four_bar(1, 3.5, 3, 4);
  const Structure structure = decompose(crank);
  RangeWalk walk(crank, structure, plan_motion_range(crank, structure));
  Signal wave;
  wave.has_rate = false;
  wave.at = [](const RangeWalk& at) {
    return SignalValue{std::sin(2 * kPi * (at.place() + 0.1137)), std::nan("")};
  };
  const SignalScan found = scan(walk, {wave}).front();
  // u to 1e-8, as promised; that moves the value by (2π·1e-8)²/2 = 2e-15 and a rounding
  EXPECT_NEAR(found.greatest.place, 0.25 - 0.1137, 1e-7);
  EXPECT_NEAR(found.greatest.value, 1, 1e-14);
  EXPECT_NEAR(found.least.place, 0.75 - 0.1137, 1e-7);
  EXPECT_NEAR(found.least.value, -1, 1e-14);
}

// The rate (u − 1/2)² − (w/2)² is below zero for a width w of the range: the value falls by w³/6 there, 2e-11
// for the narrower and 2e-4 for the wider one. Less than 1e-10 is rounding, also where nothing turned before.
TEST(Scan, LeavesOutTurningPointsOfRoundingThatComeFirst) {
  const Mechanism crank = four_bar(1, 3.5, 3, 4);
  const Structure structure = decompose(crank);
  const MotionRange turn = plan_motion_range(crank, structure);
  ASSERT_EQ(turn.samples % 4, 0U);  // one stands at 1/4 and at 1/2
  RangeWalk walk(crank, structure, turn);
  const auto turns_of = [&](const std::function<double(double)>& value,
                            const std::function<double(double)>& slope) {
    Signal signal;
    signal.at = [&](const RangeWalk& at) {
      return SignalValue{value(at.place()), slope(at.place()) / turn.duration()};
    };
    return scan(walk, {signal}).front().turns.size();
  };
  for (const auto& [width, turns] : {std::pair(5e-4, 0U), {0.1, 2U}}) {
    const double half = width / 2;
    EXPECT_EQ(turns_of([&](double u) { return std::pow(u - 0.5, 3) / 3 - half * half * u; },
                       [&](double u) { return (u - 0.5) * (u - 0.5) - half * half; }),
              turns);
  }
}

// The rod leans most where the pin is farthest from the guide.
TEST(Transmission, PressureAngleOfASliderCrank) {
  const Transmission t = analysis_of(slider_crank(40)).transmissions.front();
  EXPECT_EQ(t.measure, Transmission::Measure::pressure_angle);
  EXPECT_NEAR(t.greatest.value, std::asin((50.0 + 40) / 150), 1e-12);
  EXPECT_NEAR(t.greatest.drive, 1.5 * kPi, kExact);
  EXPECT_NEAR(t.least.value, 0, 1e-9);
}

TEST(Sweep, RockerOfACrankRockerHasItsEndsWhereCrankAndCouplerLieOnALine) {
  const MechanismAnalysis analysis = analysis_of(four_bar(1, 3.5, 3, 4));
  const Sweep& rocker = analysis.swings.at(1);
  EXPECT_EQ(rocker.kind, Sweep::Kind::oscillates);
  EXPECT_EQ(rocker.reversals, 2U);
  // |AC| = 3.5 ± 1; the angle of the rocker from D, seen from C: turned by π
  const double out = angle_opposite(4.5, 4, 3), in = angle_opposite(2.5, 4, 3);
  EXPECT_NEAR(rocker.greatest.value, -in, 1e-12);
  EXPECT_NEAR(rocker.least.value, -out, 1e-12);
  const double at_out = angle_opposite(3, 4, 4.5), at_in = angle_opposite(3, 4, 2.5) + kPi;
  EXPECT_NEAR(rocker.least.drive, at_out, kExact);
  EXPECT_NEAR(rocker.greatest.drive, at_in, kExact);
  EXPECT_NEAR(rocker.rising, at_in - at_out, kExact);
  EXPECT_NEAR(rocker.time_ratio.value(), (at_in - at_out) / (2 * kPi - at_in + at_out), kExact);
}

// (180° + 2α)/(180° − 2α) with sin α = |AB|/|AD|.
TEST(Sweep, CrankShaperReturnsQuickly) {
  const Mechanism shaper = mechanism(R"([frame]
A = [0, 300]
D = [0, 0]
[bodies]
AB    = { points = ["A", "B"], length = 100 }
lever = { points = ["D", "E"], length = 500 }
[slides]
slot = { point = "B", along = ["D", "E"] }
[drives]
crank = { turns = "AB", about = "A", speed = "60 rpm" }
[sketch]
E = [158, 474]
)");
  const MechanismAnalysis analysis = analysis_of(shaper);
  const double alpha = std::asin(1.0 / 3);
  const Sweep& lever = analysis.swings.at(0);
  EXPECT_NEAR(lever.time_ratio.value(), (kPi + 2 * alpha) / (kPi - 2 * alpha), kExact);
  EXPECT_NEAR(lever.stroke(), 2 * alpha, 1e-12);
  EXPECT_NEAR(lever.rising, (kPi + 2 * alpha) / (2 * kPi), kExact);
  const Sweep& slot = analysis.swings.at(1);
  EXPECT_TRUE(slot.is_slide);
  EXPECT_NEAR(slot.least.value, 200, 1e-9);
  EXPECT_NEAR(slot.greatest.value, 400, 1e-9);
  EXPECT_EQ(analysis.sliders.at(0).type, SliderLoop::Type::lever_swings);
  EXPECT_EQ(analysis.transmissions.at(0).measure, Transmission::Measure::determinant);
}

TEST(Sweep, StrokeOfAnOffsetSliderCrank) {
  const Sweep piston = analysis_of(slider_crank(40)).swings.at(1);
  EXPECT_NEAR(piston.greatest.value, std::sqrt(200.0 * 200 - 40 * 40), 1e-10);
  EXPECT_NEAR(piston.least.value, std::sqrt(100.0 * 100 - 40 * 40), 1e-10);
  EXPECT_NEAR(piston.greatest.drive, std::asin(40.0 / 200), kExact);
  EXPECT_NEAR(piston.least.drive, kPi + std::asin(40.0 / 100), kExact);
  const double delta = std::asin(40.0 / 100) - std::asin(40.0 / 200);
  EXPECT_NEAR(piston.time_ratio.value(), (kPi + delta) / (kPi - delta), kExact);
}

// The start is an end of the swing: there the turning point lies at both ends of the turn.
TEST(Sweep, ThatBeginsAtItsEndIsCountedOnce) {
  const Sweep piston = analysis_of(slider_crank(0)).swings.at(1);
  EXPECT_EQ(piston.reversals, 2U);
  EXPECT_NEAR(piston.time_ratio.value(), 1, kExact);
  EXPECT_NEAR(piston.stroke(), 100, 1e-10);
}

TEST(Sweep, TellsTurningFromSwingingAndRest) {
  const MechanismAnalysis drag_link = analysis_of(four_bar(3, 3.5, 3, 1, "0 deg", "[0, 2]"));
  EXPECT_EQ(drag_link.swings.at(1).kind, Sweep::Kind::turns);
  EXPECT_NEAR(drag_link.swings.at(1).gain, 2 * kPi, 1e-12);
  const MechanismAnalysis parallel = analysis_of(four_bar(1, 3, 1, 3, "60.5 deg", "[3.5, 1]"));
  EXPECT_EQ(parallel.swings.at(0).kind, Sweep::Kind::stationary);
  EXPECT_EQ(parallel.swings.at(1).kind, Sweep::Kind::turns);
  EXPECT_EQ(parallel.motion_range->changes.size(), 2U);
}

// sin⁷ φ is within ±0.01, a hundredth of its stroke, while |φ| < asin(0.01^(1/7)), about 0 and about 180°;
// about its ends it stays for 2·2·acos(0.98^(1/7)) = 17° only.
TEST(Dwell, IsFoundWhereverItLies) {
  const Mechanism four = four_bar(1, 3.5, 3, 4);
  const Structure structure = decompose(four);
  const RangeWalk walk(four, structure, plan_motion_range(four, structure));
  std::vector<double> values;
  const std::size_t samples = walk.motion_range().samples;
  for (std::size_t k = 0; k <= samples; ++k) {
    values.push_back(std::pow(std::sin(2 * kPi * static_cast<double>(k) / static_cast<double>(samples)), 7));
  }
  const auto dwells = find_dwells(walk, {&values}, 2);
  ASSERT_EQ(dwells.size(), 2U);
  const double half = std::asin(std::pow(0.01, 1.0 / 7));
  // a band that lies a little aside gives a stretch that is as long, within the samples
  const double degree = kPi / 180;
  for (const auto& [dwell, middle] : {std::pair{dwells[0], kPi}, std::pair{dwells[1], 2 * kPi}}) {
    EXPECT_NEAR(dwell.end_drive - dwell.begin_drive, 2 * half, degree / 2);
    EXPECT_NEAR((dwell.begin_drive + dwell.end_drive) / 2, middle, 1.5 * degree);
  }
}

TEST(Dwell, HarmonicMotionHasNone) {
  const Mechanism four = four_bar(1, 3.5, 3, 4);
  const Structure structure = decompose(four);
  const RangeWalk walk(four, structure, plan_motion_range(four, structure));
  std::vector<double> values;
  for (std::size_t k = 0; k <= walk.motion_range().samples; ++k)
    values.push_back(
        std::cos(2 * kPi * static_cast<double>(k) / static_cast<double>(walk.motion_range().samples)));
  EXPECT_TRUE(find_dwells(walk, {&values}, 2).empty());
}

// 60 + 100 > 70 + 80: the left rocker comes to rest where |BD| = 70 + 80.
TEST(Range, LimitsOfADoubleRockerFollowFromTheLawOfCosines) {
  const MechanismAnalysis analysis = analysis_of(four_bar(60, 70, 80, 100, "30 deg", "[100, 80]"));
  const double limit = angle_opposite(150, 60, 100);
  const MotionRange& motion_range = *analysis.motion_range;
  EXPECT_EQ(motion_range.kind, MotionRange::Kind::limits);
  EXPECT_FALSE(motion_range.closed);
  EXPECT_NEAR(motion_range.range.forward->time + kPi / 6, limit, 1e-9);
  EXPECT_NEAR(motion_range.range.backward->time + kPi / 6, -limit, 1e-9);
  // at a limit the velocities are infinite, and positions known to the root of its sharpness
  const Sweep& right = analysis.swings.at(1);
  EXPECT_NEAR(right.greatest.value, angle_opposite(60, 100, 150), 1e-5);
  EXPECT_EQ(right.kind, Sweep::Kind::oscillates);
  EXPECT_FALSE(right.time_ratio);
  EXPECT_NEAR(analysis.paths.at(0).measure.length, 60 * 2 * limit, 1e-6);
}

// A is moved along a line, B on another square to it; driven by A it comes to rest where the bar lies on A's.
TEST(Range, OfADriveThatMovesASlide) {
  const MechanismAnalysis analysis = analysis_of(mechanism(R"([frame]
O = [0, 0]
X = [100, 0]
Y = [0, 100]
[bodies]
bar = { points = ["A", "B"], length = 120 }
[slides]
across = { point = "A", along = ["O", "X"] }
up     = { point = "B", along = ["O", "Y"] }
[drives]
block = { slides = "across", speed = 10, start = 30 }
[sketch]
B = [0, 110]
)"));
  EXPECT_NEAR(analysis.motion_range->range.forward->time, 9, 1e-9);
  EXPECT_NEAR(analysis.motion_range->range.backward->time, -15, 1e-9);
  EXPECT_NEAR(analysis.swings.at(1).greatest.value, 120, 1e-9);
}

/// Perimeter of an ellipse by the arithmetic-geometric mean (C. F. Gauss, A.-M. Legendre).
double perimeter(double a, double b) {
  double x = a, y = b, power = 1, sum = (a * a + b * b) / 2;
  while (std::abs(x - y) > 1e-15 * a) {
    const double c = (x - y) / 2;
    sum -= power * c * c;
    power *= 2;
    std::tie(x, y) = std::pair((x + y) / 2, std::sqrt(x * y));
  }
  return 2 * kPi * sum / x;
}

TEST(Path, OfATrammelIsAnEllipse) {
  const MechanismAnalysis analysis = analysis_of(mechanism(R"([frame]
O = [0, 0]
X = [100, 0]
Y = [0, 100]
[bodies]
bar = { points = ["A", "B"], length = 120, marks = { M = [60, 0], P = [200, 0] } }
[slides]
across = { point = "A", along = ["O", "X"] }
up     = { point = "B", along = ["O", "Y"] }
[drives]
turn = { turns = "bar", about = "A", speed = "60 rpm", start = "10 deg" }
)"));
  ASSERT_EQ(analysis.paths.size(), 4U);
  const PathReport& a = analysis.paths.at(0);
  EXPECT_NEAR(a.measure.length, 480, 1e-7);  // to and fro on a line, with two corners
  EXPECT_NEAR(a.measure.area.value(), 0, 1e-7);
  const PathReport& m = analysis.paths.at(2);
  EXPECT_NEAR(m.measure.length, 2 * kPi * 60, 1e-7);
  const PathReport& p = analysis.paths.at(3);
  EXPECT_NEAR(p.measure.length, perimeter(200, 80), 1e-7);
  EXPECT_NEAR(std::abs(p.measure.area.value()), kPi * 200 * 80, 1e-6);
  EXPECT_NEAR(p.right.value, 80, 1e-10);
  EXPECT_NEAR(p.bottom.value, -200, 1e-10);
}

TEST(Path, OfARockerIsAnArcThereAndBack) {
  const MechanismAnalysis analysis = analysis_of(four_bar(1, 3.5, 3, 4));
  const PathReport& b = analysis.paths.at(0);
  EXPECT_NEAR(b.measure.length, 2 * kPi, 1e-9);
  EXPECT_NEAR(b.measure.area.value(), kPi, 1e-9);
  const double swing = angle_opposite(4.5, 4, 3) - angle_opposite(2.5, 4, 3);
  EXPECT_NEAR(analysis.paths.at(1).measure.length, 2 * 3 * swing, 1e-9);
}

}  // namespace
}  // namespace oblique::mechanism
