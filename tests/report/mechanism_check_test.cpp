// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/report/mechanism_check_text.h>

namespace oblique::report {
namespace {

using ::testing::ContainsRegex;

std::string check_of(const std::string& name) {
  const std::string path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name;
  return to_text(examine(mechanism::read_mechanism(path), name));
}

// Oldham's coupling hands the turn of one shaft on to the other.
TEST(MechanismCheck, SaysWhatTurnsAndWhatSwings) {
  EXPECT_THAT(check_of("oldham.toml"), ContainsRegex("disc2 +turns left"));
  EXPECT_THAT(check_of("four-bar.toml"), ContainsRegex("CD +swings"));
}

}  // namespace
}  // namespace oblique::report
