// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_kernels.inc>

#include <oblique/ensemble/lanes/lane_kernels.h>

namespace oblique::ensemble {

const LaneKernels kKernelsSse2[] = {Kernels<4>::all("sse2"), Kernels<8>::all("sse2"),
                                    Kernels<16>::all("sse2")};

}  // namespace oblique::ensemble
