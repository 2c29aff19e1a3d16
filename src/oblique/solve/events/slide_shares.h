// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <oblique/solve/events/slide_sides.h>

// The shares of the units that slide. Not installed.
namespace oblique::solve {

/// The rate at which the event function of a unit that has drifted off goes back: what it is off times `rate`
/// [1/s], at most `fastest`.
double way_back(const SlideSides& sides, std::size_t unit, double rate, double fastest);

/// `trial` with the shares α of the units at `places` with which none of their event functions moves but on
/// its way back, at most at the part `most` of the largest rate of any of them on any side: Σ weight(α) ·
/// d(event function)/dt = 0, by Newton's method from `trial`; linear for units that are not coupled. Where an
/// event function stands still whatever the shares are, any will do for it. The sides are left with the
/// weights of what is found. Nothing where there are none.
std::optional<std::vector<double>> shares_of_coupled(SlideSides& sides, std::vector<double> trial,
                                                     std::span<const std::size_t> places, double rate,
                                                     double most);

/// Of the event function of each of these coupled units, how much faster its upper side drives it up than its
/// lower one, while the shares of the others go along so that theirs stay where they are. Above 0 only where
/// nothing holds them all, however fast each turns over: the determinant of the negative pushes, of each unit
/// on each event function, is below 0, and a root of their motion above it. 0 of all where the pushes are
/// singular, and of one that pushes none or without which the others are not held.
std::vector<double> drives_apart_of_coupled(SlideSides& sides, std::span<const double> shares,
                                            std::span<const std::size_t> places);

}  // namespace oblique::solve
