// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::test {

/// Two links without a loop, each with a motor: what is patched has nothing that lags.
inline constexpr const char* kArm = R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
upper = { points = ["A", "B"], length = 1 }
fore  = { points = ["B", "C"], length = 1 }
[drives]
shoulder = { turns = "upper", about = "A", speed = 1 }
elbow    = { turns = "fore", about = "B", speed = 2, start = "90 deg" }
)";

}  // namespace oblique::test
