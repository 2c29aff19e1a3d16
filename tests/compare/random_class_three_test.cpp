// SPDX-License-Identifier: MIT
// The short version of tests/bench/class_three_bench.cpp.
#include <gtest/gtest.h>

#include "../support/random_class_three.h"

namespace oblique {
namespace {

TEST(RandomClassThree, IsTrackedByBothMethods) {
  const BlockLibrary library = BlockLibrary::shipped();
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const Mechanism mechanism = testing::random_class_three(seed);
    for (const PatchMethod method : {PatchMethod::triangles, PatchMethod::gradient}) {
      const testing::Tracking result = testing::track(mechanism, method, library);
      EXPECT_TRUE(result.tracks) << "seed " << seed << ", " << method_name(method) << ": "
                                 << result.explanation;
    }
  }
}

}  // namespace
}  // namespace oblique
