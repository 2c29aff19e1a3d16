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
/// machine, by bisection.
std::optional<MachinePatch> slower_patch(const mechanism::Mechanism& mechanism,
                                         const diagram::BlockLibrary& library,
                                         const diagram::MachineProfile& machine, const MachinePatch& patched,
                                         bool (Judgement::*is_fine)() const) {
  patch::PatchOptions options = patched.options;
  const double usual = patch::bandwidth_of(mechanism, options);
  std::optional<MachinePatch> found;
  if (!std::isfinite(usual)) return found;
  std::vector<double> bandwidths;
  double bandwidth = step_down(usual);
  while (bandwidth > least_bandwidth(usual, options.gain)) {
    bandwidths.push_back(bandwidth);
    bandwidth = step_down(bandwidth);
  }
  for (auto from = bandwidths.begin(), to = bandwidths.end(); from != to;) {
    const auto middle = from + (to - from) / 2;
    options.bandwidth = *middle;
    MachinePatch slower{patch::patch(mechanism, options), {}, options, {}, {}};
    slower.ideal.file = patched.ideal.file;
    slower.realised = machine::realise(slower.ideal, library, machine).diagram;
    slower.judgement = judge(slower.realised, library);
    slower.usual = {usual, fault_of(patched.judgement)};
    if ((slower.judgement.*is_fine)()) {
      found = std::move(slower);
      to = middle;
    } else {
      from = middle + 1;
    }
  }
  return found;
}

}  // namespace

MachinePatch put_on_machine(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                            const diagram::MachineProfile& machine, JudgedPatch patched) {
  MachinePatch usual{std::move(patched.diagram), {}, std::move(patched.options), {}, {}};
  usual.realised = machine::realise(usual.ideal, library, machine).diagram;
  usual.judgement = judge(usual.realised, library);
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
