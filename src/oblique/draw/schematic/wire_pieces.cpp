// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/wire_pieces.h>

#include <algorithm>
#include <array>

namespace oblique::draw {

using Eigen::Vector2d;

std::vector<WirePiece> merged(std::vector<WirePiece> pieces) {
  const auto along = [](const WirePiece& p) {
    return p.horizontal() ? std::array{p.from.x(), p.to.x()} : std::array{p.from.y(), p.to.y()};
  };
  const auto across = [](const WirePiece& p) { return p.horizontal() ? p.from.y() : p.from.x(); };
  std::erase_if(pieces, [](const WirePiece& p) { return p.from == p.to; });
  std::sort(pieces.begin(), pieces.end(), [&](const WirePiece& a, const WirePiece& b) {
    if (a.horizontal() != b.horizontal()) return a.horizontal();
    return across(a) != across(b) ? across(a) < across(b) : along(a) < along(b);
  });
  std::vector<WirePiece> result;
  for (const WirePiece& piece : pieces) {
    if (!result.empty() && result.back().horizontal() == piece.horizontal() &&
        across(result.back()) == across(piece) && along(piece)[0] <= along(result.back())[1]) {
      if (along(piece)[1] > along(result.back())[1]) result.back().to = piece.to;
    } else {
      result.push_back(piece);
    }
  }
  return result;
}

WireJoints joints_of(const std::vector<WirePiece>& pieces) {
  WireJoints joints;
  for (const WirePiece& vertical : pieces) {
    if (vertical.horizontal()) continue;
    for (const WirePiece& piece : pieces) {
      if (!piece.horizontal()) continue;
      const Vector2d at(vertical.from.x(), piece.from.y());
      if (at.x() < piece.from.x() || at.x() > piece.to.x() || at.y() < vertical.from.y() ||
          at.y() > vertical.to.y())
        continue;
      const int arms = (at.x() > piece.from.x()) + (at.x() < piece.to.x()) + (at.y() > vertical.from.y()) +
                       (at.y() < vertical.to.y());
      if (arms > 2) joints.junctions.push_back(at);
      if (arms == 2) ++joints.bends;
    }
  }
  return joints;
}

std::size_t count_crossings(const std::vector<RoutedNet>& nets) {
  std::vector<std::pair<const WirePiece*, std::size_t>> horizontal, vertical;
  for (std::size_t n = 0; n < nets.size(); ++n) {
    for (const WirePiece& piece : nets[n].pieces)
      (piece.horizontal() ? horizontal : vertical).emplace_back(&piece, n);
  }
  std::sort(horizontal.begin(), horizontal.end(),
            [](const auto& a, const auto& b) { return a.first->from.y() < b.first->from.y(); });
  std::size_t crossings = 0;
  for (const auto& [v, net] : vertical) {
    auto at = std::upper_bound(horizontal.begin(), horizontal.end(), v->from.y(),
                               [](double y, const auto& h) { return y < h.first->from.y(); });
    for (; at != horizontal.end() && at->first->from.y() < v->to.y(); ++at) {
      if (at->second != net && at->first->from.x() < v->from.x() && v->from.x() < at->first->to.x())
        ++crossings;
    }
  }
  return crossings;
}

}  // namespace oblique::draw
