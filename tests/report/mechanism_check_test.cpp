// SPDX-License-Identifier: MIT
#include <oblique/report/mechanism_check.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/report/mechanism_check_text.h>

namespace oblique::report {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;

std::string check_of(const std::string& name) {
  const std::string path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name;
  return to_text(examine(mechanism::read_mechanism(path), name));
}

// Oldham's coupling hands the turn of one shaft on to the other.
TEST(MechanismCheck, SaysWhatTurnsAndWhatSwings) {
  EXPECT_THAT(check_of("oldham.toml"), ContainsRegex("disc2 +turns left"));
  EXPECT_THAT(check_of("four-bar.toml"), ContainsRegex("CD +swings"));
}

// The cranks of a parallelogram lie in one line with its frame twice a turn.
TEST(MechanismCheck, SaysWhereTheDriveStandsAtAChangePoint) {
  const mechanism::Mechanism parallelogram = mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [80, 0]
[bodies]
AB = { points = ["A", "B"], length = 40 }
BC = { points = ["B", "C"], length = 80 }
CD = { points = ["C", "D"], length = 40 }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "60 deg" }
[sketch]
C = [100, 35]
)",
                                                                        "p.toml");
  const std::string text = to_text(examine(parallelogram, "p.toml"));
  EXPECT_THAT(text, HasSubstr("\n  change point of BC-CD at crank = 180.00°\n"
                              "  change point of BC-CD at crank = 0.00°\n"));
}

}  // namespace
}  // namespace oblique::report
