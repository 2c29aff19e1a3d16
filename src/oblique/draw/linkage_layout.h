// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/axes.h>
#include <oblique/draw/linkage.h>
#include <oblique/draw/linkage_parts.h>

namespace oblique {

/// What a picture of a mechanism and an animation share.
struct LinkageLayout {
  Picture background;  ///< title, legend, axes and paths
  Axes axes;
  std::vector<LinkagePart> parts;
  std::vector<Mark> paths;  ///< those of the background that names should keep off

  /// Where a part stands in the picture.
  Eigen::Vector2d place(const PartPose& pose) const { return axes.at(pose.at); }
};

LinkageLayout lay_out(const Mechanism& mechanism, const LinkageScene& scene);

/// The names of the drawn points beside their pins, one for each point drawn, in order of the points.
std::vector<Mark> name_marks(const Mechanism& mechanism, const LinkageLayout& layout,
                             const Configuration& here);

}  // namespace oblique
