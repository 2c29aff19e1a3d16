// SPDX-License-Identifier: MIT
#include <oblique/solve/events/combinations.h>

#include <algorithm>
#include <bit>
#include <numeric>

namespace oblique::solve {

std::vector<Combination> nearest_first(Combination to, std::size_t places) {
  std::vector<Combination> order(std::size_t{1} << places);
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](Combination a, Combination b) {
    return std::popcount(a ^ to) < std::popcount(b ^ to);
  });
  return order;
}

}  // namespace oblique::solve
