// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

// Of this stage; not installed.
namespace oblique::ensemble {

/// Points of the unit cube of which along every axis exactly one lies in each of as many equal intervals as
/// there are points, at random in it (McKay, Beckman, Conover 1979). They depend on the seed and on their
/// number alone.
class LatinHypercube {
 public:
  LatinHypercube(std::uint64_t seed, std::uint32_t points, std::size_t dimensions);
  double at(std::uint32_t point, std::size_t dimension) const;

 private:
  std::uint64_t seed_;
  std::vector<std::vector<std::uint32_t>> interval_;  ///< of each dimension and point
};

/// Points of Sobol's sequence from 0 on, in the order of Gray's code, with the directions of S. Joe and
/// F. Y. Kuo ("Constructing Sobol sequences with better two-dimensional projections", SIAM J. Sci. Comput. 30
/// (2008), new-joe-kuo-6).
inline constexpr std::size_t kMostSobolDimensions = 21;
double sobol(std::uint32_t point, std::size_t dimension);

}  // namespace oblique::ensemble
