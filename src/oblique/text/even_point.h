// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

namespace oblique::text {

/// Point k = 1, 2, … of the unit cube of so many dimensions; they are spread evenly however many are taken:
/// the additive recurrence frac(½ + k/gⁱ), g the root of gⁿ⁺¹ = g + 1 (M. Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018). Not installed.
std::vector<double> even_point(int k, std::size_t dimensions);

}  // namespace oblique::text
