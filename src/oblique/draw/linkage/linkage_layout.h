// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/animation/analog_overlay.h>
#include <oblique/draw/chart/axes.h>
#include <oblique/draw/linkage/linkage.h>
#include <oblique/draw/linkage/linkage_parts.h>
#include <oblique/draw/picture/label_placer.h>

namespace oblique::draw {

/// What a picture of a mechanism and an animation share.
struct LinkageLayout {
  Picture background;  ///< title, legend and axes
  Axes axes;
  std::vector<LinkagePart> parts;
  std::vector<Mark> paths;  ///< under blocks and pins
  std::vector<AnalogShape> analog;

  /// Where a part stands in the picture.
  Eigen::Vector2d place(const PartPose& pose) const { return axes.at(pose.at); }
};

LinkageLayout lay_out(const mechanism::Mechanism& mechanism, const LinkageScene& scene);

inline constexpr double kNameSize = 13;  ///< [px]

/// What names have to keep off in a position; `analog`: where the analog mechanism is drawn there, if it is.
LabelPlacer placer_among(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                         const mechanism::Configuration& here, const std::vector<Eigen::Vector2d>& analog);

/// The names of the drawn points beside their pins, "name-B", and "leader-B" for those that stray.
struct NameMarks {
  std::vector<Mark> names, leaders;
};
NameMarks name_marks(const mechanism::Mechanism& mechanism, const LinkageLayout& layout,
                     const mechanism::Configuration& here, const std::vector<Eigen::Vector2d>& analog);

}  // namespace oblique::draw
