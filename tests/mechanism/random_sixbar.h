// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace oblique::mechanism {

/// A six-bar chain of pinned links at random dimensions: the text of its file, and the distances that its
/// links keep and the sides on which their third points lie.
struct RandomSixbar {
  std::string text;
  struct Bar {
    std::string a, b;
    double length;
  };
  struct Plate {
    std::string a, b, c;
    int side;  ///< ±1: c lies left or right of a → b
  };
  std::vector<Bar> bars;
  std::vector<Plate> plates;
};

/// Number `seed` of them: Watt's and Stephenson's chains by turns, on any of their links, driven by any link
/// that is pinned to the frame. None has two joints of a link nearer to each other than 0.15 of 1.
RandomSixbar random_sixbar(std::uint64_t seed);

}  // namespace oblique::mechanism
