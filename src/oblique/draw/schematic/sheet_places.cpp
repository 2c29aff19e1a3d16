// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/sheet_places.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include <fmt/format.h>

namespace oblique::draw::schematic {
namespace {

using Eigen::Vector2d;

/// A block with a place: the middle of its outline [px].
struct Placed {
  const diagram::BlockPlace* given;
  std::size_t block;
  Vector2d middle;
  Vector2d growth = Vector2d::Zero();  ///< of the outline, where it is open
};

/// Makes room around open composites: what lies to the right of one moves to the right, and so on, so that
/// what was apart stays apart.
void spread(std::vector<Placed>& placed) {
  std::vector<Vector2d> shifts(placed.size(), Vector2d::Zero());
  const auto side = [](double a, double b) { return a > b ? 0.5 : a < b ? -0.5 : 0; };
  for (std::size_t k = 0; k < placed.size(); ++k) {
    for (const Placed& other : placed) {
      shifts[k] += Vector2d(side(placed[k].middle.x(), other.middle.x()) * other.growth.x(),
                            side(placed[k].middle.y(), other.middle.y()) * other.growth.y());
    }
  }
  for (std::size_t k = 0; k < placed.size(); ++k) placed[k].middle += shifts[k];
}

Vector2d on_grid(const Vector2d& at) {
  return {std::round(at.x() / kLayoutGrid) * kLayoutGrid, std::round(at.y() / kLayoutGrid) * kLayoutGrid};
}

void check_distances(const std::vector<Placed>& placed, const LayoutGraph& graph) {
  text::Diagnostics diagnostics;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const LayoutNode& own = graph.nodes[placed[k].block];
    for (std::size_t j = 0; j < k; ++j) {
      const LayoutNode& other = graph.nodes[placed[j].block];
      const Vector2d to_end = *other.place + other.size - *own.place,
                     to_begin = *own.place + own.size - *other.place;
      const Vector2d reach = to_end.cwiseMin(to_begin).array() + kLayoutGrid;  // into each other
      if (reach.minCoeff() <= 0) continue;
      const bool sideways = reach.x() < reach.y();
      const bool further = sideways ? to_end.x() <= to_begin.x() : to_end.y() <= to_begin.y();
      const char* const direction =
          sideways ? (further ? "to the right" : "to the left") : (further ? "down" : "up");
      diagnostics.add(
          {placed[k].given->place,
           fmt::format("'{}' overlaps '{}' or is too close to it in [layout]", placed[k].given->name,
                       placed[j].given->name),
           fmt::format("blocks apart from each other: '{}' with its texts takes {} by {}",
                       placed[k].given->name, own.size.x() / kPlaceUnit, own.size.y() / kPlaceUnit),
           fmt::format("move it by {} {}", (sideways ? reach.x() : reach.y()) / kPlaceUnit, direction)});
    }
  }
  diagnostics.throw_if_any<diagram::DiagramError>();
}

/// The blocks that a schematic's layout gives places to.
std::vector<Placed> placed_blocks(const Schematic& schematic) {
  std::vector<Placed> placed;
  for (const diagram::BlockPlace& given : *schematic.layout) {
    const auto block = std::find_if(schematic.blocks.begin(), schematic.blocks.end(), [&](const Block& b) {
      return b.kind == Block::Kind::block && b.name == given.name;
    });
    if (block == schematic.blocks.end()) continue;  // a constant: it stands at the inputs that it feeds
    placed.push_back({&given, static_cast<std::size_t>(block - schematic.blocks.begin()),
                      kPlaceUnit * Vector2d(given.x, given.y)});
  }
  return placed;
}

/// The corner nearest to `wanted` at which a box is apart from all others, and has room for wires around it
/// where it cannot stand there.
Vector2d nearest_room(const Vector2d& wanted, const Vector2d& size, std::span<const Placed> others,
                      const LayoutGraph& graph) {
  const auto is_apart = [&](const Vector2d& corner, double room) {
    return std::all_of(others.begin(), others.end(), [&](const Placed& p) {
      const LayoutNode& other = graph.nodes[p.block];
      const Vector2d reach =
          (*other.place + other.size - corner).cwiseMin(corner + size - *other.place).array() + room;
      return reach.minCoeff() <= 0;
    });
  };
  if (is_apart(wanted, kLayoutGrid)) return wanted;
  constexpr int kFarthestRing = 2000;
  constexpr double kRoom = 3 * kLayoutGrid;
  for (int ring = 1; ring < kFarthestRing; ++ring) {
    std::optional<Vector2d> best;
    for (int a = -ring; a <= ring; ++a) {
      for (const Vector2d& step :
           {Vector2d(a, ring), Vector2d(a, -ring), Vector2d(ring, a), Vector2d(-ring, a)}) {
        const Vector2d corner = wanted + kLayoutGrid * step;
        if (best && (*best - wanted).norm() <= kLayoutGrid * step.norm()) continue;
        if (is_apart(corner, kRoom)) best = corner;
      }
    }
    if (best) return *best;
  }
  return wanted;
}

}  // namespace

