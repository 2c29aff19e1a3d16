// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <oblique/draw/picture/picture.h>
#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/mechanism.h>

namespace oblique::draw {

/// The patched mechanism as it is drawn over the exact one: all points of it, where their errors are to be
/// seen [length unit].
struct AnalogOverlay {
  std::vector<std::vector<Eigen::Vector2d>> motion;  ///< at the moments of LinkageScene::motion
  std::vector<Eigen::Vector2d> shown;                ///< with LinkageScene::shown
  std::string legend;                                ///< "analog, error ×1000"
  std::string caption;                               ///< "largest error 0.02 mm at C"
};

/// What a picture of a mechanism shows. Configurations that are open are passed over.
struct LinkageScene {
  std::vector<mechanism::Configuration>
      motion;  ///< the whole way, in order: for traces, and for what has to fit
  std::vector<mechanism::Configuration> others;  ///< further positions, faint ones first
  mechanism::Configuration shown;                ///< the position that is drawn in full
  std::vector<std::size_t> traces;  ///< points whose paths are drawn, indices in Mechanism::points
  std::string caption;              ///< where it stands: "crank = 80°"
  std::optional<AnalogOverlay> analog{};
};

/// The points whose paths are worth a look: marks of links that are not pinned to the frame; without such
/// marks the revolute joints between such links. Points that only go round, or to and fro on a guide, are
/// none.
std::vector<std::size_t> points_to_trace(const mechanism::Mechanism& mechanism);

/// A mechanism as a picture to scale: links, revolute joints, supports, guides and blocks, with names, paths
/// and a grid. The centre of the mark "pin-B" is the point B, as the axes' numbers tell; "analog-pin-B" is
/// that of the analog mechanism.
Picture draw_linkage(const mechanism::Mechanism& mechanism, const LinkageScene& scene);

}  // namespace oblique::draw
