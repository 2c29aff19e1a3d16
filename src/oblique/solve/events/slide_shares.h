// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <vector>

#include <oblique/solve/events/slide_sides.h>

// The shares of the units that slide. Not installed.
namespace oblique::solve {

/// The rate at which the event function of a unit that has drifted off goes back: what it is off times `rate`
/// [1/s], at most `fastest`.
double way_back(const SlideSides& sides, std::size_t unit, double rate, double fastest);

/// The shares α of several units with which no event function moves but on its way back, at most at the part
/// `most` of the largest rate of any side: Σ weight(α) · d(event function)/dt = 0, by Newton's method from
/// `trial`; linear for units that are not coupled. Where an event function stands still whatever the shares
/// are, any will do for it. The sides are left with the weights of what is found. Nothing where there are
/// none.
std::optional<std::vector<double>> shares_of_coupled(SlideSides& sides, std::vector<double> trial,
                                                     double rate, double most);

}  // namespace oblique::solve
