// SPDX-License-Identifier: MIT
#include <oblique/draw/layout/wrap.h>

#include <algorithm>
#include <limits>
#include <set>

#include <oblique/draw/layout/layering.h>
#include <oblique/draw/layout/route_all.h>

// How a long layout is broken into rows, as a text is into lines. A layered diagram is as long as its signal
// path. The layers are broken where the widest row becomes as narrow as it can be with that number of rows,
// and the number is the least that makes the picture no longer a strip. Boxes and the wires within a row
// move with their row; only nets between rows are laid anew, by the router, in gaps that are wide enough for
// all of them. Where one of them finds no way, or where it would take too long, the layout stays as it was.

namespace oblique::draw {
namespace {

using Eigen::Vector2d;

constexpr double kWidest = 2400;       // layouts up to this stay in one row [px]
constexpr double kLongest = 2.2;       // and those whose width is up to this many heights
constexpr double kMostWrapping = 4e6;  // points of the grid times wires

/// The layers of a layout with the row that each is in.
struct Rows {
  std::vector<std::size_t> of_layer;
  double width = 0;  ///< of the widest row
};

/// Breaks the layers so that the widest row is as narrow as it can be with that many rows.
Rows break_layers(const std::vector<double>& left, const std::vector<double>& right, std::size_t rows) {
  const auto rows_within = [&](double width) {
    Rows result;
    std::size_t begin = 0, row = 0;
    for (std::size_t l = 0; l < left.size(); ++l) {
      if (right[l] - left[begin] > width && l > begin) {
        begin = l;
        ++row;
      }
      result.of_layer.push_back(row);
      result.width = std::max(result.width, right[l] - left[begin]);
    }
    return result;
  };
  std::set<double> widths;
  for (std::size_t a = 0; a < left.size(); ++a) {
    for (std::size_t b = a; b < right.size(); ++b) widths.insert(right[b] - left[a]);
  }
  for (const double width : widths) {
    Rows result = rows_within(width);
    if (result.width <= width && result.of_layer.back() < rows) return result;
  }
  return rows_within(std::numeric_limits<double>::max());
}

/// A layout in rows: its corners, and the wires that stay within a row.
class Wrapping {
 public:
  Wrapping(const LayoutGraph& graph, const DiagramLayout& layout, const std::vector<std::size_t>& row)
      : graph_(graph), row_(row), wrapped_(layout), nets_(nets_of(graph, layout.corners, wrapped_.nets)) {
    const std::size_t rows = *std::max_element(row.begin(), row.end()) + 1;
    low_.assign(rows, Vector2d::Constant(std::numeric_limits<double>::max()));
    high_.assign(rows, Vector2d::Constant(std::numeric_limits<double>::lowest()));
    find_rows_of_nets();
    for (std::size_t v = 0; v < row.size(); ++v)
      include(row[v], wrapped_.corners[v], wrapped_.corners[v] + graph.nodes[v].size);
    for (std::size_t n = 0; n < nets_.size(); ++n) {
      if (row_of_net_[n] == kSeveral) continue;
      for (const WirePiece& piece : nets_[n].pieces) include(row_of_net_[n], piece.from, piece.to);
    }
  }

  /// False where a wire finds no way.
  bool run() {
    const auto between = static_cast<double>(std::count(row_of_net_.begin(), row_of_net_.end(), kSeveral));
    const double gap = (between + 4) * kLayoutGrid;
    double y = 0;
    std::vector<Vector2d> shifts;
    for (std::size_t r = 0; r < low_.size(); ++r) {
      shifts.emplace_back(Vector2d(gap, y) - low_[r]);
      y += high_[r].y() - low_[r].y() + gap;
    }
    Vector2d end(0, 0);
    for (std::size_t v = 0; v < row_.size(); ++v) {
      wrapped_.corners[v] += shifts[row_[v]];
      end = end.cwiseMax(wrapped_.corners[v] + graph_.nodes[v].size);
    }
    const std::vector<RoutedNet> old = wrapped_.nets;
    nets_ = nets_of(graph_, wrapped_.corners, wrapped_.nets);
    for (std::size_t n = 0; n < nets_.size(); ++n) {
      nets_[n].pieces.clear();
      if (row_of_net_[n] == kSeveral) continue;
      const Vector2d shift = shifts[row_of_net_[n]];
      for (const WirePiece& piece : old[n].pieces) {
        nets_[n].pieces.push_back({piece.from + shift, piece.to + shift});
        end = end.cwiseMax(piece.to + shift);
      }
    }
    end += Vector2d(gap, gap);
    const double points = end.x() / kLayoutGrid * end.y() / kLayoutGrid;
    if (points * static_cast<double>(graph_.wires.size()) > kMostWrapping) return false;
    if (!route_all(graph_, wrapped_.corners, {Vector2d::Zero(), end}, nets_).empty()) return false;
    for (std::size_t n = 0; n < nets_.size(); ++n) wrapped_.nets[n].pieces = nets_[n].pieces;
    return true;
  }

  const DiagramLayout& wrapped() const { return wrapped_; }

 private:
  static constexpr std::size_t kSeveral = static_cast<std::size_t>(-1);

  void find_rows_of_nets() {
    for (const RoutedNet& net : wrapped_.nets) {
      std::size_t row = row_[net.from];
      for (const LayoutWire& wire : graph_.wires) {
        if (wire.from == net.from && wire.output == net.output && row_[wire.to] != row) row = kSeveral;
      }
      row_of_net_.push_back(row);
    }
  }

  void include(std::size_t row, const Vector2d& low, const Vector2d& high) {
    low_[row] = low_[row].cwiseMin(low);
    high_[row] = high_[row].cwiseMax(high);
  }

  const LayoutGraph& graph_;
  const std::vector<std::size_t>& row_;  ///< of each node
  DiagramLayout wrapped_;
  std::vector<NetToRoute> nets_;
  std::vector<std::size_t> row_of_net_;
  std::vector<Vector2d> low_, high_;  ///< of each row
};

}  // namespace

void wrap(const LayoutGraph& graph, DiagramLayout& layout) {
  Vector2d size(0, 0);
  for (std::size_t v = 0; v < graph.nodes.size(); ++v) {
    if (graph.nodes[v].rank != LayoutRank::free) return;  // terminals stand at the sides
    size = size.cwiseMax(layout.corners[v] + graph.nodes[v].size);
  }
  const auto is_long = [](double width, double height) {
    return width > kWidest && width > kLongest * height;
  };
  if (!is_long(size.x(), size.y())) return;
  const std::vector<std::size_t> layer = layered::assign_layers(graph);
  const std::size_t layers = *std::max_element(layer.begin(), layer.end()) + 1;
  std::vector<double> left(layers, size.x()), right(layers, 0);
  for (std::size_t v = 0; v < layer.size(); ++v) {
    left[layer[v]] = std::min(left[layer[v]], layout.corners[v].x());
    right[layer[v]] = std::max(right[layer[v]], layout.corners[v].x() + graph.nodes[v].size.x());
  }
  std::size_t count = 1;
  Rows rows = break_layers(left, right, 1);
  while (count < layers && is_long(rows.width, static_cast<double>(count) * size.y()))
    rows = break_layers(left, right, ++count);
  std::vector<std::size_t> row;
  row.reserve(layer.size());
  for (const std::size_t l : layer) row.push_back(rows.of_layer[l]);
  if (*std::max_element(row.begin(), row.end()) == 0) return;
  Wrapping wrapping(graph, layout, row);
  if (wrapping.run()) layout = wrapping.wrapped();
}

}  // namespace oblique::draw
