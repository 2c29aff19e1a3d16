// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/machine_time.h>
#include <oblique/patch/patch_options.h>
#include <oblique/patch/scaling.h>

namespace oblique::patch {

/// The exact motion over one turn, half a degree apart, from which a patch takes its ranges.
mechanism::Motion patch_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure);

/// What is known before the first block is written. The options have to outlive it.
struct PatchSetup {
  /// Throws as `MachineTime`, `decompose`, `period` and `find_scaling`.
  PatchSetup(const mechanism::Mechanism& whole, const PatchOptions& patch_options);

  /// In the machine's time.
  const mechanism::Mechanism& mechanism() const { return time.slowed; }
  double scaled(double length) const { return length / scaling.length; }
  const std::string& name_of(std::size_t point) const { return mechanism().points[point].name; }

  const PatchOptions& options;
  MachineTime time;
  mechanism::Structure structure;
  mechanism::Motion motion;  ///< exact, half a degree apart: for ranges
  Scaling scaling;
  double bandwidth;  ///< of the servo amplifiers [Hz]
};

/// Throws PatchError: "the group AB-BC (RRR) `why`".
[[noreturn]] void refuse(const mechanism::Mechanism& mechanism, const mechanism::Group& group,
                         const std::string& why, const std::string& expected, const text::Remedy& remedy);

}  // namespace oblique::patch
