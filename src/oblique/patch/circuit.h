// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

#include <oblique/patch/circuit_writer.h>
#include <oblique/patch/group_residuals.h>
#include <oblique/patch/patch_setup.h>
#include <oblique/patch/point_book.h>

namespace oblique::patch {

/// The signal of a drive's speed and what 1 machine unit of it is [rad/s] or [length unit/s].
struct DriveSpeed {
  std::string signal;
  double unit = 1;
};

/// A circuit that is being written. The free functions of this stage add to it: what all methods of patching
/// share stands in `circuit_frame`, `point_circuits`, `drive_circuits` and `rate_circuits`.
struct Circuit {
  /// The setup has to outlive it.
  explicit Circuit(const PatchSetup& patch_setup)
      : setup(patch_setup),
        places(setup.mechanism(), setup.scaling),
        drives(setup.mechanism().drives.size()),
        speeds(drives.size()) {}

  const PatchSetup& setup;
  CircuitWriter writer;
  PointBook places;
  std::vector<DriveForms> drives;
  std::vector<DriveSpeed> speeds;                               ///< of the drives
  std::vector<std::pair<LinearForm, std::string>> form_blocks;  ///< forms that have a block
};

}  // namespace oblique::patch
