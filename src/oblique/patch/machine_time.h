// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/mechanism.h>
#include <oblique/patch/patch.h>

namespace oblique {

/// A mechanism whose motion takes as long as `PatchOptions::period` asks for.
struct MachineTime {
  /// Throws PatchError where a period is asked for and a drive's speed varies with time.
  MachineTime(const Mechanism& mechanism, const PatchOptions& options);

  Mechanism slowed;
  double factor = 1;  ///< seconds of the motion in one of the machine
};

}  // namespace oblique
