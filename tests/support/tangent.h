// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::test {

/// A mechanism but for its drive, which is to turn 'arm' about O: C moves along x = 100 as y = 100 tan φ, and
/// so through infinity.
inline constexpr const char* kTangent = R"([frame]
O = [0, 0]
F = [100, 0]
E = [100, 100]
[bodies]
arm = { points = ["O", "T"], length = 150 }
block = { points = ["C", "K"], length = 30 }
[slides]
slot = { point = "C", along = ["O", "T"] }
guide = { point = "C", along = ["F", "E"], of = "block", angle = 0 }
)";

}  // namespace oblique::test
