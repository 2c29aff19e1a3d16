// SPDX-License-Identifier: MIT
#include <oblique/report/drive_caption.h>

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <oblique/mechanism/model/drive_law.h>

namespace oblique::report {
namespace {

/// With a true minus sign, as the axes have it.
std::string shown_number(double value) {
  return (value < 0 ? "−" : "") + fmt::format("{:.6g}", std::abs(value));
}

}  // namespace

std::string drive_caption(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Drive& drive = mechanism.drives.front();
  const double value = mechanism::DriveClock(mechanism).at(0, time).value;
  if (drive.slide) return fmt::format("{} = {} {}", drive.name, shown_number(value), mechanism.length_unit);
  const double degrees = std::round(value * 180 / std::numbers::pi * 1e4) / 1e4;
  return fmt::format("{} = {}°", drive.name, shown_number(degrees));
}

}  // namespace oblique::report
