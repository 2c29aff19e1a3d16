// SPDX-License-Identifier: MIT
// Random triads against a scan that shares no code with the solver. OBLIQUE_TRIADS sets how many of a kind
// are tried, for a longer run than the usual one.
#include <oblique/mechanism/triad/triad.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <numbers>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "triad_scan.h"

namespace oblique::mechanism {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using LegKind = Leg::Kind;

int number_of_triads(int usual) {
  const char* wanted = std::getenv("OBLIQUE_TRIADS");
  return wanted != nullptr ? std::stoi(wanted) : usual;
}

Vector2d quarter_turn_of(const Vector2d& v) {
  return {-v.y(), v.x()};
}

/// Random numbers that are the same everywhere, which those of <random>'s distributions are not.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  Vector2d point() { return {between(-1, 1), between(-1, 1)}; }
  Vector2d direction() {
    const double angle = between(-std::numbers::pi, std::numbers::pi);
    return {std::cos(angle), std::sin(angle)};
  }
  bool even() { return (engine_() & 1U) != 0; }

 private:
  std::mt19937_64 engine_;
};

/// Random points for three legs of the given kinds.
struct Sketch {
  std::array<LegKind, 3> kinds{};
  std::array<Vector2d, 3> locals, anchors, directions;
};

Sketch random_sketch(Dice& dice, const std::array<LegKind, 3>& kinds) {
  Sketch sketch;
  sketch.kinds = kinds;
  for (std::size_t i = 0; i < 3; ++i) {
    sketch.locals[i] = dice.point();
    sketch.anchors[i] = dice.point();
    sketch.directions[i] = dice.direction();
  }
  return sketch;
}

PlatformPose random_pose(Dice& dice) {
  const Vector2d direction = dice.direction();
  return {dice.point(), direction.x(), direction.y()};
}

/// Legs that close in `pose`: lengths are measured there, lines moved there.
std::array<Leg, 3> closed_in(const Sketch& sketch, const PlatformPose& pose) {
  const Matrix2d turn = (Matrix2d() << pose.cosine, -pose.sine, pose.sine, pose.cosine).finished();
  std::array<Leg, 3> legs;
  for (std::size_t i = 0; i < 3; ++i) {
    Leg& leg = legs[i];
    leg = {sketch.kinds[i], sketch.locals[i], sketch.anchors[i], sketch.directions[i], 0};
    const Vector2d offset = pose.position + turn * leg.local - leg.anchor;
    const Vector2d normal = quarter_turn_of(leg.direction);
    if (leg.kind == LegKind::circle) leg.length = offset.norm();
    if (leg.kind == LegKind::fixed_line) leg.anchor += normal * normal.dot(offset);
    if (leg.kind == LegKind::platform_line) leg.local -= normal * normal.dot(turn.transpose() * offset);
  }
  return legs;
}

std::string listing(const std::array<Leg, 3>& legs) {
  std::string text;
  for (const Leg& leg : legs) {
    char line[400];
    std::snprintf(line, sizeof line,
                  "kind %d local %.17g %.17g anchor %.17g %.17g direction %.17g %.17g length %.17g\n",
                  static_cast<int>(leg.kind), leg.local.x(), leg.local.y(), leg.anchor.x(), leg.anchor.y(),
                  leg.direction.x(), leg.direction.y(), leg.length);
    text += line;
  }
  return text;
}

double distance(const PlatformPose& a, const PlatformPose& b) {
  return (a.position - b.position).norm() + std::hypot(a.cosine - b.cosine, a.sine - b.sine);
}

bool found_by(const PlatformModes& modes, const PlatformPose& pose) {
  return std::any_of(modes.poses.begin(), modes.poses.begin() + modes.count, [&](const PlatformPose& mode) {
    // a zero that bisection leaves at 1e-16 is off by that over its slope
    return distance(mode, pose) < 1e-6 * (1 + pose.position.norm());
  });
}

/// Where nearly parallel lines meet, neither the solver nor the scan knows the place well.
bool is_far(const PlatformPose& pose) {
  return !(pose.position.norm() < 1e3);
}

