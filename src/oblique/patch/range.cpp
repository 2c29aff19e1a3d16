// SPDX-License-Identifier: MIT
#include <oblique/patch/range.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

namespace oblique::patch {
namespace {

/// How much of its range a mechanism is swung over: at the ends a triangle is collinear, and the loop
/// that tracks its angle loses its gain.
constexpr double kPartOfRange = 0.9;

}  // namespace

mechanism::Mechanism within_range(const mechanism::Mechanism& mechanism) {
  if (mechanism.drives.size() != 1 || mechanism.drives.front().law || mechanism.motion.until)
    return mechanism;
  const mechanism::Drive& drive = mechanism.drives.front();
  const mechanism::MotionLimits range = mechanism::find_range(mechanism, mechanism::decompose(mechanism));
  const auto is_limit = [](const std::optional<mechanism::MotionEvent>& event) {
    return event && event->ends();
  };
  if (!is_limit(range.forward) || !is_limit(range.backward)) return mechanism;
  const double first = range.backward->time * drive.speed, last = range.forward->time * drive.speed;
  const double middle = (first + last) / 2;  // from the start
  const double amplitude = std::max(kPartOfRange * std::abs(last - first) / 2, std::abs(middle));
  const double rate = std::abs(drive.speed) / amplitude;
  // value − start = middle + amplitude · sin(rate t + phase)
  double phase = std::asin(std::clamp(-middle / amplitude, -1.0, 1.0));
  if (drive.speed < 0) phase = std::numbers::pi - phase;

  mechanism::Mechanism swung = mechanism;
  mechanism::Drive& swing = swung.drives.front();
  mechanism::SpeedLaw law = mechanism::parse_law(fmt::format("{:.17g}*cos({:.17g}*time + {:.17g})",
                                                             std::abs(drive.speed), rate, phase),
                                                 text::Unit{})
                                .value();
  swing.law = std::move(law.speed);
  swing.law_scale = law.scale;
  // its `speed` stays the greatest of the law: from the end of its way a swing sets off with none
  swung.motion.until = 2 * std::numbers::pi / rate;
  return swung;
}

}  // namespace oblique::patch
