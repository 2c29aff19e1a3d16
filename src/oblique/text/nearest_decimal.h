// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::text {

/// A finite value rounded to so many significant decimal digits (at most 17), in every locale.
double nearest_decimal(double value, int digits);

}  // namespace oblique::text
