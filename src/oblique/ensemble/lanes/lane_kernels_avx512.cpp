// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_kernels.inc>

#include <oblique/ensemble/lanes/lane_kernels.h>

namespace oblique::ensemble {

const LaneKernels kKernelsAvx512[] = {Kernels<4>::all("avx512"), Kernels<8>::all("avx512"),
                                      Kernels<16>::all("avx512")};

}  // namespace oblique::ensemble
