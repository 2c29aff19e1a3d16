// SPDX-License-Identifier: MIT
#include <oblique/solve/trajectory.h>

#include <algorithm>

namespace oblique::solve {

std::optional<std::size_t> Trajectory::find(std::string_view column) const {
  const auto found =
      std::find_if(columns_.begin(), columns_.end(), [&](const Column& c) { return c.name == column; });
  if (found == columns_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - columns_.begin());
}

}  // namespace oblique::solve
