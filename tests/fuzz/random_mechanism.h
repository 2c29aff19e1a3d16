// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "dice.h"

namespace oblique::fuzz {

/// A mechanism before its parts have names and a scale: it is assembled where its points stand.
struct MechanismPlan {
  struct Place {
    double x = 0, y = 0;
  };
  struct Link {
    std::size_t first = 0, second = 0;  ///< points
    std::optional<std::size_t> mark;    ///< a third point of it
  };
  std::vector<Place> points;
  std::size_t fixed = 0;    ///< the first ones are those of the frame
  std::vector<Link> links;  ///< the first one is the crank, about point 0
  struct Slide {
    std::size_t point = 0, from = 0, to = 0;  ///< `point` on the line through the others
  };
  std::optional<Slide> slide;
};

/// A four-bar, a slider-crank, a six-bar or a triad with a short crank.
MechanismPlan plan_mechanism(Dice& dice);

/// How a plan is written: the other names run backwards, and so may the links.
struct MechanismWriting {
  bool other_names = false, other_order = false;
  double scale = 1;
};
std::string text_of(const MechanismPlan& plan, const MechanismWriting& writing = {});
std::string point_name(std::size_t point, const MechanismWriting& writing = {});

}  // namespace oblique::fuzz
