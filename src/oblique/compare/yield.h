// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace oblique::compare {

/// How many of the machines that were drawn are good, and what that tells of all machines: with 95 %
/// confidence their part lies between `low` and `high`, by Wilson's interval (J. Am. Stat. Assoc. 22 (1927)),
/// which needs no large numbers and stays between 0 and 1.
struct Yield {
  std::uint64_t good = 0, machines = 0;
  double low = 0, high = 1;

  double part() const { return static_cast<double>(good) / static_cast<double>(machines); }
};

/// Of at least one machine.
Yield yield_of(std::uint64_t good, std::uint64_t machines);

}  // namespace oblique::compare
