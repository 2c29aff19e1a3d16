// SPDX-License-Identifier: MIT
#include "random_class_three.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/commission/judge.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

namespace oblique::testing {
namespace {

using Eigen::Vector2d;

constexpr double kLeastDeterminant = 0.1;

class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [low, high); std::uniform_real_distribution may differ from library to library.
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11U) * 0x1p-53;
  }
  Vector2d point() {
    const double x = (*this)(-1.5, 1.5), y = (*this)(-1.5, 1.5);
    return {x, y};
  }

 private:
  std::mt19937_64 engine_;
};

/// Any crank and triad, assembled at the start.
mechanism::Mechanism candidate(Numbers& number) {
  const Vector2d z = number.point(), e = number.point(), b = number.point(), c = number.point(),
                 d = number.point();
  const double crank = number(0.1, 0.3);
  const Vector2d a(crank, 0), way = d - b, arm = c - b;
  const double bone = way.norm();
  const Vector2d local(way.dot(arm) / bone, (way.x() * arm.y() - way.y() * arm.x()) / bone);
  mechanism::Mechanism m;
  m.length_unit = "m";
  m.points = {{"O", true, {0, 0}}, {"Z", true, z},   {"E", true, e},  {"A", false, {}},
              {"B", false, {}},    {"D", false, {}}, {"C", false, {}}};
  m.bodies = {{"OA", {{0, {0, 0}}, {3, {crank, 0}}}, {}},
              {"AB", {{3, {0, 0}}, {4, {(b - a).norm(), 0}}}, {}},
              {"BDC", {{4, {0, 0}}, {5, {bone, 0}}, {6, local}}, {}},
              {"DE", {{5, {0, 0}}, {2, {(e - d).norm(), 0}}}, {}},
              {"ZC", {{1, {0, 0}}, {6, {(z - c).norm(), 0}}}, {}}};
  mechanism::Drive drive;
  drive.name = "crank";
  drive.body = 0;
  drive.about = 0;
  drive.speed = 1;
  m.drives = {drive};
  m.sketch = {{4, b}, {6, c}, {5, d}};
  return m;
}

bool turns_well(const mechanism::Mechanism& mechanism) {
  try {
    const mechanism::Structure structure = mechanism::decompose(mechanism);
    mechanism::Follower follower(mechanism, structure);
    for (int k = 0; k <= 360; ++k) {
      follower.advance(2 * std::numbers::pi * k / 360);
      if (!follower.events().empty() || std::abs(follower.normalised_determinant(1)) < kLeastDeterminant)
        return false;
    }
    return true;
  } catch (const mechanism::MechanismError&) {  // it cannot be assembled, or falls apart otherwise
    return false;
  }
}

}  // namespace

mechanism::Mechanism random_class_three(std::uint64_t seed) {
  Numbers number(seed);
  while (true) {
    mechanism::Mechanism mechanism = candidate(number);
    if (turns_well(mechanism)) return mechanism;
  }
}

Tracking track(const mechanism::Mechanism& mechanism, patch::PatchMethod method,
               const diagram::BlockLibrary& library) {
  constexpr double kGain = 1e4;
  patch::PatchOptions options;
  options.method = method;
  options.gain = kGain;
  options.samples = 91;
  options.tolerance = 1e-8;
  Tracking result;
  try {
    const commission::JudgedPatch patched = commission::judged_patch(mechanism, library, options);
    result.split = fmt::format("{} /{:g}", fmt::join(patched.options.split, ","),
                               patched.options.slower.value_or(patch::kUsualSlower));
    const diagram::FlatDiagram flat = diagram::flatten(patched.diagram, library);
    const network::Program program(network::assemble(flat));
    const solve::Run analog = solve::run(program, flat, solve::options_of(patched.diagram.run));
    const solve::Trajectory& table = analog.trajectory;
    const mechanism::Motion exact = mechanism::solve_motion(mechanism, options.samples);
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      if (mechanism.points[p].fixed) continue;
      const std::size_t x = table.find(mechanism.points[p].name + ".x").value();
      for (std::size_t row = 0; row < table.rows(); ++row) {
        const Vector2d place(table.at(row, x), table.at(row, x + 1));
        result.error = std::max(result.error, (place - exact.configurations[row].points[p].position).norm());
      }
    }
    result.error /= mechanism.largest_length();
    result.tracks = result.error < 10 / kGain;
    if (!result.tracks) result.explanation = fmt::format("errs by {:.2g} of the largest link", result.error);
  } catch (const text::Error& error) {
    result.explanation = error.diagnostics().front().what;
  }
  return result;
}

}  // namespace oblique::testing
