// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/fingerprint.h>

#include <gtest/gtest.h>

namespace oblique::ensemble {
namespace {

// The value of no bytes, as the specification of XXH3 has it.
TEST(Fingerprint, IsThatOfXxh3) {
  EXPECT_EQ(fingerprint_of(""), "99aa06d3014798d86001c324468d497f");
}

TEST(Fingerprint, KnowsWhereATextEnds) {
  EXPECT_EQ(Fingerprint().add("a", "bc").text(), Fingerprint().add("a", "bc").text());
  EXPECT_NE(Fingerprint().add("a", "bc").text(), Fingerprint().add("ab", "c").text());
  EXPECT_NE(Fingerprint().add("a", "bc").text(), Fingerprint().add("a", "b").add("", "c").text());
}

}  // namespace
}  // namespace oblique::ensemble
