// SPDX-License-Identifier: MIT
#include <oblique/report/judgement_text.h>

#include <cmath>

#include <fmt/format.h>

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

}  // namespace oblique::report
