// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/draw/picture/picture.h>
#include <oblique/draw/picture/scale.h>

namespace oblique::draw {

/// How far a number goes from its middle with each of several others: a bar for each, the longest on top, so
/// that they look like a tornado.
struct EffectBars {
  struct Bar {
    std::string name;
    double low = 0, high = 0;             ///< the ends
    std::string low_label, high_label{};  ///< what stands beside them
  };
  Axis axis;
  double middle = 0;
  std::vector<Bar> bars;  ///< in their order, from the top
};

/// One under the other. Bar b of panel p has the id "bar-p-b".
Picture draw_effect_bars(const std::string& title, const std::vector<EffectBars>& panels,
                         const std::string& note, double width = 720);

}  // namespace oblique::draw
