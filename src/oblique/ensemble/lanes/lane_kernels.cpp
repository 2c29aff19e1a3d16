// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_kernels.h>

#include <array>
#include <cmath>
#include <limits>
#include <string_view>

#include <oblique/ensemble/lanes/kernels_of_set.h>
#include <oblique/network/graph/expression_graph.h>
#include <oblique/network/program/tape.h>
#include <oblique/text/noise.h>

namespace oblique::ensemble {
namespace {

/// The widest instructions first.
#if defined(__x86_64__)
constexpr std::array<const LaneKernels*, 3> kSets{kernels_avx512, kernels_avx2, kernels_sse2};
#else
constexpr std::array<const LaneKernels*, 1> kSets{kernels_sse2};
#endif

/// Whether this processor has an instruction set.
bool has(std::string_view set) {
#if defined(__x86_64__)
  if (set == "avx512") return __builtin_cpu_supports("avx512f") != 0;
  if (set == "avx2") return __builtin_cpu_supports("avx2") != 0;
#endif
  return set == "sse2";
}

}  // namespace

const LaneKernels* lane_kernels(int width, const char* set) {
  for (const LaneKernels* const kernels : kSets) {
    if (!has(kernels->set) || (set != nullptr && std::string_view(set) != kernels->set)) continue;
    for (int k = 0; k < kWidths; ++k) {
      if (kernels[k].width == width) return &kernels[k];
    }
  }
  return nullptr;
}

double lane_other(std::uint32_t code, double a, double b, double c) {
  using Code = network::Instruction::Code;
  switch (static_cast<Code>(code)) {
#define OBLIQUE_OPERATION(name, operands, traits, value_of_ab, by_a, by_b) \
  case Code::name:                                                         \
    return value_of_ab;
#include <oblique/text/operations.def>
    case Code::select:
      return network::select(a, b, c);
    case Code::gate:
      return a == 0 ? 0 : a * b;
    case Code::less:
      return a < b ? 1 : 0;
    case Code::less_equal:
      return a <= b ? 1 : 0;
    case Code::equal:
      return a == b ? 1 : 0;
    default:  // tables, which lanes do not run
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace oblique::ensemble
