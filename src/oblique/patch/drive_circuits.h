// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// A block that gives the direction of the link that a drive turns: its name. The circuit's drive gets the
/// form.
std::string add_generator(Circuit& circuit, std::size_t drive, const std::string& comment);

/// A block that gives the way of a drive along its prismatic joint, scaled to stay within ±1 machine unit:
/// its signal. The circuit's drive gets the form.
std::string add_way(Circuit& circuit, std::size_t drive);

/// A crank with all its points. Gives the name of its generator.
std::string add_crank(Circuit& circuit, const mechanism::Group& crank);

/// A point of a crank, by the direction that its drive gives.
VectorForm crank_point(const PointBook& places, const DriveForms& drive, const mechanism::Group& crank,
                       const mechanism::BodyPoint& point);

}  // namespace oblique::patch
