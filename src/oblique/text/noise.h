// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::text {

/// Smooth noise, the same at every call: of unit root mean square over x, without a repeat, correlated over a
/// distance of about 3. The quintic B-spline through Gaussian random numbers at the whole numbers, which
/// follow from `seed` (rounded) alone; its spectrum is that of white noise times sinc(f)¹², with the −3 dB
/// point at f = 0.186. `derivative` 1 gives d noise/dx.
double noise(double x, double seed, int derivative = 0);

}  // namespace oblique::text
