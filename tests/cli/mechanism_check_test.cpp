// SPDX-License-Identifier: MIT
// What check says of a mechanism, and the columns that solve --analysis adds.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../support/process.h"
#include "../support/scratch_folder.h"
#include "../support/tangent.h"

namespace oblique::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class MechanismCheck : public ::testing::Test {
 protected:
  MechanismCheck() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~MechanismCheck() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name, const std::string& text = "") const {
    const std::string path = (folder_ / name).string();
    if (!text.empty()) std::ofstream(path) << "format = \"oblique-mechanism/1\"\n" << text;
    return path;
  }

 private:
  std::filesystem::path folder_;
};

const std::string kDoubleRocker = R"([units]
length = "mm"
[frame]
A = [0, 0]
D = [100, 0]
[bodies]
AB = { points = ["A", "B"], length = 60 }
BC = { points = ["B", "C"], length = 70 }
CD = { points = ["C", "D"], length = 80 }
[drives]
rocker = { turns = "AB", about = "A", speed = "60 rpm", start = "30 deg" }
[sketch]
C = [100, 80]
)";

const std::string kSliderCrank = R"([units]
length = "mm"
[frame]
A = [0, 0]
X = [250, 0]
[bodies]
AB = { points = ["A", "B"], length = 50, mass = 0.4, width = 10 }
BC = { points = ["B", "C"], length = 150, mass = 0.9 }
[slides]
piston = { point = "C", along = ["A", "X"], offset = 40 }
[drives]
crank = { turns = "AB", about = "A", speed = "1500 rpm" }
[sketch]
C = [190, 40]
)";

TEST_F(MechanismCheck, WritesJsonOfFilesWhoseNamesAreNotUtf8) {
  const ScratchFolder folder;
  const std::filesystem::path copy = folder / "oblique-caf\xe9.toml";
  std::filesystem::copy_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml", copy);
  const Outcome outcome = oblique("check --json '" + copy.string() + "'");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("oblique-caf\uFFFD.toml\""));
}

TEST_F(MechanismCheck, PrintsATableForEachSubject) {
  const Outcome outcome = oblique("check diagrams/mechanisms/four-bar.toml");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(
      outcome.out,
      AllOf(HasSubstr("ok: it can be assembled over the whole turn, without dead centres\n\nfour-bar"),
            HasSubstr("frame-AB-BCM-CD  crank-rocker  AB                     5        6.5\n"),
            HasSubstr("BCM-CD  transmission angle  54.31°          0.00   100.29°        180.00\n"),
            HasSubstr("CD    swings     -78.58         40.80        -38.62        228.51       39.96"),
            HasSubstr("B          6.2832     3.1416        -1       1      -1       1\n"),
            HasSubstr("BCM       4      0\n"), Not(HasSubstr("remarks"))));
}

TEST_F(MechanismCheck, SaysNoAndBetweenWhichLimitsItMoves) {
  const Outcome outcome = oblique("check " + file("d.toml", kDoubleRocker));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out,
              AllOf(HasSubstr("no: over one turn the group BC-CD cannot be assembled at t = 0.299649 s\n"),
                    HasSubstr("range of 'rocker': from -137.87° (BC-CD) to 137.87° (BC-CD);"),
                    HasSubstr("frame-AB-BC-CD  triple rocker  AB"),
                    HasSubstr("remarks\n  the transmission angle of BC-CD rises to 180.00° (above 150°) at "
                              "rocker = -137.87°\n")));
  const auto answer = nlohmann::json::parse(oblique("check --json " + file("d.toml")).out);
  EXPECT_FALSE(answer.at("ok").get<bool>());
  const double limit = std::acos((60. * 60 + 100 * 100 - 150 * 150) / (2 * 60 * 100));
  EXPECT_NEAR(answer.at("tour").at("forward_limit").at("drive").get<double>(), limit, 1e-9);
  EXPECT_NEAR(answer.at("tour").at("backward_limit").at("drive").get<double>(), -limit, 1e-9);
  EXPECT_EQ(answer.at("tour").at("forward_limit").at("group"), "BC-CD");
  EXPECT_TRUE(answer.at("paths").at(0).at("area").is_null());
}

