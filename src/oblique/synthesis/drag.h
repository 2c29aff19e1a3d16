// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::synthesis {

/// A point that somebody drags away from where its mechanism stands.
struct DraggedPoint {
  std::size_t point = 0;                         ///< index in Mechanism::points
  Eigen::Vector2d to = Eigen::Vector2d::Zero();  ///< [length unit]
  double drive = 0;                              ///< where the first drive stands [rad] or [length unit]
  mechanism::Configuration here;                 ///< of the mechanism there
};

/// A dimension that was changed.
struct ChangedNumber {
  std::string name;  ///< as of a DesignSpace
  double before = 0, after = 0;
};

/// The mechanism with the lengths that this takes.
struct DraggedMechanism {
  std::string text;  ///< the file with other numbers, every other byte as it was
  std::vector<ChangedNumber> numbers;
  double drive = 0;  ///< where the first drive stands then: that of a dragged crank turns [rad]
  Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< of the point [length unit]
  bool sketch_moved = false;       ///< the old sketch would have picked another assembly mode
  mechanism::Configuration there;  ///< of this mechanism at `drive`
};

/// Changes the lengths of the links that carry a point so that it comes to stand elsewhere, while the other
/// points of these links stay where they are. The pin of a crank takes the crank with it, which then is
/// longer or shorter; a pivot in the frame takes the cranks about it with it. A point of a prismatic joint
/// stays on its line: it goes to the foot of where it is wanted. Dimensions are rounded to about 1e-5 of the
/// largest length.
///
/// Throws SynthesisError: kind `request` where the file's dimensions cannot say it (a link that keeps an
/// angle to a line, two points in one place); kind `nowhere` where the mechanism could be assembled there
/// in another mode only; MechanismError where it cannot be assembled.
DraggedMechanism drag(const std::string& text, const mechanism::Mechanism& mechanism,
                      const DraggedPoint& dragged);

}  // namespace oblique::synthesis
