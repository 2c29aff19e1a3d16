// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/ensemble/lanes/lane_code.h>

// Not installed.
namespace oblique::ensemble {

/// Those of the best instruction set that this processor has, or of `set` ("sse2", "avx2", "avx512") where it
/// has that, for 4, 8 or 16 lanes; null where there are none.
const LaneKernels* lane_kernels(int width, const char* set = nullptr);

}  // namespace oblique::ensemble
