// SPDX-License-Identifier: MIT
#pragma once

#include <optional>

namespace oblique::bench {

/// Where the program was started as a child of the heat ladder's benchmark: runs a ladder, and gives the
/// status to end with.
std::optional<int> heat_ladder_child(int argc, char** argv);

}  // namespace oblique::bench
