// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/ensemble/lanes/lane_code.h>

// Not installed.
namespace oblique::ensemble {

/// How many numbers of lanes there are: 4, 8 and 16.
inline constexpr int kWidths = 3;

// One source, compiled three times.
extern const LaneKernels kernels_sse2[kWidths], kernels_avx2[kWidths], kernels_avx512[kWidths];

}  // namespace oblique::ensemble
