// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/patch/patch_options.h>

namespace oblique::patch {

/// A mechanism whose motion takes as long as `PatchOptions::period` asks for.
struct MachineTime {
  /// Throws MechanismError where a period is asked for and the motion has none.
  MachineTime(const mechanism::Mechanism& mechanism, const PatchOptions& options);

  mechanism::Mechanism slowed;
  double factor = 1;  ///< seconds of the motion in one of the machine
};

}  // namespace oblique::patch
