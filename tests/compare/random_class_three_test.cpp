// SPDX-License-Identifier: MIT
// The short version of tests/bench/class_three_bench.cpp.
#include <gtest/gtest.h>

#include "../support/random_class_three.h"

namespace oblique::compare {
namespace {

TEST(RandomClassThree, IsTrackedByBothMethods) {
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    const mechanism::Mechanism mechanism = testing::random_class_three(seed);
    for (const patch::PatchMethod method : {patch::PatchMethod::triangles, patch::PatchMethod::gradient}) {
      const testing::Tracking result = testing::track(mechanism, method, library);
      EXPECT_TRUE(result.tracks) << "seed " << seed << ", " << patch::method_name(method) << ": "
                                 << result.explanation;
    }
  }
}

}  // namespace
}  // namespace oblique::compare
