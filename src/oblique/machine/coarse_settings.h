// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/machine_profile.h>

namespace oblique::machine {

/// The last of the four digits of a setting on the pot sheet.
inline constexpr double kSheetStep = 1e-4;

/// A potentiometer whose setting is so small that the step to which it can be set is a tenth of it or more.
struct CoarseSetting {
  std::string number, signal;  ///< "P3", "pot_3"
  double setting = 0;          ///< as it should be; never 0
  double step = 0;
  bool is_published = false;  ///< the step is that of the machine's potentiometers; else `kSheetStep`
  int in_series = 2;          ///< so many potentiometers behind each other do it
};

/// The coarse settings of a diagram in a machine's elements, in its order; none on the ideal machine.
std::vector<CoarseSetting> coarse_settings(const diagram::FlatDiagram& diagram,
                                           const diagram::MachineProfile& machine);

}  // namespace oblique::machine
