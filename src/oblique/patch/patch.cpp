// SPDX-License-Identifier: MIT
#include <oblique/patch/patch.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/motion.h>

namespace oblique {

std::string_view method_name(PatchMethod method) {
  constexpr std::array<std::string_view, 3> kNames{"triangles", "gradient", "paper"};
  return kNames[static_cast<std::size_t>(method)];
}

std::optional<PatchMethod> parse_patch_method(std::string_view text) {
  for (const PatchMethod method : {PatchMethod::triangles, PatchMethod::gradient, PatchMethod::paper}) {
    if (text == method_name(method)) return method;
  }
  return std::nullopt;
}

namespace {

/// The greatest speed of a drive over the motion [rad/s] or [length unit/s]; of a law, at a thousand moments.
double greatest_speed(const Mechanism& mechanism, const Drive& drive) {
  if (!drive.law) return std::abs(drive.speed);
  constexpr int kMoments = 1000;
  const double until = period(mechanism);
  double fastest = 0;
  for (int k = 0; k <= kMoments; ++k)
    fastest = std::max(fastest, std::abs(law_at(drive, until * k / kMoments).rate));
  return fastest;
}

/// Seconds of the motion in one of the machine.
double time_factor(const Mechanism& mechanism, double machine_period) {
  return period(within_range(mechanism)) / machine_period;
}

/// The mechanism with its drives slowed down, so that its motion takes `factor` times less time.
Mechanism slowed_by(double factor, const Mechanism& mechanism) {
  Mechanism slowed = mechanism;
  for (Drive& drive : slowed.drives) {
    if (drive.law) {
      throw PatchError(Diagnostic{
          drive.place,
          fmt::format("drive '{}' has a speed that varies with time, which --period cannot "
                      "stretch",
                      drive.name),
          "drives of constant speed", "leave --period out, or write the law for the machine's time"});
    }
    drive.speed *= factor;
  }
  if (slowed.motion.until) *slowed.motion.until /= factor;
  return slowed;
}

Diagram patch_slowed(const Mechanism& mechanism, PatchOptions options) {
  const double factor = time_factor(mechanism, *options.period);
  options.period.reset();
  Diagram diagram = patch(slowed_by(factor, mechanism), options);
  diagram.comment += fmt::format("\nTime: 1 s of the machine is {:.6g} s of the mechanism.", factor);
  for (OutputSpec& output : diagram.outputs) {
    const std::string_view name = output.name;
    if (name.ends_with(".vx") || name.ends_with(".vy")) output.scale /= factor;
    if (name.ends_with(".ax") || name.ends_with(".ay")) output.scale /= factor * factor;
  }
  return diagram;
}

}  // namespace

double default_bandwidth(const Mechanism& mechanism) {
  double fastest = 0;
  for (const Drive& drive : mechanism.drives) fastest = std::max(fastest, greatest_speed(mechanism, drive));
  const double wanted = 100 * fastest / (2 * std::numbers::pi);
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= wanted) return step * decade;
  }
  return 10 * decade;
}

double bandwidth_of(const Mechanism& mechanism, const PatchOptions& options) {
  if (options.bandwidth) return *options.bandwidth;
  if (!options.period) return default_bandwidth(mechanism);
  return default_bandwidth(slowed_by(time_factor(mechanism, *options.period), mechanism));
}

Diagram patch(const Mechanism& mechanism, const PatchOptions& options) {
  if (options.period) return patch_slowed(mechanism, options);
  const Mechanism ranged = within_range(mechanism);
  switch (options.method) {
    case PatchMethod::gradient:
      return patch_gradient(ranged, options);
    case PatchMethod::paper:
      return patch_paper(ranged, options);
    case PatchMethod::triangles:
      break;
  }
  return patch_triangles(ranged, options);
}

}  // namespace oblique
