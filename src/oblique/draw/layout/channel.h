// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/draw/layout/plan.h>

namespace oblique::draw::layered {

/// Where the vertical pieces of the wires of one channel stand.
struct Track {
  std::size_t branch = 0;  ///< of the channel
  std::size_t column = 0;  ///< counted from the left
  /// A branch that could not do with one vertical piece goes on at `link` [px] to the piece at `second`.
  bool split = false;
  std::size_t second = 0;
  double link = 0;
};
struct RoutedChannel {
  std::vector<Track> tracks;  ///< of the branches that do not run straight
  std::size_t columns = 0;
};
RoutedChannel route_channel(const Plan& plan, const std::vector<Branch>& branches);

}  // namespace oblique::draw::layered
