// SPDX-License-Identifier: MIT
#include <oblique/patch/patch_setup.h>

#include <fmt/format.h>

#include <oblique/patch/patch_error.h>

namespace oblique::patch {
namespace {

/// Positions over the turn from which the scaling is taken: half a degree apart.
constexpr int kScalingPositions = 721;

}  // namespace

mechanism::Motion patch_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure) {
  std::vector<double> times;
  times.reserve(kScalingPositions);
  const double turn = mechanism::period(mechanism);
  for (int k = 0; k < kScalingPositions; ++k) times.push_back(turn * k / (kScalingPositions - 1));
  return mechanism::solve_motion(mechanism, structure, times);
}

PatchSetup::PatchSetup(const mechanism::Mechanism& whole, const PatchOptions& patch_options)
    : options(patch_options),
      time(whole, options),
      structure(mechanism::decompose(mechanism())),
      motion(patch_motion(mechanism(), structure)),
      scaling(find_scaling(mechanism(), structure, motion)),
      bandwidth(options.bandwidth.value_or(default_bandwidth(mechanism()))) {
  if (options.unit) scaling.length = *options.unit;
}

void refuse(const mechanism::Mechanism& mechanism, const mechanism::Group& group, const std::string& why,
            const std::string& expected, const text::Remedy& remedy) {
  throw PatchError(text::Diagnostic{
      group.bodies.empty() ? mechanism.slides[group.slides.front()].place
                           : mechanism.bodies[group.bodies.front()].place,
      fmt::format("the group {} ({}) {}", group.name, mechanism::kind_name(group.form.kind), why), expected,
      remedy});
}

}  // namespace oblique::patch