TEST_F(MechanismCheck, ADriveThatMovesASlideHasARange) {
  const std::string text = R"([frame]
O = [0, 0]
X = [100, 0]
Y = [0, 100]
[bodies]
bar = { points = ["A", "B"], length = 120 }
[slides]
across = { point = "A", along = ["O", "X"] }
up     = { point = "B", along = ["O", "Y"] }
[drives]
block = { slides = "across", speed = 10, start = 30 }
[sketch]
B = [0, 110]
)";
  const Outcome outcome = oblique("check " + file("t.toml", text));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, AllOf(HasSubstr("ok: it can be assembled between the limits of its drive\n"),
                                 HasSubstr("range of 'block': from -120 m (bar) to 120 m (bar)")));
}

TEST_F(MechanismCheck, TellsOfMotionThroughInfinity) {
  const std::string path =
      file("tangent.toml", std::string(kTangent) +
                               "[drives]\ncrank = { turns = \"arm\", about = \"O\", speed = \"60 rpm\" }\n");
  const Outcome checked = oblique("check " + path);
  EXPECT_EQ(checked.status, 1);
  EXPECT_THAT(
      checked.out,
      AllOf(HasSubstr("no: over one turn the group block goes to infinity at t = 0.25 s\n"),
            HasSubstr("range of 'crank': from -90.00° (block, which is at infinity) to 90.00° (block, "
                      "which is at infinity);")));
  const Outcome solved = oblique("solve " + path + " --positions 91");
  EXPECT_EQ(solved.status, 0);
  EXPECT_THAT(
      solved.err,
      AllOf(HasSubstr(
                "infinity at crank = 90 deg: block recedes to infinity and comes back from the other side\n"),
            HasSubstr("infinity at crank = 270 deg: ")));
}

TEST_F(MechanismCheck, SolveTellsWhereABranchEndsAndBeginsAgain) {
  const Outcome outcome = oblique("solve " + file("d.toml", kDoubleRocker) + " --positions 361");
  EXPECT_EQ(outcome.status, 1);
  // arccos(−89/120) = 137.873… degrees, and as much before a whole turn
  EXPECT_THAT(outcome.err,
              AllOf(HasSubstr("limit at rocker = 137.87"),
                    HasSubstr(" deg: a dead centre of BC-CD, which cannot be assembled beyond\n"),
                    HasSubstr("from rocker = 222.12"),
                    HasSubstr(" deg on BC-CD can be assembled again, on the branch that it left\n")));
}

TEST_F(MechanismCheck, JsonHasTheDocumentedKeysAlone) {
  const auto answer = nlohmann::json::parse(oblique("check --json " + file("s.toml", kSliderCrank)).out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : answer.items()) keys.push_back(key);
  EXPECT_THAT(keys, ::testing::UnorderedElementsAre(
                        "file", "kind", "title", "bodies", "mobility", "drives", "groups", "ok", "finding",
                        "length_unit", "mobility_by_rank", "four_bars", "sliders", "tour", "transmissions",
                        "swings", "paths", "instant_centres", "inertia", "remarks"));
  EXPECT_EQ(answer.at("mobility_by_rank").at("verdict"), "agrees");
  EXPECT_EQ(answer.at("sliders").at(0).at("rotation"), "the crank turns fully");
  const auto& piston = answer.at("swings").at(1);
  EXPECT_EQ(piston.at("slide"), "piston");
  EXPECT_NEAR(piston.at("stroke").get<double>(), std::sqrt(38400.) - std::sqrt(8400.), 1e-10);
  EXPECT_EQ(answer.at("instant_centres").size(), 3U);
  EXPECT_NEAR(answer.at("inertia").at("bars").at(1).at("inertia").get<double>(), 0.9 * 0.0225 / 12, 1e-17);
  const std::string four_bar = OBLIQUE_SOURCE_DIR "/diagrams/mechanisms/four-bar.toml";  // without masses
  EXPECT_TRUE(nlohmann::json::parse(oblique("check --json " + four_bar).out).at("inertia").is_null());
}

