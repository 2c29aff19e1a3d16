// SPDX-License-Identifier: MIT
// The blocks of drives, which all methods of patching share.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/patch/patch_builder.h>
#include <oblique/text/expression_printer.h>

namespace oblique::patch {
namespace {

constexpr double kBetweenRows = 1.001;  ///< how much more there may be between two positions of the motion

}  // namespace

std::string PatchBuilder::speed_text(const mechanism::Drive& drive) const {
  const std::string unit = drive.slide ? mechanism_.length_unit + "/s" : "rad/s";
  if (!drive.law) return fmt::format("{:.6g} {}", drive.speed, unit);
  const std::string law = text::to_string(*drive.law);
  return drive.law_scale == 1 ? fmt::format("{} {}", law, unit)
                              : fmt::format("({})*{:.6g} {}", law, drive.law_scale, unit);
}

const PatchBuilder::Speed& PatchBuilder::add_speed(std::size_t d) {
  const mechanism::Drive& drive = mechanism_.drives[d];
  if (!drive.law) return speeds_[d] = {one_, drive.speed};
  double fastest = 0;
  for (const std::vector<mechanism::DriveState>& row : motion_.drives)
    fastest = std::max(fastest, std::abs(row[d].rate));
  const double unit = fastest > 0 ? round_up(kBetweenRows * fastest) : 1;
  speeds_[d].signal = add_block(drive.name + "_speed", "time-function",
                                {diagram::text_setting("formula", text::to_string(*drive.law)),
                                 diagram::number_setting("scale", drive.law_scale / unit)});
  speeds_[d].unit = unit;
  return speeds_[d];
}

std::string PatchBuilder::add_generator(std::size_t d, const std::string& comment) {
  const Speed& speed = add_speed(d);
  std::string generator = add_block(
      mechanism_.drives[d].name, "crank-generator",
      {diagram::wire_setting("speed", {{1, speed.signal}}), diagram::number_setting("rate", speed.unit),
       diagram::number_setting("start", mechanism_.drives[d].start)},
      comment);
  drives_[d].axis = {weighted(generator + ".cos"), weighted(generator + ".sin")};
  return generator;
}

std::string PatchBuilder::add_way(std::size_t d) {
  const mechanism::Drive& drive = mechanism_.drives[d];
  const double margin = drive.law ? kBetweenRows : 1;
  const double reach =
      round_up(scaled(std::max(margin * scaling_.slides[*drive.slide], scaling_.length / 1000)));
  const Speed& speed = add_speed(d);
  std::string way = add_block(drive.name, "integrator",
                              {diagram::wire_setting("in", {{scaled(speed.unit) / reach, speed.signal}}),
                               diagram::number_setting("initial", scaled(drive.start) / reach)},
                              fmt::format("drive {}: {} along {}", drive.name, speed_text(drive),
                                          mechanism_.slides[*drive.slide].name));
  drives_[d].way = weighted(way, reach);
  return way;
}

}  // namespace oblique::patch
