// SPDX-License-Identifier: MIT
#include <oblique/report/judgement_text.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/mode_control.h>

namespace oblique::report {

std::string judgement_text(const commission::Judgement& judgement, const text::Vocabulary& vocabulary) {
  if (!judgement.good()) return fmt::format("warning: {}\n", commission::fault_of(judgement));
  std::string text =
      std::isfinite(judgement.slowest_pole)
          ? fmt::format(
                "its servo loops come to rest everywhere: slowest pole {:.3g} 1/s, damping ζ ≥ {:.2g}; ",
                judgement.slowest_pole, judgement.damping)
          : std::string("no servo loops; ");
  text += fmt::format("largest signal {:.3g} ({})\n", judgement.largest, judgement.largest_signal);
  if (!judgement.well_damped())
    text += fmt::format("warning: {}; a run takes many steps\n", commission::fault_of(judgement));
  constexpr double kErrors = 0.02;  // of real elements, by which a cosine of 1 may be passed
  if (judgement.largest > 1 + kErrors)
    text +=
        fmt::format("warning: it overloads the machine; choose a larger {}\n", vocabulary.setting({"unit"}));
  return text;
}

std::string bandwidth_text(const commission::MachinePatch& patch, const diagram::MachineProfile& machine) {
  if (!patch.usual) return "";
  return fmt::format("servo amplifiers of {:g} Hz here: with {:g} Hz on the elements of {}, {}\n",
                     *patch.options.bandwidth, patch.usual->bandwidth, machine.title, patch.usual->fault);
}

namespace {

std::string use_text(const std::vector<machine::SignalScale>& scales) {
  const auto less = [](const machine::SignalScale& a, const machine::SignalScale& b) {
    return a.largest < b.largest;
  };
  const auto least = std::min_element(scales.begin(), scales.end(), less);
  const auto most = std::max_element(scales.begin(), scales.end(), less);
  if (scales.empty()) return "";
  return fmt::format("its signals reach {:.2g} ('{}') to {:.2g} ('{}') of the machine unit\n", least->largest,
                     least->signal, most->largest, most->signal);
}

std::string loops_text(const commission::DiagramOnMachine& patched) {
  if (!patched.loops) return "";
  std::string text;
  if (patched.loop_speed < 1) {
    text = fmt::format("servo amplifiers {:g} times as fast as the diagram's: at full speed {}\n",
                       patched.loop_speed, patched.loop_fault);
  }
  if (!patched.loops->well_damped())
    return text + fmt::format("warning: {}\n", commission::fault_of(*patched.loops));
  return text +
         fmt::format("its servo loops come to rest everywhere: slowest pole {:.3g} 1/s, damping ζ ≥ {:.2g}\n",
                     patched.loops->slowest_pole, patched.loops->damping);
}

}  // namespace

std::string machine_text(const commission::DiagramOnMachine& patched,
                         const diagram::MachineProfile& machine) {
  std::string text;
  if (patched.made.time != 1)
    text += fmt::format("1 s of the diagram takes {:g} s on the machine\n", patched.made.time);
  text += use_text(patched.made.scales);
  constexpr double kLongRun = 3600;      // [s]
  constexpr double kSmallSignal = 1e-4;  // [machine unit] what a good multiplier errs by
  if (const double until = patched.made.diagram.run.until; until > kLongRun)
    text += fmt::format("warning: its run takes {:.2g} s there, {:.2g} hours: integrators drift\n", until,
                        until / 3600);
  std::size_t small = 0;
  for (const machine::SignalScale& scale : patched.made.scales) small += scale.largest < kSmallSignal ? 1 : 0;
  if (small > 0)
    text += fmt::format(
        "warning: {} below {:g} of the machine unit all the time: in the errors of the elements\n",
        small == 1 ? "one signal stays" : fmt::format("{} signals stay", small), kSmallSignal);
  for (const machine::GeneratedFunction& function : patched.made.functions) {
    text += fmt::format("{} ({}): {} straight lines from {:.4g} to {:.4g}, within {:.2g}\n", function.signal,
                        function.block, function.segments, function.low, function.high, function.error);
  }
  text += loops_text(patched);
  if (!patched.made.diagram.groups.empty() && !machine::has_mode_groups(machine))
    text += fmt::format("whether groups of integrators can have modes of their own on {} is not published\n",
                        machine.title);
  text += fmt::format("with ideal elements its outputs differ from the diagram's by {:.1e} of their size\n",
                      patched.difference);
  constexpr double kSameOutputs = 1e-3, kLikeOutputs = 0.05;
  if (!patched.made.functions.empty() && patched.difference > kLikeOutputs) {
    text +=
        "warning: the straight lines make something else of it, unless the diagram is chaotic; with more of "
        "them it may be less\n";
  } else if (patched.made.functions.empty() && patched.difference > kSameOutputs) {
    text +=
        "warning: that is more than the solver's tolerance explains, unless the diagram is chaotic or gives "
        "its elements errors of their own, which weigh otherwise in another scale\n";
  }
  const std::size_t left_out = patched.published_left_out;
  if (left_out > 0)
    text +=
        fmt::format("{} published value{} that set{} something of the diagram {} not taken along\n", left_out,
                    left_out == 1 ? "" : "s", left_out == 1 ? "s" : "", left_out == 1 ? "is" : "are");
  if (!patched.failure.empty()) {
    text +=
        fmt::format("warning: on the elements of {} it does not run: {}\n", machine.title, patched.failure);
  } else if (patched.given_up) {
    text += fmt::format(
        "warning: on the elements of {} its run takes more than 200000 steps, and was given up: whether "
        "signals leave the machine unit there is not told\n",
        machine.title);
  } else if (!patched.overloads.empty()) {
    text += fmt::format("warning: on the elements of {} '{}' goes {:.2g} % beyond the machine unit\n",
                        machine.title, patched.overloads.front().signal,
                        (patched.overloads.front().peak - 1) * 100);
  }
  return text;
}

std::string settings_text(const std::vector<machine::CoarseSetting>& settings,
                          const diagram::MachineProfile& machine) {
  constexpr std::size_t kMost = 3;  // told one by one
  std::string text;
  for (std::size_t k = 0; k < std::min(kMost, settings.size()); ++k) {
    const machine::CoarseSetting& coarse = settings[k];
    const double size = std::abs(coarse.setting);
    text += fmt::format(
        "warning: {} ('{}') is set to {:.3g}, and {} steps of {:.2g}{}: it may be off by {:.0f} %\n"
        "  remedy: scale the signals so that it is larger, or put {} potentiometers in series, each at "
        "{:.3g}\n",
        coarse.number, coarse.signal, coarse.setting,
        coarse.is_published ? "the potentiometers of " + machine.title + " have" : "the pot sheet has",
        coarse.step, coarse.is_published ? "" : " (those of " + machine.title + " are not published)",
        100 * std::min(1.0, coarse.step / 2 / size), coarse.in_series,
        std::pow(size, 1.0 / coarse.in_series));
  }
  if (settings.size() > kMost) {
    std::vector<std::string> others;
    for (std::size_t k = kMost; k < settings.size(); ++k) others.push_back(settings[k].number);
    text += fmt::format("warning: as small are the settings of {}\n", fmt::join(others, ", "));
  }
  return text;
}

}  // namespace oblique::report
