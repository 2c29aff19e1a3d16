// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <oblique/draw/layout/layout.h>

/// Wires among fixed boxes. Not installed.
namespace oblique::draw {

/// The pins of a net and, once it is laid, its wires.
struct NetToRoute {
  Eigen::Vector2d source = Eigen::Vector2d::Zero();
  std::vector<Eigen::Vector2d> sinks;
  std::vector<WirePiece> pieces;
};

/// The rectangle that wires may use.
struct RoutingArea {
  Eigen::Vector2d low = Eigen::Vector2d::Zero(), high = Eigen::Vector2d::Zero();
};

/// Lays wires one after the other on the layout's grid (E. F. Moore, C. Y. Lee, "An algorithm for path
/// connections and its applications", 1961, with the estimate of A*): clear of boxes, never on each other,
/// short, with few bends and crossings. The same calls give the same wires.
class WireRouter {
 public:
  /// `nets` with their pins, which lie on the edges of boxes; the wires that they have are laid.
  WireRouter(const LayoutGraph& graph, const std::vector<Eigen::Vector2d>& corners,
             const std::vector<NetToRoute>& nets, const RoutingArea& area);

  /// Lays the net anew if that is better than what it has (or where it has nothing); whether it did.
  bool route(std::size_t net);

  const NetToRoute& net(std::size_t k) const { return nets_[k]; }
  /// How many points all searches together have looked at.
  long work() const { return work_; }
  /// How bad the wires of a net are.
  int cost(std::size_t net) const;
  /// Takes the wires of a net away.
  void take_up(std::size_t net);

 private:
  using Point = std::int32_t;
  static constexpr std::int32_t kNone = -1;

  Point point(const Eigen::Vector2d& at) const;
  Eigen::Vector2d place(Point p) const;
  void lay(std::size_t net);
  template <class Visit>
  void visit(const WirePiece& piece, const Visit& visit_point) const;

  bool find_way(std::int32_t net, Point target, int budget, std::vector<Point>& way, int& used);
  std::vector<WirePiece> pieces_of(const std::vector<Point>& way) const;

  std::vector<double> xs_, ys_;
  std::vector<char> odd_column_,
      odd_row_;  ///< between those of the grid: for the wires that lie there already
  std::vector<char> blocked_;
  std::vector<std::int32_t> across_, down_;  ///< the net whose horizontal or vertical wire is at a point
  std::vector<std::int32_t> reserved_;       ///< the net whose pin needs the point
  std::vector<NetToRoute> nets_;

  // of one search; states are points with the direction of arrival
  std::vector<int> reached_;
  std::vector<std::int32_t> stamp_, from_;
  std::int32_t search_ = 0;
  long work_ = 0;
};

}  // namespace oblique::draw
