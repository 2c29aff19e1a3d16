// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/linkage/linkage.h>
#include <oblique/draw/picture/svg.h>

namespace oblique::draw {

/// A mechanism that moves, again and again.
struct LinkageAnimation {
  LinkageScene scene;  ///< paths, and what has to fit; `others` are not drawn
  std::vector<mechanism::Configuration>
      frames;  ///< at equal distances of time, none of them open; the last as the first
  std::vector<std::vector<Eigen::Vector2d>>
      analog_frames{};                ///< with `scene.analog`: its points in each frame [length unit]
  std::vector<std::string> captions;  ///< one for each frame: where it stands
  double duration = 4;                ///< of a round [s]
  int width = 0;                      ///< on the screen [px]; 0: at 100 %
};

/// SVG that moves by itself (SMIL): parts are shifted and turned, so that the motion is smooth between
/// frames.
std::string animated_svg(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation,
                         Theme theme);

struct MovingGroup;

/// The same picture frame by frame, each with its caption. What stands still is the same in all of them.
class AnimationFrames {
 public:
  AnimationFrames(const mechanism::Mechanism& mechanism, const LinkageAnimation& animation);
  ~AnimationFrames();
  AnimationFrames(const AnimationFrames&) = delete;
  AnimationFrames& operator=(const AnimationFrames&) = delete;

  Picture picture(std::size_t frame) const;

 private:
  Picture background_;
  std::vector<MovingGroup> groups_;
  std::vector<std::string> captions_;
};

}  // namespace oblique::draw
