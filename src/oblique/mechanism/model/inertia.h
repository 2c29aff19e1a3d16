// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

#include <oblique/mechanism/model/configuration.h>
#include <oblique/mechanism/model/drive_law.h>

namespace oblique::mechanism {

/// Whether any body has a mass.
bool has_masses(const Mechanism& mechanism);

/// Moment of inertia of a body with a mass [kg m²], as a uniform bar of length L between its first two points
/// and of width S, about its middle:
///
///     J = m (L² + S²)/12
///
/// (The J(L, S, m) = ¼ (L − S) S m of Ihnatyshyn et al. is another thing: a quarter of what
/// two masses at the ends of a bar have whose centre of mass lies S from one end. It is 0 for S = 0.)
double bar_inertia(const Mechanism& mechanism, std::size_t body);

/// Kinetic energy of the bodies with masses [J]: T = ½ Σ (m v² + J ω²), v of a bar's middle.
double kinetic_energy(const Mechanism& mechanism, const Configuration& here);

/// Moment of inertia of all bodies, reduced to the first drive [kg m²], or for one that moves a prismatic
/// joint [kg]: 2T/ṡ², along the motion that the drives make together. NaN where the drive stands still.
double reduced_inertia(const Mechanism& mechanism, const Configuration& here, const DriveState& drive);

/// Length unit of the file in metres.
double length_in_metres(const Mechanism& mechanism);

}  // namespace oblique::mechanism
