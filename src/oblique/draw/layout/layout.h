// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace oblique::draw {

/// The grid of a layout [px]: pins, upper edges of boxes and heights are multiples of it, so that wires
/// either run in one line or are apart.
inline constexpr double kLayoutGrid = 8;

/// Where a box must stand.
enum class LayoutRank { free, first, last };

/// A box with pins: inputs on its left edge, outputs on its right one.
struct LayoutNode {
  Eigen::Vector2d size = Eigen::Vector2d::Zero();  ///< [px]
  std::vector<double> inputs, outputs;             ///< below the upper edge [px]
  LayoutRank rank = LayoutRank::free;
  std::optional<Eigen::Vector2d> place;  ///< of the upper left corner, on the grid [px]; none: chosen
};

/// A wire from an output to an input.
struct LayoutWire {
  std::size_t from = 0, output = 0, to = 0, input = 0;
  int weight = 1;  ///< how much it matters that it is short
};

/// What is laid out.
struct LayoutGraph {
  std::vector<LayoutNode> nodes;
  std::vector<LayoutWire> wires;
};

/// A straight piece of wire, horizontal or vertical; `from` is the left or upper end.
struct WirePiece {
  Eigen::Vector2d from, to;
  bool horizontal() const { return from.y() == to.y(); }
};

/// All wires from one output.
struct RoutedNet {
  std::size_t from = 0, output = 0;
  std::vector<WirePiece> pieces;
  std::vector<Eigen::Vector2d> junctions;  ///< where three or four pieces meet
};

/// What makes a layout hard to read.
struct LayoutQuality {
  std::size_t crossings = 0;  ///< of wires of different nets
  std::size_t bends = 0;      ///< corners that are no junctions
  std::size_t feedbacks = 0;  ///< wires that go from right to left
  double wire_length = 0;     ///< [px]
};

/// Coordinates of all boxes and wires [px]; the upper left corner is at (0, 0).
struct DiagramLayout {
  std::vector<Eigen::Vector2d> corners;  ///< upper left, of each node
  std::vector<RoutedNet> nets;
  Eigen::Vector2d size = Eigen::Vector2d::Zero();
  LayoutQuality quality;
  std::vector<std::size_t> lost;  ///< nets that found no way among boxes whose places are given
};

/// A layered layout (K. Sugiyama, S. Tagawa, M. Toda, "Methods for visual understanding of hierarchical
/// system structures", 1981): signals go from left to right, as few as can be back; boxes do not overlap and
/// no wire crosses a box. Wires from one output share their way. Sizes and pins must lie on the grid. The
/// same graph gives the same layout.
///
/// Boxes with a `place` stand there, apart from a shift of the whole that leaves no coordinate below 0; they
/// must be apart by more than the grid. The others are laid out by themselves below them, and terminals
/// (`first`, `last`) at the sides.
DiagramLayout lay_out(const LayoutGraph& graph);

}  // namespace oblique::draw
