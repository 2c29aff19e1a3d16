// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <oblique/mechanism/solver/group_equations.h>
#include <oblique/patch/linear_form.h>
#include <oblique/patch/scaling.h>

namespace oblique::patch {

/// Where the points of a mechanism are, and what its bodies carry, as forms of signals [machine unit].
class PointForms {
 public:
  explicit PointForms(const mechanism::Mechanism& mechanism)
      : mechanism_(mechanism), points_(mechanism.points.size()) {}

  /// Takes the scale and gives the points of the frame their place: before anything else is asked.
  void set_scale(const Scaling& scaling);

  double scaled(double length) const { return length / unit_; }
  const std::string& name_of(std::size_t point) const { return mechanism_.points[point].name; }

  /// Takes a pair of signals as a point's place.
  void set_signals(std::size_t point, const std::string& x, const std::string& y);

  /// A vector of a body's frame [length unit], per length unit, and a point of it [machine unit], in the
  /// world: by the two points that stand for the body, its first two where nothing else is said.
  VectorForm direction_of(std::size_t body, const Eigen::Vector2d& local);
  VectorForm point_of(std::size_t body, const Eigen::Vector2d& local);

  struct LineForm {
    VectorForm at, direction;
  };
  LineForm line_form(const std::optional<std::size_t>& carrier, const mechanism::LineRef& line);

  const mechanism::Mechanism& mechanism_;
  std::vector<std::optional<VectorForm>> points_;  ///< of those that have a place
  std::map<std::size_t, std::pair<mechanism::BodyPoint, mechanism::BodyPoint>>
      bases_;  ///< the two points that stand for a body

 private:
  const std::pair<mechanism::BodyPoint, mechanism::BodyPoint>& base_of(std::size_t body);

  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double unit_ = 1;  ///< 1 machine unit [length unit]
};

}  // namespace oblique::patch