/// Says what is wrong with the modes, "" for nothing.
std::string complaint(const std::array<Leg, 3>& legs, const PlatformModes& modes) {
  if (modes.movable) return "movable";
  for (std::size_t i = 0; i < static_cast<std::size_t>(modes.count); ++i) {
    // nearly parallel lines meet far out, where coordinates round by more
    if (!(closing_error(legs, modes.poses[i]) < 1e-10 * (1 + modes.poses[i].position.norm())))
      return "a mode does not close";
    for (std::size_t j = 0; j < i; ++j) {
      if (distance(modes.poses[i], modes.poses[j]) < 1e-8) return "a mode is named twice";
    }
  }
  std::string wrong;
  for (const int steps : {256, 16384}) {  // the finer scan only where the coarse one does not agree
    const std::vector<PlatformPose> scanned = scan_poses(legs, steps);
    wrong.clear();
    int closing = 0;
    for (const PlatformPose& pose : scanned) {
      if (is_far(pose) || closing_error(legs, pose) > 1e-8) continue;  // parallel lines cross nowhere
      ++closing;
      if (!found_by(modes, pose)) wrong = "a mode is missed";
    }
    const auto found =
        modes.count - std::count_if(modes.poses.begin(), modes.poses.begin() + modes.count, is_far);
    if (wrong.empty() && closing != found)
      wrong = "the scan counts " + std::to_string(closing) + ", the solver " + std::to_string(found);
    if (wrong.empty()) return "";
  }
  return wrong;
}

using Shape = std::function<void(Dice&, Sketch&)>;

/// Tries random triads; every second is built about a known pose, the others may have none.
void expect_all_found(unsigned seed, int number, const std::array<LegKind, 3>& kinds, const Shape& shape) {
  Dice dice(seed);
  std::array<int, 9> counts{};
  int complaints = 0;
  for (int i = 0; i < number && complaints < 5; ++i) {
    Sketch sketch = random_sketch(dice, kinds);
    shape(dice, sketch);
    const PlatformPose pose = random_pose(dice);
    std::array<Leg, 3> legs = closed_in(sketch, pose);
    const bool built = i % 2 == 0;
    if (!built) {
      for (Leg& leg : legs) leg.length *= dice.between(0.7, 1.4);
    }
    const PlatformModes modes = platform_modes(legs);
    ++counts[static_cast<std::size_t>(modes.count)];
    std::string wrong = complaint(legs, modes);
    const bool three_circles = kinds == std::array{LegKind::circle, LegKind::circle, LegKind::circle};
    if (wrong.empty() && three_circles && modes.count % 2 != 0) wrong = "an odd number of modes";
    if (wrong.empty() && built && !found_by(modes, pose)) wrong = "the pose it was built about is missed";
    if (wrong.empty()) continue;
    ++complaints;
    ADD_FAILURE() << "triad " << i << ": " << wrong << "\n" << listing(legs);
  }
  EXPECT_EQ(counts[7] + counts[8], 0);
}

const Shape kAnyShape = [](Dice&, Sketch&) {};

constexpr std::array kThreeCircles = {LegKind::circle, LegKind::circle, LegKind::circle};

