// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/patch/circuit.h>

namespace oblique::patch {

/// weight · coordinate as a term, of a point with signals; of a fixed point a weight on the reference.
diagram::WeightedSignal x_of(const Circuit& circuit, std::size_t point, double weight);
diagram::WeightedSignal y_of(const Circuit& circuit, std::size_t point, double weight);

/// Summers for the coordinates of a point, which become its signals.
void add_summed_point(Circuit& circuit, std::size_t point, const Terms& x, const Terms& y,
                      const std::string& comment);

/// Summers for those points that a group places and that are but forms so far.
void add_formed_points(Circuit& circuit, const mechanism::Group& group);

/// Points of a link of which P and C are known: M − P = (a + i b)(C − P), with a + i b from the link's own
/// frame.
void add_carried_points(Circuit& circuit, const mechanism::Body& body, std::size_t p, std::size_t c);

/// The gain and the bandwidth of servo amplifiers, after other settings.
std::vector<text::Entry> with_amplifiers(const PatchSetup& setup, std::vector<text::Entry> settings);

}  // namespace oblique::patch