void give_places(const Schematic& schematic, const std::vector<Shape>& shapes, SymbolStyle style,
                 LayoutGraph& graph) {
  if (schematic.layout == nullptr) return;
  std::vector<Placed> placed = placed_blocks(schematic);
  for (Placed& p : placed) {
    const Block& block = schematic.blocks[p.block];
    if (!block.inside.empty()) p.growth = shapes[p.block].node.size - shape_of(block, style).node.size;
  }
  spread(placed);
  for (const Placed& p : placed)
    graph.nodes[p.block].place = on_grid(p.middle - shapes[p.block].corner - shapes[p.block].body / 2);
  check_distances(placed, graph);
}

std::vector<diagram::BlockPlace> give_room(const Schematic& schematic, const std::vector<Shape>& shapes,
                                           const std::string& held, LayoutGraph& graph) {
  std::vector<Placed> placed = placed_blocks(schematic);
  std::stable_partition(placed.begin(), placed.end(), [&](const Placed& p) { return p.given->name != held; });
  std::vector<diagram::BlockPlace> moved;
  for (std::size_t k = 0; k < placed.size(); ++k) {
    const Placed& p = placed[k];
    const Vector2d to_middle = shapes[p.block].corner + shapes[p.block].body / 2;
    const Vector2d wanted = on_grid(p.middle - to_middle);
    const Vector2d found = nearest_room(wanted, graph.nodes[p.block].size, std::span(placed).first(k), graph);
    graph.nodes[p.block].place = found;
    if (found == wanted) continue;
    const Vector2d middle = (found + to_middle) / kPlaceUnit;
    moved.push_back({p.given->name, middle.x(), middle.y(), p.given->place});
  }
  return moved;
}

void check_wires(const Schematic& schematic, const DiagramLayout& layout) {
  if (layout.lost.empty() || schematic.layout == nullptr || schematic.layout->empty()) return;
  text::Diagnostics diagnostics;
  for (const std::size_t n : layout.lost) {
    const std::string& name = schematic.blocks[layout.nets[n].from].name;
    const auto given = std::find_if(schematic.layout->begin(), schematic.layout->end(),
                                    [&](const diagram::BlockPlace& place) { return place.name == name; });
    const diagram::BlockPlace& at = given == schematic.layout->end() ? schematic.layout->front() : *given;
    diagnostics.add({at.place,
                     fmt::format("the wires from '{}' find no way among the places of [layout]", name),
                     "room for wires between blocks",
                     fmt::format("move '{}' and what it feeds apart from the blocks around them", name)});
  }
  diagnostics.throw_if_any<diagram::DiagramError>();
}

}  // namespace oblique::draw::schematic
