// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/draw/linkage/linkage_parts.h>

// Not installed.
namespace oblique::draw {

inline constexpr double kSliderLength = 30, kSliderHeight = 18;  ///< [px]
inline constexpr double kThinLine = 1.3;                         ///< of edges [px]
/// Of the inside of a link, and of the colour of what is driven.
inline constexpr double kInsideOpacity = 0.6;

/// The slider blocks of all prismatic joints. Those that are driven lie over the others, for a point may
/// slide on several lines; they have the colour of drives, and an arrow.
std::vector<LinkagePart> slider_blocks(const mechanism::Mechanism& mechanism);

/// Whether the drive of a driven prismatic joint moves it towards the first point of its line. Where it
/// rests, that is as it sets off.
bool goes_back(const mechanism::Mechanism& mechanism, std::size_t slide,
               const mechanism::Configuration& here);

}  // namespace oblique::draw
