// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::solve {

/// Something that happened between two smooth stretches of a run.
struct EventRecord {
  double time = 0;  ///< [s]
  std::string what;
};

}  // namespace oblique::solve
