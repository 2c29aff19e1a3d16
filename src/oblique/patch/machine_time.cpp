// SPDX-License-Identifier: MIT
#include <oblique/patch/machine_time.h>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/range.h>
#include <oblique/text/expression.h>

namespace oblique::patch {
namespace {

/// The law at `factor` times the time.
void stretch(text::Expression& law, double factor) {
  if (law.kind != text::Expression::Kind::name || law.name != "time") {
    for (text::Expression& operand : law.operands) stretch(operand, factor);
    return;
  }
  text::Expression product, number;
  number.number = factor;
  product.kind = text::Expression::Kind::multiply;
  product.operands = {number, law};
  law = product;
}

}  // namespace

MachineTime::MachineTime(const mechanism::Mechanism& mechanism, const PatchOptions& options)
    : slowed(mechanism) {
  if (!options.period) return;
  factor = mechanism::period(within_range(mechanism)) / *options.period;
  for (mechanism::Drive& drive : slowed.drives) {
    if (drive.law) {
      stretch(*drive.law, factor);
      drive.law_scale *= factor;
    }
    drive.speed *= factor;
  }
  if (slowed.motion.until) *slowed.motion.until /= factor;
}

}  // namespace oblique::patch
