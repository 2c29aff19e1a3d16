// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/linkage.h>
#include <oblique/draw/svg.h>

namespace oblique {

/// A mechanism that moves, again and again.
struct LinkageAnimation {
  LinkageScene scene;  ///< paths, and what has to fit; `others` are not drawn
  std::vector<Configuration>
      frames;  ///< at equal distances of time, none of them open; the last as the first
  std::vector<std::string> captions;  ///< one for each frame: where it stands
  double duration = 4;                ///< of a round [s]
};

/// SVG that moves by itself (SMIL): parts are shifted and turned, so that the motion is smooth between
/// frames.
std::string animated_svg(const Mechanism& mechanism, const LinkageAnimation& animation, Theme theme);

/// One HTML file with the same picture, a button to play and pause, and a slider. Nothing is loaded from
/// elsewhere; it stands still at first for readers who want less motion.
std::string animated_page(const Mechanism& mechanism, const LinkageAnimation& animation, Theme theme);

}  // namespace oblique
