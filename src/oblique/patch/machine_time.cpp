// SPDX-License-Identifier: MIT
#include <oblique/patch/machine_time.h>

#include <fmt/format.h>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/patch_error.h>
#include <oblique/patch/range.h>

namespace oblique::patch {

MachineTime::MachineTime(const mechanism::Mechanism& mechanism, const PatchOptions& options)
    : slowed(mechanism) {
  if (!options.period) return;
  factor = mechanism::period(within_range(mechanism)) / *options.period;
  for (mechanism::Drive& drive : slowed.drives) {
    if (drive.law) {
      throw PatchError(text::Diagnostic{
          drive.place,
          fmt::format(
              "drive '{}' has a speed that varies with time, which no period of the machine can stretch",
              drive.name),
          "drives of constant speed",
          text::Remedy{"leave ", text::Setting{"period"}, " out, or write the law for the machine's time"}});
    }
    drive.speed *= factor;
  }
  if (slowed.motion.until) *slowed.motion.until /= factor;
}

}  // namespace oblique::patch
