// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <string>

#include <fmt/format.h>

namespace oblique::test {

/// A crank and so many dyads, each on the rocker of the one before; all rockers are alike and upright.
inline std::string chain_of_dyads(int n) {
  std::string frame = "[frame]\nA = [0, 0]\n",
              bodies = "[bodies]\nAB = { points = [\"A\", \"M0\"], length = 0.3 }\n";
  std::string sketch = "[sketch]\n";
  double y = 0.3;
  for (int k = 0; k < n; ++k) {
    const int x = 2 * (k + 1);
    frame += fmt::format("D{} = [{}, 0]\n", k, x);
    bodies +=
        fmt::format("C{0} = {{ points = [\"M{0}\", \"P{0}\"], length = {1} }}\n", k, std::hypot(2, 1.2 - y));
    y = 1.182;
    bodies += fmt::format(
        "R{0} = {{ points = [\"D{0}\", \"P{0}\"], length = 1.2, marks = {{ M{1} = [{2}, 0] }} }}\n", k, k + 1,
        y);
    sketch += fmt::format("P{} = [{}, 1.2]\n", k, x);
  }
  return frame + bodies +
         "[drives]\ncrank = { turns = \"AB\", about = \"A\", speed = 1, start = \"90 deg\" }\n" + sketch;
}

}  // namespace oblique::test
