// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <oblique/mechanism/solver/group_equations.h>
#include <oblique/patch/linear_form.h>
#include <oblique/patch/scaling.h>

namespace oblique::patch {

/// The signals of a point's coordinates [machine unit].
struct PointSignals {
  std::string x, y;
};

/// The book of where the points of a mechanism are, and what its links carry, as forms of signals [machine
/// unit]. A point of the frame has its place from the beginning; any other gets a form of other points'
/// signals or signals of its own, which then are its form.
class PointBook {
 public:
  /// The mechanism has to outlive it.
  PointBook(const mechanism::Mechanism& mechanism, const Scaling& scaling);

  const mechanism::Mechanism& mechanism() const { return mechanism_; }
  double scaled(double length) const { return length / unit_; }
  const std::string& name_of(std::size_t point) const { return mechanism_.points[point].name; }

  bool has(std::size_t point) const { return forms_[point].has_value(); }
  const VectorForm& at(std::size_t point) const { return forms_[point].value(); }
  void set(std::size_t point, VectorForm form) { forms_[point] = std::move(form); }

  bool has_signals(std::size_t point) const { return !signals_[point].x.empty(); }
  const PointSignals& signals(std::size_t point) const { return signals_[point]; }
  /// Takes a pair of signals as a point's place.
  void set_signals(std::size_t point, PointSignals signals);

  /// Takes two points to stand for a link: its first two where nothing is said.
  void set_base(std::size_t body, std::size_t p, std::size_t c);

  /// Gives the points of a link of which the base is known their forms.
  void carry(std::size_t body);

  /// A vector of a link's frame [length unit], per length unit, and a point of it [machine unit], in the
  /// world, by the two points that stand for the link.
  VectorForm direction_of(std::size_t body, const Eigen::Vector2d& local) const;
  VectorForm point_of(std::size_t body, const Eigen::Vector2d& local) const;

  struct LineForm {
    VectorForm at, direction;
  };
  LineForm line_form(const std::optional<std::size_t>& carrier, const mechanism::LineRef& line) const;

 private:
  using Base = std::pair<mechanism::BodyPoint, mechanism::BodyPoint>;
  Base base_of(std::size_t body) const;

  const mechanism::Mechanism& mechanism_;
  Eigen::Vector2d origin_;
  double unit_;  ///< 1 machine unit [length unit]
  std::vector<std::optional<VectorForm>> forms_;
  std::vector<PointSignals> signals_;
  std::map<std::size_t, Base> bases_;  ///< of links that others than their first two points stand for
};

}  // namespace oblique::patch
