// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include <fmt/format.h>

namespace oblique::testing {

/// u = sin t (and y = cos t), n blocks x1, x2, … behind it, each on the one before less `shift`, and the
/// integral z of the last one. `block` is one block without its input: "absolute-value", "limiter", low = -1.
inline std::string chain(std::string_view block, int n, double shift) {
  std::string text = "one = { type = \"constant\", value = 1 }\n";
  text += "u = { type = \"integrator\", in = \"y\", initial = 0 }\n";
  text += "y = { type = \"integrator\", in = \"-u\", initial = 1 }\n";
  std::string last = "u";
  for (int k = 1; k <= n; ++k) {
    text += fmt::format("s{} = {{ type = \"summer\", in = [\"{}\", \"{}*one\"] }}\n", k, last, -shift);
    text += fmt::format("x{} = {{ type = {}, in = \"s{}\" }}\n", k, block, k);
    last = fmt::format("x{}", k);
  }
  return text + fmt::format("z = {{ type = \"integrator\", in = \"{}\" }}\n", last);
}

/// A magnitude of one's own.
inline constexpr std::string_view kOwnMagnitude = R"--([inputs]
in = {}
[outputs]
out = {}
[equations]
out = "if(in > 0, in, -in)"
)--";

}  // namespace oblique::testing
