// SPDX-License-Identifier: MIT
#include <oblique/commission/on_machine.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/format.h>

#include <oblique/machine/realise.h>

namespace oblique::commission {
namespace {

/// A closed loop of `gain` times the bandwidth is to be ten times as fast as the drive, and the usual
/// bandwidth is a hundred times that.
double least_bandwidth(double usual, double gain) {
  return usual / 10 / std::min(gain, 1e9);
}

/// The next smaller of 1, 2 and 5 times a power of ten.
double step_down(double value) {
  constexpr double kRounding = 1 - 1e-9;
  const double decade = std::pow(10, std::floor(std::log10(value * kRounding)));
  for (const double step : {5.0, 2.0}) {
    if (step * decade < value * kRounding) return step * decade;
  }
  return decade;
}

/// The patch with the greatest bandwidth, smaller than that of `patched`, with which it `is_fine` on the
/// machine: found by bisection at the start, and the next smaller ones where it is not along the whole
/// motion.
std::optional<MachinePatch> slower_patch(const mechanism::Mechanism& mechanism,
                                         const diagram::BlockLibrary& library,
                                         const diagram::MachineProfile& machine, const MachinePatch& patched,
                                         bool (Judgement::*is_fine)() const) {
  patch::PatchOptions options = patched.options;
  const double usual = patch::bandwidth_of(mechanism, options);
  if (!std::isfinite(usual)) return std::nullopt;
  std::vector<double> bandwidths;
  double bandwidth = step_down(usual);
  while (bandwidth > least_bandwidth(usual, options.gain)) {
    bandwidths.push_back(bandwidth);
    bandwidth = step_down(bandwidth);
  }
  const auto with = [&](double slower_bandwidth) {
    options.bandwidth = slower_bandwidth;
    MachinePatch slower{patch::patch(mechanism, options),
                        {},
                        options,
                        {},
                        MachinePatch::Usual{usual, fault_of(patched.judgement)}};
    slower.ideal.file = patched.ideal.file;
    slower.realised = machine::realise(slower.ideal, library, machine).diagram;
    return slower;
  };
  auto fastest = std::partition_point(bandwidths.begin(), bandwidths.end(), [&](double slower_bandwidth) {
    return !(judge_start(with(slower_bandwidth).realised, library).*is_fine)();
  });
  for (; fastest != bandwidths.end(); ++fastest) {
    MachinePatch slower = with(*fastest);
    slower.judgement = judge(slower.realised, library);
    if ((slower.judgement.*is_fine)()) return slower;
  }
  return std::nullopt;
}

}  // namespace

MachinePatch put_on_machine(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                            const diagram::MachineProfile& machine, JudgedPatch patched) {
  MachinePatch usual{std::move(patched.diagram), {}, std::move(patched.options), {}, {}};
  usual.realised = machine::realise(usual.ideal, library, machine).diagram;
  // A run of loops that diverge is long: where they do at the start, that is told.
  usual.judgement = judge_start(usual.realised, library);
  if (usual.judgement.good()) usual.judgement = judge(usual.realised, library);
  if (usual.judgement.well_damped() || usual.options.force) return usual;
  const auto slower = [&](bool (Judgement::*is_fine)() const) {
    return slower_patch(mechanism, library, machine, usual, is_fine);
  };
  if (!usual.options.bandwidth) {
    if (auto damped = slower(&Judgement::well_damped)) return *damped;
  }
  if (usual.judgement.good()) return usual;
  const auto stable = slower(&Judgement::good);
  if (stable && !usual.options.bandwidth) return *stable;
  throw patch::PatchError(
      text::Diagnostic{
          {mechanism.file, {}},
          fmt::format("on the machine {} this patch would not run: {}", machine.title,
                      fault_of(usual.judgement)),
          "servo loops that settle everywhere along the motion",
          stable
              ? text::Remedy{text::Setting{"bandwidth", fmt::format("{:g} Hz", *stable->options.bandwidth)},
                             " is stable"}
              : text::Remedy{"choose a machine with faster elements (", text::Action{"machines"},
                             "), or a lower ", text::Setting{"gain"}}})
      .forcible();
}

}  // namespace oblique::commission