TEST(RandomTriad, OfThreeCirclesMissesNoMode) {
  expect_all_found(1, number_of_triads(10'000), kThreeCircles, kAnyShape);
}

TEST(RandomTriad, OfEveryMixMissesNoMode) {
  for (unsigned mix = 1; mix < 27; ++mix) {
    const auto kind = [](unsigned k) { return static_cast<LegKind>(k % 3); };
    SCOPED_TRACE("mix " + std::to_string(mix));
    expect_all_found(100 + mix, number_of_triads(400), {kind(mix), kind(mix / 3), kind(mix / 9)}, kAnyShape);
  }
}

TEST(RandomTriad, OfASpecialShapeMissesNoMode) {
  const auto on_line = [](std::array<Vector2d, 3>& points, double k) {
    points[2] = points[0] + k * (points[1] - points[0]);
  };
  const std::vector<std::pair<std::string, Shape>> shapes = {
      {"collinear platform", [&](Dice& d, Sketch& s) { on_line(s.locals, d.between(-2, 2)); }},
      {"collinear base", [&](Dice& d, Sketch& s) { on_line(s.anchors, d.between(-2, 2)); }},
      {"collinear both",
       [&](Dice& d, Sketch& s) {
         on_line(s.locals, d.between(-2, 2));
         on_line(s.anchors, d.between(-2, 2));
       }},
      {"collinear and alike",
       [&](Dice& d, Sketch& s) {
         const double k = d.between(-2, 2);
         on_line(s.locals, k);
         on_line(s.anchors, k);
       }},
      {"shared platform point", [](Dice&, Sketch& s) { s.locals[1] = s.locals[0]; }},
      {"shared anchor", [](Dice&, Sketch& s) { s.anchors[2] = s.anchors[1]; }},
      {"shared both",
       [](Dice&, Sketch& s) {
         s.locals[1] = s.locals[0];
         s.anchors[2] = s.anchors[1];
       }},
      {"platform like its base",
       [](Dice& d, Sketch& s) {
         const double k = d.between(0.2, 1.5);
         for (std::size_t i = 0; i < 3; ++i) s.locals[i] = k * s.anchors[i];
       }},
      {"platform mirrors its base",
       [](Dice&, Sketch& s) {
         for (std::size_t i = 0; i < 3; ++i) s.locals[i] = Vector2d(s.anchors[i].x(), -s.anchors[i].y());
       }},
      {"nearly mirrors its base",
       [](Dice& d, Sketch& s) {
         const double off = std::pow(10, d.between(-10, -2));
         for (std::size_t i = 0; i < 3; ++i)
           s.locals[i] = Vector2d(s.anchors[i].x(), -s.anchors[i].y()) + off * d.point();
       }},
      {"small platform",
       [](Dice&, Sketch& s) {
         for (Vector2d& local : s.locals) local *= 1e-3;
       }},
      {"small base",
       [](Dice&, Sketch& s) {
         for (Vector2d& anchor : s.anchors) anchor *= 1e-3;
       }},
      {"one short side", [](Dice& d, Sketch& s) { s.locals[1] = s.locals[0] + 1e-4 * d.point(); }},
  };
  unsigned seed = 200;
  for (const auto& [name, shape] : shapes) {
    SCOPED_TRACE(name);
    expect_all_found(++seed, number_of_triads(500), kThreeCircles, shape);
    expect_all_found(++seed, number_of_triads(100), {LegKind::circle, LegKind::circle, LegKind::fixed_line},
                     shape);
    expect_all_found(++seed, number_of_triads(100),
                     {LegKind::platform_line, LegKind::circle, LegKind::circle}, shape);
  }
}

TEST(RandomTriad, OnARevoluteJointOfTwoLinesMissesNoMode) {
  const Shape revolute = [](Dice&, Sketch& s) {
    s.locals[1] = s.locals[0];
    s.directions[0] = Vector2d::UnitX();
    s.directions[1] = Vector2d::UnitY();
  };
  for (const LegKind third : {LegKind::circle, LegKind::fixed_line, LegKind::platform_line}) {
    expect_all_found(300 + static_cast<unsigned>(third), number_of_triads(500),
                     {LegKind::fixed_line, LegKind::fixed_line, third}, revolute);
  }
}

TEST(RandomTriad, OnParallelGuidesMissesNoMode) {
  const Shape parallel = [](Dice& d, Sketch& s) {
    s.directions[1] = d.even() ? s.directions[0] : -s.directions[0];
  };
  expect_all_found(400, number_of_triads(500), {LegKind::fixed_line, LegKind::fixed_line, LegKind::circle},
                   parallel);
  expect_all_found(401, number_of_triads(500),
                   {LegKind::platform_line, LegKind::platform_line, LegKind::circle}, parallel);
  expect_all_found(402, number_of_triads(500),
                   {LegKind::fixed_line, LegKind::fixed_line, LegKind::platform_line}, parallel);
}

// Platform and base alike and nearly parallel: the circles about anchor − R·local are nearly one, and F has
// nearly a fourfold zero.
TEST(RandomTriad, NearAParallelogramMissesNoMode) {
  Dice dice(450);
  const int number = number_of_triads(5'000);
  for (int i = 0; i < number; ++i) {
    Sketch sketch = random_sketch(dice, kThreeCircles);
    sketch.locals = sketch.anchors;
    // a thin triangle multiplies the rounding over `off` once more
    const double area =
        quarter_turn_of(sketch.locals[1] - sketch.locals[0]).dot(sketch.locals[2] - sketch.locals[0]);
    if (std::abs(area) < 0.3) continue;
    const double off = std::pow(10, dice.between(-7, -1));
    const PlatformPose pose{dice.point(), std::cos(off), std::sin(off)};
    const std::array<Leg, 3> legs = closed_in(sketch, pose);
    const PlatformModes modes = platform_modes(legs);
    EXPECT_FALSE(modes.movable) << off << "\n" << listing(legs);
    EXPECT_TRUE(found_by(modes, pose)) << off << "\n" << listing(legs);
    EXPECT_EQ(modes.count % 2, 0) << off << "\n" << listing(legs);
    for (std::size_t k = 0; k < static_cast<std::size_t>(modes.count); ++k)
      EXPECT_LT(closing_error(legs, modes.poses[k]), 1e-10);
    if (::testing::Test::HasFailure()) return;
  }
}

// All three legs let the platform turn about one point C to first order: two modes meet. It must stay in the
// list, once or twice, although rounding decides whether its zero is double, two, or none.
TEST(RandomTriad, KeepsItsDeadCentre) {
  Dice dice(500);
  const int number = number_of_triads(50'000);
  for (int i = 0; i < number; ++i) {
    const auto kind = [](int k) { return static_cast<LegKind>(k % 3); };
    Sketch sketch = random_sketch(dice, {kind(i), kind(i / 3), kind(i / 9)});
    const PlatformPose pose = random_pose(dice);
    const Vector2d centre = dice.point();
    const Matrix2d turn = (Matrix2d() << pose.cosine, -pose.sine, pose.sine, pose.cosine).finished();
    for (std::size_t k = 0; k < 3; ++k) {
      const Vector2d point = pose.position + turn * sketch.locals[k];
      if (sketch.kinds[k] == LegKind::circle)
        sketch.anchors[k] = centre + dice.between(-2, 2) * (point - centre);
      if (sketch.kinds[k] == LegKind::fixed_line)  // closed_in moves the line, not the point
        sketch.directions[k] = quarter_turn_of(point - centre).normalized();
      if (sketch.kinds[k] == LegKind::platform_line)
        sketch.directions[k] = turn.transpose() * quarter_turn_of(sketch.anchors[k] - centre).normalized();
    }
    const std::array<Leg, 3> legs = closed_in(sketch, pose);
    const PlatformModes modes = platform_modes(legs);
    int times = 0;
    bool third_near = false;  // three modes nearly meet: rounding parts them by its third root
    double nearest = INFINITY;
    for (std::size_t k = 0; k < static_cast<std::size_t>(modes.count); ++k) {
      EXPECT_LT(closing_error(legs, modes.poses[k]), 1e-10);
      const double off = distance(modes.poses[k], pose);
      nearest = std::min(nearest, off);
      if (off < 1e-5)
        ++times;
      else if (off < 1e-2)
        third_near = true;
    }
    EXPECT_FALSE(modes.movable) << i << "\n" << listing(legs);
    EXPECT_LT(nearest, third_near ? 1e-4 : 1e-5) << i << "\n" << listing(legs);
    if (!third_near) {
      EXPECT_LE(times, 2) << i << "\n" << listing(legs);
    }
    if (::testing::Test::HasFailure()) return;
  }
}

}  // namespace
}  // namespace oblique::mechanism
