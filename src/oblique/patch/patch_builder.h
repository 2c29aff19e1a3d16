// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/patch/group_residuals.h>
#include <oblique/patch/machine_time.h>
#include <oblique/patch/patch.h>

namespace oblique::patch {

/// The weight of a residual at the inputs of its servo amplifier: that of the greater inputs of most
/// machines.
inline constexpr double kInputGain = 10;

/// The exact motion over one turn, half a degree apart, from which a patch takes its ranges.
mechanism::Motion patch_motion(const mechanism::Mechanism& mechanism, const mechanism::Structure& structure);

/// What all methods of patching share: scaled signals for points, drives, points that bodies carry, rates,
/// outputs.
class PatchBuilder : private MachineTime, protected PointForms {
 public:
  /// Throws as `MachineTime`, `decompose`, `period` and `find_scaling`.
  PatchBuilder(const mechanism::Mechanism& mechanism, const PatchOptions& options);

 protected:
  using Terms = std::vector<diagram::WeightedSignal>;
  struct PointSignals {
    std::string x, y;
  };

  /// Title, comment and run; `method` ends the title, `remarks` stand in the comment.
  void describe(const std::string& method, const std::string& remarks);
  /// "one turn of 'crank'", or how long the file says: for the remarks.
  std::string span_text() const;
  void add_reference();
  void add_outputs();

  /// Velocities and accelerations of all points: the differentiated conditions of each group, solved by servo
  /// amplifiers. After the positions.
  void add_rates();

  /// `wanted`, or the next free name that a block may have, which is then taken.
  std::string free_name(const std::string& wanted);

  /// Adds a block under `wanted`, or under the next free name that a block may have, and returns the name it
  /// has.
  std::string add_block(const std::string& wanted, std::string type, std::vector<text::Entry> settings,
                        std::string comment = {});

  /// weight · coordinate as a term; a fixed point is a weight on the reference.
  diagram::WeightedSignal x_of(std::size_t point, double weight) const;
  diagram::WeightedSignal y_of(std::size_t point, double weight) const;

  static text::Entry sum_of(const Terms& terms);
  void add_summed_point(std::size_t point, const Terms& x, const Terms& y, const std::string& comment);
  /// Gives the name of its crank generator.
  std::string add_crank(const mechanism::Group& crank);

  /// "2 rad/s", or the law, for comments.
  std::string speed_text(const mechanism::Drive& drive) const;

  /// A block that gives the direction of the body that a drive turns: its name; `drives_` keeps the form.
  std::string add_generator(std::size_t drive, const std::string& comment);

  /// A block that gives the way of a drive along its slide, scaled to stay within ±1 machine unit: its
  /// signal; `drives_` keeps the form.
  std::string add_way(std::size_t drive);

  bool is_known(std::size_t point) const {
    return mechanism_.points[point].fixed || !signals_[point].x.empty();
  }

  /// Points of a body of which P and C are known: M − P = (a + i b)(C − P), with a + i b from the body's own
  /// frame.
  void add_carried_points(const mechanism::Body& body, std::size_t p, std::size_t c);

  /// Takes a point's signals, or its place in the frame, as its form.
  void set_known(std::size_t point);

  /// The form as weighted signals, its constant on the reference.
  Terms terms_of(const LinearForm& form) const;

  /// Adds Σ g ∂g/∂x to the terms of each unknown signal x: `forms` and `gap` are the blocks of the residual's
  /// forms and of g.
  using Gradients = std::map<std::string, Terms>;
  void add_gradients(const Residual& residual, const std::vector<std::string>& forms, const std::string& gap,
                     Gradients& gradients);

  [[noreturn]] void refuse(const mechanism::Group& group, const std::string& why, const std::string& expected,
                           const text::Remedy& remedy) const;

  const PatchOptions& options_;
  mechanism::Structure structure_;
  mechanism::Motion motion_;  ///< exact, half a degree apart: for ranges
  Scaling scaling_;
  double bandwidth_;
  std::vector<PointSignals> signals_;
  std::vector<DriveForms> drives_;
  std::vector<std::pair<LinearForm, std::string>> form_blocks_;  ///< forms that have a block
  std::string one_;
  diagram::Diagram diagram_;

 private:
  class Rates;

  /// The signal of a drive's speed and what 1 machine unit of it is [rad/s] or [length unit/s].
  struct Speed {
    std::string signal;
    double unit = 1;
  };
  const Speed& add_speed(std::size_t drive);

  struct RateSignals {
    std::string vx, vy, ax, ay;
  };
  VectorForm crank_point(const mechanism::Group& crank, const mechanism::BodyPoint& point) const;

  std::vector<Speed> speeds_;              ///< of the drives
  std::vector<RateSignals> rate_signals_;  ///< of the points, once they have rates
  double velocity_unit_ = 1;               ///< 1 machine unit of a velocity [length unit/s of machine time]
  double acceleration_unit_ = 1;           ///< of an acceleration [length unit/s² of machine time]
  std::set<std::string> names_;
};

}  // namespace oblique::patch
