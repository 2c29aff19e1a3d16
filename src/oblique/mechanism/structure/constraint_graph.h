// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <oblique/mechanism/model/mechanism.h>

namespace oblique::mechanism {

/// The conditions of a mechanism as a graph. Vertices are the links (three unknowns each), then the points
/// (two each, none for those of the frame); an edge is one scalar condition between two vertices, or on one.
class ConstraintGraph {
 public:
  static constexpr std::size_t kFrame = static_cast<std::size_t>(-1);

  struct Edge {
    enum class Kind { revolute, on_line, angle, turn, along };
    Kind kind = Kind::revolute;
    std::size_t index = 0;               ///< link of a revolute joint, prismatic joint, or drive
    std::size_t point = 0;               ///< of a revolute joint, index in Mechanism::points
    std::size_t a = kFrame, b = kFrame;  ///< vertices
    std::size_t owner = kFrame;  ///< the vertex that this condition determines; kFrame: it is too much
  };

  explicit ConstraintGraph(const Mechanism& mechanism);

  std::size_t body_vertex(std::size_t body) const { return body; }
  std::size_t point_vertex(std::size_t point) const { return bodies_ + point; }
  bool is_body(std::size_t vertex) const { return vertex < bodies_; }
  std::size_t point_of(std::size_t vertex) const { return vertex - bodies_; }

  const std::vector<Edge>& edges() const { return edges_; }

  /// The edges that determine a vertex, indices in `edges`.
  const std::vector<std::size_t>& owned(std::size_t vertex) const { return owned_[vertex]; }

  /// Conditions that find no unknown left to determine, in the order in which they were added.
  const std::vector<std::size_t>& redundant() const { return redundant_; }

  /// The vertices that a redundant condition competes with for unknowns: their links are over-constrained.
  std::vector<std::size_t> competitors(std::size_t edge) const;

  /// Unknowns that no condition determines, and the vertices that can move with them.
  int freedom() const;
  std::vector<std::size_t> movable() const;

  /// Strongly connected components, each after those it depends on. Vertices of the frame are in none.
  std::vector<std::vector<std::size_t>> components() const;

 private:
  void add(Edge edge);
  bool find_unknown(std::size_t vertex, std::vector<bool>& seen);
  bool exists(std::size_t vertex) const { return vertex != kFrame && capacity_[vertex] != 0; }

  std::size_t bodies_ = 0;
  std::vector<int> capacity_;                       ///< unknowns of a vertex
  std::vector<std::vector<std::size_t>> owned_;     ///< edges by owner
  std::vector<std::vector<std::size_t>> incident_;  ///< edges by vertex
  std::vector<Edge> edges_;
  std::vector<std::size_t> redundant_;
};

}  // namespace oblique::mechanism
