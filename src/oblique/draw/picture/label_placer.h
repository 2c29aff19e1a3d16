// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <oblique/draw/picture/picture.h>

namespace oblique::draw {

/// A name strays if it is farther than this from its point [px]; a leader line then tells whose it is.
inline constexpr double kFarthestBeside = 25;

/// Where the leader line from the point `at` meets the rectangle of its name [px]; nothing where the name is
/// beside its point.
std::optional<Eigen::Vector2d> leader_end(const Eigen::AlignedBox<double, 2>& name,
                                          const Eigen::Vector2d& at);

/// A leader line; two corners [px].
Mark leader_mark(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const std::string& point);

/// Finds places for names beside points: of eight places around, and farther ones where all eight are taken,
/// the one that covers least.
class LabelPlacer {
 public:
  /// Labels stay within `frame` [px] if they can.
  explicit LabelPlacer(const Eigen::AlignedBox<double, 2>& frame) : frame_(frame) {}

  /// Keeps labels off the lines of a mark, and off its inside where it is filled: the more the greater
  /// `weight`.
  void avoid(const Mark& mark, double weight);

  /// The weights of all that the name of the point `at` would touch at `place` [px], those of the names
  /// and pins that its leader line would cross, and far more where it leaves the frame.
  double cost(const Eigen::AlignedBox<double, 2>& place, const Eigen::Vector2d& at) const;

  /// Keeps the leader lines of other points off a pin.
  void add_pin(const Mark& pin) { signs_.push_back(extent_of(pin)); }

  /// The name of the point `at` stands where the mark is: later ones avoid it and its leader line.
  void add_name(const Mark& name, const Eigen::Vector2d& at);

  /// A label for the point `at` [px], which later ones then avoid.
  Mark place(const Eigen::Vector2d& at, const std::string& text, double size);

 private:
  struct Obstacle {
    std::vector<Eigen::Vector2d> line;  ///< its points in order
    double half_width = 0;
    bool filled = false;
    double weight = 1;
    Eigen::AlignedBox<double, 2> extent;
  };

  Eigen::AlignedBox<double, 2> frame_;
  std::vector<Obstacle> obstacles_;
  /// Names and pins: a leader line that crosses one would seem to be its own.
  std::vector<Eigen::AlignedBox<double, 2>> signs_;
};

}  // namespace oblique::draw
