// SPDX-License-Identifier: MIT
#include "drive_place.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/model/drive_law.h>
#include <oblique/mechanism/motion/motion.h>

#include "terminal.h"

namespace oblique::cli {

namespace {

/// With a true minus sign, as the axes have it.
std::string shown_number(double value) {
  return (value < 0 ? "−" : "") + fmt::format("{:.6g}", std::abs(value));
}

}  // namespace

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
                         fmt::format("--at {}: drive '{}' does not come there", at, drive.name),
                         "a value that it reaches",
                         {}});
  }
  return *there;
}

std::string drive_caption(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = mechanism::DriveClock(mechanism).at(0, time).value;
  if (drive.slide) return fmt::format("{} = {} {}", drive.name, shown_number(value), mechanism.length_unit);
  const double degrees = std::round(value * 180 / std::numbers::pi * 1e4) / 1e4;
  return fmt::format("{} = {}°", drive.name, shown_number(degrees));
}

}  // namespace oblique::cli
