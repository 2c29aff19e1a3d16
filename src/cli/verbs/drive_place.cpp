// SPDX-License-Identifier: MIT
#include "verbs/drive_place.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion.h>

#include "terminal/terminal.h"

namespace oblique::cli {

double time_option_at(const mechanism::Mechanism& mechanism, const std::string& at) {
  if (at.empty()) return 0;
  if (mechanism.drives.empty()) {
    throw text::ReadError(text::Diagnostic{
        {mechanism.file, {}}, "--at: the mechanism has no drive", "a file with [drives]", {}});
  }
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = quantity_option("--at", at, drive.slide ? mechanism.length_unit : "rad");
  const auto there = mechanism::time_at_value(mechanism, value);
  if (!there) {
    throw text::ReadError(
        text::Diagnostic{{},
                         fmt::format("--at {}: drive '{}' does not reach it", at, drive.name),
                         "a value that it reaches",
                         {}});
  }
  return *there;
}

}  // namespace oblique::cli
