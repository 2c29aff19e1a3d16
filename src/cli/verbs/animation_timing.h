// SPDX-License-Identifier: MIT
#pragma once

#include "verbs/command.h"

namespace oblique::cli {

/// How many positions a round has and how long it lasts.
struct AnimationTiming {
  int frames = 90;
  double duration = 4;  ///< [s]
  int delay = 0;        ///< of each frame of a GIF [1/100 s]
};

/// What --frames, --duration and --rate ask for. A GIF shows its frames for whole hundredths of a second,
/// at least two: the rate comes out as the next of 50, 33.3, 25, 20 …, and `frames` and `delay` say how long
/// a round really lasts. Throws ReadError where the three contradict each other, where a GIF cannot have
/// them, and for a rate of what is no GIF.
AnimationTiming timing_of(const AnimateRequest& request, bool gif);

/// "25 frames a second, 4 s a round".
std::string pace_text(int frames, int delay);

/// Whether a round of `frames` lasts and runs as was asked for, to half a per cent.
bool keeps_pace(const AnimateRequest& request, int frames, int delay);

}  // namespace oblique::cli
