// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include <oblique/compare/analog_motion.h>
#include <oblique/draw/linkage/linkage.h>

#include <oblique/report/linkage_scene.h>

namespace oblique::report {

/// The patched mechanism as pictures show it over the exact one, its errors magnified.
class MagnifiedAnalog {
 public:
  /// Patches and runs it for a scene, and tells `progress`; `moments` [s], in any order, are further ones for
  /// which it will be asked. Throws as `analog_places`.
  MagnifiedAnalog(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                  const patch::PatchOptions& options, double magnification, const TimedScene& timed,
                  const std::vector<double>& moments, const std::function<void(double fraction)>& progress);

  /// exact + magnification · (analog − exact) of all points at a moment [length unit].
  std::vector<Eigen::Vector2d> points(double time, const mechanism::Configuration& exact) const;

  /// What is drawn over the scene, with the largest error of its motion in the caption.
  draw::AnalogOverlay overlay(const TimedScene& timed) const;

  /// A remark where the magnified errors are too small to be seen, or larger than the mechanism; or nothing.
  std::string remark(const text::Vocabulary& vocabulary = text::plain_vocabulary()) const;

 private:
  void measure(double time, const mechanism::Configuration& exact);

  const mechanism::Mechanism& mechanism_;
  double magnification_;
  std::vector<double> moments_;
  compare::AnalogPlaces places_;
  double largest_ = 0;  ///< error [length unit]
  double worst_time_ = 0;
  std::size_t worst_point_ = 0;
};

}  // namespace oblique::report
