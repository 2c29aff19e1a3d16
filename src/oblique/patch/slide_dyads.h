// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <oblique/patch/patch_builder.h>

namespace oblique::patch {

/// Triangles for groups of one unknown point or one unknown body: RRP, RPR, PRP, RPP, and drives along
/// slides.
class SlideDyadPatch : protected PatchBuilder {
 protected:
  using PatchBuilder::PatchBuilder;

  /// Whether there is a block for a group of one unknown point or body.
  static bool has_circuit(const mechanism::Group& group);

  static LinearForm constant(double value);

  /// local [length unit] turned by the axis of the unknown body [machine unit].
  VectorForm arm(const Eigen::Vector2d& local) const;

  static Eigen::Vector2d turned(const Eigen::Vector2d& v, const mechanism::BodyState& by);

  static VectorForm sum(const VectorForm& a, double factor, const VectorForm& b);

  /// Where an unknown point lies, as signals, and where that is in a configuration [length unit].
  struct Locus {
    bool circle = false;
    VectorForm at, direction;
    double radius = 0;
    std::function<Eigen::Vector2d(const mechanism::Configuration&)> place, heading;
  };

  Locus locus(const mechanism::Group& group, const mechanism::Condition& c);

  /// The direction of the unknown body's x axis, where it is given.
  void set_axis(const mechanism::Condition& angle);

  template <class Length>
  double largest_over_motion(Length length) const {
    double largest = 0;
    for (const mechanism::Configuration& here : motion_.configurations)
      largest = std::max(largest, length(here));
    return round_up(scaled(std::max(largest, scaling_.length * 1e-3)));
  }

  std::vector<text::Entry> with_amplifiers(std::vector<text::Entry> settings) const;

  /// A form for an input that takes one signal: a summer stands before it where it has more terms.
  text::Entry wire(const std::string& block, const char* port, const LinearForm& form);

  /// Places the unknown point or body of a group and all that it carries.
  void add_group(const mechanism::Group& group);

  /// The points of a body whose axis and one point are known.
  void carry(std::size_t index, std::size_t base, const VectorForm& at);

  /// RPR: the axis of a body hinged to P from its line through Q.
  void add_own_line(const mechanism::Group& group, const mechanism::Condition& hinge,
                    const mechanism::Condition& on_line, const std::string& name);

  /// RRP and PRP: where a circle or a line meets a line.
  VectorForm add_crossing(const mechanism::Group& group, const Locus& first, const Locus& second,
                          const std::string& name);

  /// A point that a drive moves along a line.
  VectorForm add_slider(const mechanism::Group& group, const mechanism::Condition& along,
                        const std::string& name);

  VectorForm axis_;  ///< of the body that is being placed
};

}  // namespace oblique::patch
