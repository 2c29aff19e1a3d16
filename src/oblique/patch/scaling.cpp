// SPDX-License-Identifier: MIT
#include <oblique/patch/scaling.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/obstacle.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/patch_error.h>

namespace oblique::patch {
namespace {

[[noreturn]] void refuse_range(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                               const mechanism::Obstacle& obstacle) {
  const bool open = obstacle.status == mechanism::Status::open;
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = mechanism::DriveClock(mechanism).at(0, obstacle.time).value;
  const std::string stand = drive.slide ? fmt::format("{:.6g} {}", value, mechanism.length_unit)
                                        : fmt::format("{:.6g}°", value * 180 / std::numbers::pi);
  throw PatchError(text::Diagnostic{
      {mechanism.file, {}},
      fmt::format(
          "the {} {} {} at t = {:.6g} s, where drive '{}' stands at {}, so no servo loop can track it",
          structure.groups[obstacle.group].assur_class == 2 ? "dyad" : "group",
          structure.groups[obstacle.group].name,
          obstacle.infinite ? "goes to infinity"
          : open            ? "cannot be assembled"
                            : "is at a dead centre",
          obstacle.time, drive.name, stand),
      open ? "links that reach each other in every position" : "a group that never comes to a dead centre",
      open ? text::Remedy{"lengthen the links of the dyad, or shorten the crank; ", text::Action{"solve"},
                          " shows where it opens"}
           : "change a length a little: at a dead centre the servo loops lose their gain"});
}

}  // namespace

double round_scale_up(double value) {
  constexpr double kSame = 1e-12;  // a boundary is one whatever the unit of length rounds it to
  const double decade = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 4.0, 5.0, 8.0}) {
    if (step * decade >= value * (1 - kSame)) return step * decade;
  }
  return 10 * decade;
}

double round_up(double value) {
  const double unit = std::pow(10, std::floor(std::log10(value)) - 2);
  return std::ceil(value / unit) * unit;
}

Scaling find_scaling(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure,
                     const mechanism::Motion& motion) {
  if (const auto obstacle = mechanism::find_obstacle(mechanism, structure))
    refuse_range(mechanism, structure, *obstacle);
  Scaling scaling;
  scaling.triangles.resize(structure.groups.size());
  for (TriangleRange& range : scaling.triangles) range.shortest = std::numeric_limits<double>::infinity();
  scaling.origin = mechanism.points.front().position;  // points of the frame come first
  double farthest = 0;
  for (const mechanism::Configuration& configuration : motion.configurations) {
    for (const mechanism::PointState& point : configuration.points) {
      farthest = std::max(farthest, (point.position - scaling.origin).cwiseAbs().maxCoeff());
    }
    for (std::size_t g = 0; g < structure.groups.size(); ++g) {
      const auto& dyad = structure.groups[g].form.dyad;
      if (!dyad) continue;
      const double length =
          (configuration.points[dyad->q].position - configuration.points[dyad->p].position).norm();
      const double cosine =
          (dyad->r1 * dyad->r1 + length * length - dyad->r2 * dyad->r2) / (2 * dyad->r1 * length);
      TriangleRange& range = scaling.triangles[g];
      range.shortest = std::min(range.shortest, length);
      range.longest = std::max(range.longest, length);
      range.flattest = std::min(range.flattest, std::sqrt(std::max(0.0, 1 - cosine * cosine)));
    }
  }
  scaling.slides.assign(mechanism.slides.size(), 0);
  for (const mechanism::Configuration& configuration : motion.configurations) {
    for (std::size_t s = 0; s < scaling.slides.size(); ++s)
      scaling.slides[s] = std::max(scaling.slides[s], std::abs(configuration.slides[s].position));
  }
  scaling.length = round_scale_up(farthest);
  return scaling;
}

}  // namespace oblique::patch
