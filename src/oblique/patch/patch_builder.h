// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/structure.h>
#include <oblique/patch/linear_form.h>
#include <oblique/patch/patch.h>
#include <oblique/patch/scaling.h>

namespace oblique {

/// The exact motion over one turn, half a degree apart, from which a patch takes its ranges.
Motion patch_motion(const Mechanism& mechanism, const Structure& structure);

/// What all methods of patching share: scaled signals for points, cranks, points that bodies carry, outputs.
class PatchBuilder {
 public:
  /// Throws as `decompose` and `find_scaling`, and PatchError for drives with a law.
  PatchBuilder(const Mechanism& mechanism, const PatchOptions& options);

 protected:
  using Terms = std::vector<WeightedSignal>;
  struct PointSignals {
    std::string x, y;
  };

  /// Title, comment and run; `method` ends the title, `remarks` stand in the comment.
  void describe(const std::string& method, const std::string& remarks);
  void add_reference();
  void add_outputs();

  const std::string& name_of(std::size_t point) const { return mechanism_.points[point].name; }
  double scaled(double length) const { return length / scaling_.length; }

  /// `wanted`, or the next free name that a block may have, which is then taken.
  std::string free_name(const std::string& wanted);

  /// Adds a block under `wanted`, or under the next free name that a block may have, and returns the name it
  /// has.
  std::string add_block(const std::string& wanted, std::string type, std::vector<Entry> settings,
                        std::string comment = {});

  /// weight · coordinate as a term; a fixed point is a weight on the reference.
  WeightedSignal x_of(std::size_t point, double weight) const;
  WeightedSignal y_of(std::size_t point, double weight) const;

  static Entry sum_of(const Terms& terms);
  void add_summed_point(std::size_t point, const Terms& x, const Terms& y, const std::string& comment);
  /// Gives the name of its crank generator.
  std::string add_crank(const Group& crank);
  bool is_known(std::size_t point) const {
    return mechanism_.points[point].fixed || !signals_[point].x.empty();
  }

  /// Points of a body of which P and C are known: M − P = (a + i b)(C − P), with a + i b from the body's own
  /// frame.
  void add_carried_points(const Body& body, std::size_t p, std::size_t c);

  /// Takes a point's signals, or its place in the frame, as its form.
  void set_known(std::size_t point);

  /// A vector of a body's frame [length unit], per length unit, and a point of it [machine unit], in the
  /// world: by the two points that stand for the body, its first two where nothing else is said.
  VectorForm direction_of(std::size_t body, const Eigen::Vector2d& local);
  VectorForm point_of(std::size_t body, const Eigen::Vector2d& local);

  struct LineForm {
    VectorForm at, direction;
  };
  LineForm line_form(const std::optional<std::size_t>& carrier, const LineRef& line);

  /// The form as weighted signals, its constant on the reference.
  Terms terms_of(const LinearForm& form) const;

  [[noreturn]] void refuse(const Group& group, const std::string& why, const std::string& expected,
                           const std::string& remedy) const;

  const Mechanism& mechanism_;
  const PatchOptions& options_;
  Structure structure_;
  Motion motion_;  ///< exact, half a degree apart: for ranges
  Scaling scaling_;
  double bandwidth_;
  std::vector<PointSignals> signals_;
  std::vector<std::optional<VectorForm>> points_;                 ///< of those that have a place
  std::map<std::size_t, std::pair<BodyPoint, BodyPoint>> bases_;  ///< the two points that stand for a body
  std::string one_;
  Diagram diagram_;

 private:
  const std::pair<BodyPoint, BodyPoint>& base_of(std::size_t body);

  std::set<std::string> names_;
};

}  // namespace oblique
