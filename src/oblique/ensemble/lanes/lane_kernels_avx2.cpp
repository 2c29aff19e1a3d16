// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_kernels.inc>

#include <oblique/ensemble/lanes/lane_kernels.h>

namespace oblique::ensemble {

const LaneKernels kKernelsAvx2[] = {Kernels<4>::all("avx2"), Kernels<8>::all("avx2"),
                                    Kernels<16>::all("avx2")};

}  // namespace oblique::ensemble
