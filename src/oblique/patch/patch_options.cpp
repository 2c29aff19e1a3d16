// SPDX-License-Identifier: MIT
#include <oblique/patch/patch_options.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/machine_time.h>

namespace oblique::patch {

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

/// The greatest speed of a drive over the motion [rad/s], of one that moves a prismatic joint as that of a
/// crank as long as the longest link; of a law, at a thousand moments.
double greatest_speed(const mechanism::Mechanism& mechanism, const mechanism::Drive& drive) {
  double fastest = std::abs(drive.speed);
  if (drive.law) {
    constexpr int kMoments = 1000;
    const double until = mechanism::period(mechanism);
    fastest = 0;
    for (int k = 0; k <= kMoments; ++k)
      fastest = std::max(fastest, std::abs(mechanism::law_at(drive, until * k / kMoments).rate));
  }
  return drive.slide ? fastest / mechanism.largest_length() : fastest;
}

}  // namespace

double default_bandwidth(const mechanism::Mechanism& mechanism) {
  double fastest = 0;
  for (const mechanism::Drive& drive : mechanism.drives)
    fastest = std::max(fastest, greatest_speed(mechanism, drive));
  const double wanted = 100 * fastest / (2 * std::numbers::pi);
  const double decade = std::pow(10, std::floor(std::log10(wanted)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (step * decade >= wanted) return step * decade;
  }
  return 10 * decade;
}

double bandwidth_of(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  if (options.bandwidth) return *options.bandwidth;
  return default_bandwidth(MachineTime(mechanism, options).slowed);
}

}  // namespace oblique::patch
