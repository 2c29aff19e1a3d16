// SPDX-License-Identifier: MIT
// One leg of Jansen's mechanism, solved group by group, against the same formulas written out by hand; and
// the class III mechanism of method, followed from pose to pose.
#include <array>
#include <cmath>
#include <numbers>

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/solver/kinematics.h>
#include <oblique/mechanism/structure/structure.h>

#include "figures.h"

namespace oblique::bench {
namespace {

constexpr int kPoses = 20'000;

/// A point or a vector with its two rates.
struct Moving {
  double x, y, vx, vy, ax, ay;
};

/// What a dyad gives: its revolute joint, and the turn of both links as e, ω, α.
struct HandDyad {
  Moving c;
  double e1x, e1y, e2x, e2y, w1, w2, a1, a2;
};

/// C over P → Q, r1 from P and r2 from Q, left of P → Q for side +1.
inline HandDyad dyad(const Moving& p, const Moving& q, double r1, double r2, double side) {
  HandDyad d;
  const double dx = q.x - p.x, dy = q.y - p.y;
  const double squared = dx * dx + dy * dy, base = std::sqrt(squared), inverse = 1 / base;
  const double along = (squared + r1 * r1 - r2 * r2) * inverse / 2;
  const double height = side * std::sqrt(r1 * r1 - along * along);
  const double ux = dx * inverse, uy = dy * inverse;
  d.e1x = along * ux - height * uy;
  d.e1y = along * uy + height * ux;
  d.c.x = p.x + d.e1x;
  d.c.y = p.y + d.e1y;
  d.e2x = d.c.x - q.x;
  d.e2y = d.c.y - q.y;
  const double cross = 1 / (d.e1x * d.e2y - d.e1y * d.e2x);
  const double vx = q.vx - p.vx, vy = q.vy - p.vy;
  d.w1 = (d.e2x * vx + d.e2y * vy) * cross;
  d.w2 = (d.e1x * vx + d.e1y * vy) * cross;
  const double bx = q.ax - p.ax + d.w1 * d.w1 * d.e1x - d.w2 * d.w2 * d.e2x;
  const double by = q.ay - p.ay + d.w1 * d.w1 * d.e1y - d.w2 * d.w2 * d.e2y;
  d.a1 = (d.e2x * bx + d.e2y * by) * cross;
  d.a2 = (d.e1x * bx + d.e1y * by) * cross;
  d.c.vx = p.vx - d.w1 * d.e1y;
  d.c.vy = p.vy + d.w1 * d.e1x;
  d.c.ax = p.ax - d.a1 * d.e1y - d.w1 * d.w1 * d.e1x;
  d.c.ay = p.ay + d.a1 * d.e1x - d.w1 * d.w1 * d.e1y;
  return d;
}

/// A point of a link that turns about Q: (a + i b) of its bone e.
inline Moving carried(const Moving& q, double ex, double ey, double w, double alpha, double a, double b) {
  const double x = a * ex - b * ey, y = a * ey + b * ex;
  return {q.x + x,
          q.y + y,
          q.vx - w * y,
          q.vy + w * x,
          q.ax - alpha * y - w * w * x,
          q.ay + alpha * x - w * w * y};
}

/// Ratio of the third corner of a triangle to its base, as a complex number.
std::array<double, 2> corner(double base, double from, double to, double side) {
  const double along = (base * base + from * from - to * to) / (2 * base);
  return {along / base, side * std::sqrt(from * from - along * along) / base};
}

/// P1 … P6 of the leg at one crank angle.
struct Leg {
  std::array<double, 2> p3 = corner(41.5, 40.1, 55.8, +1);  // of O2 → P2, from O2
  std::array<double, 2> p5 = corner(36.7, 49, 65.7, +1);    // of P6 → P4, from P6
  std::array<Moving, 6> at(double angle, double speed) const {
    std::array<Moving, 6> p;
    const double c = 15 * std::cos(angle), s = 15 * std::sin(angle);
    p[0] = {c, s, -speed * s, speed * c, -speed * speed * c, -speed * speed * s};
    const Moving o2{-38, -7.8, 0, 0, 0, 0};
    const HandDyad upper = dyad(p[0], o2, 50, 41.5, -1);
    p[1] = upper.c;
    p[2] = carried(o2, upper.e2x, upper.e2y, upper.w2, upper.a2, p3[0], p3[1]);
    const HandDyad knee = dyad(p[0], o2, 61.9, 39.3, +1);
    p[5] = knee.c;
    const HandDyad lower = dyad(p[2], p[5], 39.4, 36.7, -1);
    p[3] = lower.c;
    p[4] = carried(p[5], lower.e2x, lower.e2y, lower.w2, lower.a2, p5[0], p5[1]);
    return p;
  }
};

mechanism::Mechanism one_leg() {
  mechanism::Mechanism both =
      mechanism::read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/jansen.toml");
  std::erase_if(both.bodies, [](const mechanism::Body& body) { return body.name.ends_with("2"); });
  std::erase_if(both.bodies.front().points,
                [&](const mechanism::BodyPoint& p) { return both.points[p.point].name == "Q1"; });
  std::erase_if(both.sketch,
                [&](const mechanism::SketchPoint& p) { return both.points[p.point].name[0] == 'Q'; });
  std::erase_if(both.points, [](const mechanism::Point& p) { return p.name[0] == 'Q'; });
  // the second leg's points stand behind the first's, but for Q1, which the crank names
  for (mechanism::Body& body : both.bodies) {
    for (mechanism::BodyPoint& p : body.points) p.point -= p.point > 3 ? 1 : 0;
  }
  for (mechanism::SketchPoint& p : both.sketch) p.point -= p.point > 3 ? 1 : 0;
  return both;
}

void jansen(benchmark::State& state) {
  const mechanism::Mechanism mechanism = one_leg();
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  mechanism::Kinematics kinematics(mechanism, structure);
  mechanism::Configuration here = mechanism::start_configuration(mechanism, structure);
  const double speed = mechanism.drives.front().speed;
  const Leg leg;
  std::array<std::size_t, 6> points{};
  for (std::size_t i = 0; i < points.size(); ++i)
    points[i] = mechanism.find_point("P" + std::to_string(i + 1)).value();
  const auto angle_of = [](int k) { return 2 * std::numbers::pi * k / kPoses; };

  double worst = 0;
  for (int k = 0; k < kPoses; k += 97) {
    kinematics.place(std::array{mechanism::DriveState{angle_of(k), speed, 0}}, here);
    const auto hand = leg.at(angle_of(k), speed);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const mechanism::PointState& p = here.points[points[i]];
      worst = std::max({worst, std::abs(p.position.x() - hand[i].x), std::abs(p.position.y() - hand[i].y),
                        std::abs(p.acceleration.x() - hand[i].ax) / (speed * speed),
                        std::abs(p.acceleration.y() - hand[i].ay) / (speed * speed)});
    }
  }
  if (!(worst < 1e-9)) {
    state.SkipWithError(fmt::format("the two legs differ by {} mm", worst).c_str());
    return;
  }
  std::vector<double> ratios, ours, by_hand;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    for (int k = 0; k < kPoses; ++k) {
      kinematics.place(std::array{mechanism::DriveState{angle_of(k), speed, 0}}, here);
      benchmark::DoNotOptimize(here.points.data());
      benchmark::ClobberMemory();
    }
    const double middle = cpu_seconds();
    std::array<Moving, 6> pose;
    for (int k = 0; k < kPoses; ++k) {
      pose = leg.at(angle_of(k), speed);
      benchmark::DoNotOptimize(pose.data());
      benchmark::ClobberMemory();
    }
    const double end = cpu_seconds();
    ours.push_back((middle - begin) / kPoses);
    by_hand.push_back((end - middle) / kPoses);
    ratios.push_back(ours.back() / by_hand.back());
    state.SetIterationTime(end - begin);
  }
  state.counters["ours_ns"] = 1e9 * median(ours);
  state.counters["hand_ns"] = 1e9 * median(by_hand);
  state.counters["ratio"] = median(ratios);
  record({"Jansen's leg with rates: time a pose, ours over hand-written", median(ratios), 1 / 0.7, ""});
}

void class_three(benchmark::State& state) {
  const mechanism::Mechanism mechanism =
      mechanism::read_mechanism(OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/class-iii.toml");
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  mechanism::Kinematics kinematics(mechanism, structure);
  mechanism::Configuration here = mechanism::start_configuration(mechanism, structure);
  const double speed = mechanism.drives.front().speed;
  std::vector<double> times;
  for (auto _ : state) {
    const double begin = cpu_seconds();
    for (int k = 0; k < kPoses; ++k) {
      kinematics.place(std::array{mechanism::DriveState{2 * std::numbers::pi * k / kPoses, speed, 0}}, here);
      benchmark::DoNotOptimize(here.points.data());
    }
    times.push_back((cpu_seconds() - begin) / kPoses);
    state.SetIterationTime(times.back() * kPoses);
  }
  state.counters["poses_a_second"] = 1 / median(times);
  state.counters["ns"] = 1e9 * median(times);
}

BENCHMARK(jansen)->Name("jansen_leg")->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(1);
BENCHMARK(class_three)->Name("class_three_pose")->UseManualTime()->Unit(benchmark::kMillisecond)->MinTime(1);

}  // namespace
}  // namespace oblique::bench
