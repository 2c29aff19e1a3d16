// SPDX-License-Identifier: MIT
#include <oblique/compare/yield.h>

#include <algorithm>
#include <cmath>

namespace oblique::compare {

Yield yield_of(std::uint64_t good, std::uint64_t machines) {
  constexpr double kNormal = 1.959963984540054;  // of which 95 % of a normal distribution are within
  constexpr double kSquare = kNormal * kNormal;
  const auto n = static_cast<double>(machines);
  const double part = static_cast<double>(good) / n;
  const double middle = (part + kSquare / (2 * n)) / (1 + kSquare / n);
  const double half = kNormal / (1 + kSquare / n) * std::sqrt(part * (1 - part) / n + kSquare / (4 * n * n));
  return {good, machines, good == 0 ? 0 : std::max(middle - half, 0.0),
          good == machines ? 1 : std::min(middle + half, 1.0)};
}

}  // namespace oblique::compare
