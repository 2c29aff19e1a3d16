// SPDX-License-Identifier: MIT
// The blocks of drives, which all methods of patching share.
#include <fmt/format.h>

#include <oblique/patch/patch_builder.h>

namespace oblique {

const VectorForm& PatchBuilder::add_generator(std::size_t d, const std::string& comment) {
  const Drive& drive = mechanism_.drives[d];
  const std::string generator =
      add_block(drive.name, "crank-generator",
                {wire_setting("speed", {{1, one_}}), number_setting("rate", drive.speed),
                 number_setting("start", drive.start)},
                comment);
  drives_[d].axis = {weighted(generator + ".cos"), weighted(generator + ".sin")};
  return drives_[d].axis;
}

std::string PatchBuilder::add_way(std::size_t d, double reach) {
  const Drive& drive = mechanism_.drives[d];
  const std::string way =
      add_block(drive.name, "integrator",
                {wire_setting("in", {{scaled(drive.speed) / reach, one_}}),
                 number_setting("initial", scaled(drive.start) / reach)},
                fmt::format("drive {}: {:.6g} {}/s along {}", drive.name, drive.speed, mechanism_.length_unit,
                            mechanism_.slides[*drive.slide].name));
  drives_[d].way = weighted(way, reach);
  return way;
}

}  // namespace oblique