TEST_F(MechanismCheck, OfAStructureNeedsNoDrive) {
  const std::string text = R"([frame]
A = [0, 0]
B = [4, 0]
[bodies]
AC = { points = ["A", "C"], length = 3 }
BC = { points = ["B", "C"], length = 3 }
[sketch]
C = [2, 2]
)";
  const Outcome outcome = oblique("check " + file("f.toml", text));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("ok: a structure, which can be assembled and does not move\n"));
  const auto answer = nlohmann::json::parse(oblique("check --json " + file("f.toml")).out);
  EXPECT_TRUE(answer.at("tour").is_null());
  EXPECT_EQ(answer.at("mobility_by_rank").at("mobility"), 0);
}

TEST_F(MechanismCheck, OverconstrainedOnesAreToldWhetherTheyClose) {
  const std::string text = R"([units]
length = "mm"
[frame]
A = [0, 0]
D = [80, 0]
F = [40, 0]
[bodies]
AB  = { points = ["A", "B"], length = 40 }
BCE = { points = ["B", "C"], length = 80, marks = { E = [40, 0] } }
DC  = { points = ["D", "C"], length = 40 }
FE  = { points = ["F", "E"], length = 40 }
[drives]
crank = { turns = "AB", about = "A", speed = "60 rpm", start = "60.5 deg" }
[sketch]
C = [100, 35]
)";
  const Outcome outcome = oblique("check " + file("o.toml", text));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(
      outcome.err,
      AllOf(HasSubstr("the mechanism has mobility 0"),
            HasSubstr("the revolute joint of 'FE' at 'E' in the loop AB-BCE-DC-FE is redundant: it closes "
                      "all the same, and by rank the mechanism has mobility 1")));
}

/// The values of a column of a CSV file, by the name in its header.
std::vector<double> column(const std::string& path, const std::string& name) {
  std::ifstream stream(path);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(stream, line);) {
    rows.emplace_back();
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  std::vector<double> values;
  for (std::size_t c = 0; c < rows.at(0).size(); ++c) {
    if (rows[0][c] != name) continue;
    for (std::size_t r = 1; r < rows.size(); ++r)
      values.push_back(rows[r][c].empty() ? std::nan("") : std::stod(rows[r][c]));
  }
  return values;
}

TEST_F(MechanismCheck, SolveAddsTheColumnsOfTheAnalysis) {
  const std::string path = file("s.csv");
  const Outcome outcome =
      oblique("solve " + file("s.toml", kSliderCrank) + " --analysis --positions 5 -o " + path);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(column(path, "B.dy"),
              ::testing::Pointwise(::testing::DoubleNear(1e-12), {50., 0., -50., 0., 50.}));
  EXPECT_THAT(column(path, "BC.icx").at(0),
              ::testing::DoubleNear(50 + std::sqrt(150. * 150 - 40 * 40), 1e-9));
  EXPECT_THAT(column(path, "BC.pressure").at(3), ::testing::DoubleNear(std::asin(90. / 150), 1e-12));
  EXPECT_EQ(column(path, "crank.inertia").size(), 5U);
  EXPECT_EQ(column(path, "crank.energy").size(), 5U);
  EXPECT_EQ(column(path, "piston.ddposition").size(), 5U);
  const Outcome plain = oblique("solve " + file("s.toml") + " --positions 5 -o " + path);
  EXPECT_EQ(plain.status, 0);
  EXPECT_TRUE(column(path, "B.dy").empty());
}

TEST_F(MechanismCheck, AnalysisColumnsNeedAFile) {
  const Outcome outcome = oblique("solve diagrams/mechanisms/four-bar.toml --analysis");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--analysis has no file to write its columns to"));
}

}  // namespace
}  // namespace oblique::test
