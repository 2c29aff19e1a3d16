// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::testing {

/// A crank alone, of 2 m: B = 2 (cos φ, sin φ).
inline mechanism::Mechanism crank() {
  return mechanism::parse_mechanism(R"(
format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 2 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s" }
)",
                                    "crank.toml");
}

}  // namespace oblique::testing
