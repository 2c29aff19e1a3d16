// SPDX-License-Identifier: MIT
// What each verb prints and writes when all is well.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include "../support/process.h"

namespace oblique::test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

class Verbs : public testing::Test {
 protected:
  Verbs() : folder_(std::filesystem::temp_directory_path() / ("oblique-verbs-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
  }
  ~Verbs() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }

  /// Rows of a CSV file, the header apart; empty fields are NaN.
  static std::vector<std::vector<double>> csv_rows(const std::string& path, std::string& header) {
    std::ifstream stream(path);
    std::getline(stream, header);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(stream, line);) {
      std::vector<double>& row = rows.emplace_back();
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) {
        row.push_back(field.empty() ? std::nan("") : std::strtod(field.c_str(), nullptr));
      }
    }
    return rows;
  }

 private:
  std::filesystem::path folder_;
};

TEST_F(Verbs, WithoutArgumentsTheProgramIntroducesItself) {
  const Outcome outcome = oblique("");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("First steps:"));
  for (const char* verb : {"run", "check", "solve", "patch", "compare", "fit", "blocks"})
    EXPECT_THAT(outcome.out, HasSubstr(verb));
}

TEST_F(Verbs, RunWritesAllRowsAndTheLawOfCosines) {
  const Outcome outcome = oblique("run diagrams/lessons/triangle-side.toml -o " + file("side.csv"));
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("3.14159  0.699995"));
  std::string header;
  const auto rows = csv_rows(file("side.csv"), header);
  EXPECT_EQ(header, "t,side");
  ASSERT_EQ(rows.size(), 1001U);
  for (const auto& row : rows) {
    // 1/(2 gain) = 5e-6 of static error, and tolerance.
    EXPECT_NEAR(row[1], std::sqrt(0.09 + 0.16 - 0.24 * std::cos(row[0])), 6e-6);
  }
}

TEST_F(Verbs, RunChecksExpectations) {
  const Outcome good = oblique("run diagrams/lessons/division.toml --check");
  EXPECT_EQ(good.status, 0);
  EXPECT_THAT(good.out, HasSubstr("ok      quotient at 0 ="));
  const Outcome bad = oblique("run diagrams/lessons/division.toml --set q.gain=10 --check");
  EXPECT_EQ(bad.status, 1);
  EXPECT_THAT(bad.out, HasSubstr("FAILED  quotient at 0 = 0.5, expected 0.6 ± 2e-08"));
}

TEST_F(Verbs, RunTakesAnotherEndAndUnits) {
  const Outcome outcome =
      oblique("run diagrams/lessons/circle.toml --until '500 ms' -o " + file("circle.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::string header;
  const auto rows = csv_rows(file("circle.csv"), header);
  EXPECT_EQ(rows.back()[0], 0.5);
  EXPECT_NEAR(rows.back()[1], std::cos(0.5), 1e-6);  // a tolerance of 1e-8 a step, some dozen steps
}

TEST_F(Verbs, SolveWritesTheColumnsOfTheContract) {
  const Outcome outcome =
      oblique("solve diagrams/mechanisms/four-bar.toml --positions 13 -o " + file("motion.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::string header;
  const auto rows = csv_rows(file("motion.csv"), header);
  EXPECT_THAT(header, testing::StartsWith("t,crank,B.x,B.y,B.vx,B.vy,B.ax,B.ay,C.x"));
  EXPECT_THAT(header, testing::EndsWith(".angle,CD.omega,CD.alpha,status"));
  ASSERT_EQ(rows.size(), 13U);
  for (const auto& row : rows) {
    EXPECT_NEAR(row[2], std::cos(row[1]), 1e-12);
    EXPECT_NEAR(std::hypot(row[8] - row[2], row[9] - row[3]), 3.5, 1e-12);
  }
}

TEST_F(Verbs, PatchWritesADiagramThatRuns) {
  const Outcome patched =
      oblique("patch diagrams/mechanisms/six-bar.toml --gain 1e5 -o " + file("patched.toml"));
  ASSERT_EQ(patched.status, 0) << patched.err;
  EXPECT_THAT(patched.err, HasSubstr("run it with: oblique run "));
  const Outcome checked = oblique("check " + file("patched.toml"));
  EXPECT_EQ(checked.status, 0);
  EXPECT_THAT(checked.out, HasSubstr("7 states, 5 of them servo amplifiers"));
  const Outcome run = oblique("run " + file("patched.toml") + " -o " + file("analog.csv"));
  ASSERT_EQ(run.status, 0) << run.err;
  std::string header;
  const auto rows = csv_rows(file("analog.csv"), header);
  EXPECT_EQ(rows.size(), 361U);
  EXPECT_THAT(header, testing::StartsWith("t,B.x,B.y,C.x,C.y,E.x,E.y,F.x,F.y"));
  // The link BC is 140 mm long; the gain of 1e5 costs 1e-3 mm.
  for (const auto& row : rows) EXPECT_NEAR(std::hypot(row[3] - row[1], row[4] - row[2]), 140, 2e-3);
}

TEST_F(Verbs, PatchPrintsToStdoutWithoutAFile) {
  const Outcome outcome = oblique("patch diagrams/mechanisms/four-bar.toml --bandwidth '1 kHz'");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("bandwidth = 1000 }"));
}

TEST_F(Verbs, CompareGivesTheJsonOfTheContract) {
  const Outcome outcome =
      oblique("compare diagrams/mechanisms/four-bar.toml --gain 1e3,1e4 --json -o " + file("c.json"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("mechanism"), "Four-bar linkage with a coupler point");
  EXPECT_EQ(json.at("method"), "triangles");
  EXPECT_EQ(json.at("size"), 3.5);
  EXPECT_NEAR(json.at("order").get<double>(), -1, 0.05);
  ASSERT_EQ(json.at("runs").size(), 2U);
  for (const auto& run : json.at("runs")) {
    for (const char* key : {"gain", "max_error", "rms_error", "steps", "seconds", "overloads", "stable"}) {
      EXPECT_TRUE(run.contains(key)) << key;
    }
    EXPECT_EQ(run.at("stable"), true);
  }
  std::ifstream stream(file("c.json"));
  EXPECT_EQ(nlohmann::json::parse(stream).at("size"), 3.5);
}

TEST_F(Verbs, CheckDescribesDiagramsAndMechanisms) {
  const Outcome diagram = oblique("check diagrams/lessons/division.toml");
  EXPECT_EQ(diagram.status, 0);
  EXPECT_THAT(diagram.out, HasSubstr("algebraic loop with 1 unknown: xq, q"));
  const Outcome mechanism = oblique("check diagrams/mechanisms/jansen.toml");
  EXPECT_EQ(mechanism.status, 0);
  EXPECT_THAT(mechanism.out, HasSubstr("13 bodies, mobility 1, 1 drive"));
}

TEST_F(Verbs, CheckTakesAMechanismWithoutDrivesForAStructure) {
  const std::string head =
      "format = \"oblique-mechanism/1\"\n[frame]\nA = [0, 0]\nD = [4, 0]\n[bodies]\nAC = { points = [\"A\", "
      "\"C\"], length = ";
  const std::string tail = " }\nDC = { points = [\"D\", \"C\"], length = 3 }\n[sketch]\nC = [2, 2]\n";
  std::ofstream(file("truss.toml")) << head << 2 << tail;
  const Outcome stands = oblique("check " + file("truss.toml"));
  EXPECT_EQ(stands.status, 0) << stands.err;
  EXPECT_THAT(stands.out, HasSubstr("2 bodies, mobility 0, 0 drives"));
  EXPECT_THAT(stands.out, HasSubstr("ok: a structure, which can be assembled and does not move"));
  std::ofstream(file("apart.toml")) << head << 0.5 << tail;
  const Outcome apart = oblique("check " + file("apart.toml"));
  EXPECT_EQ(apart.status, 1);
  EXPECT_THAT(apart.err, HasSubstr("dyad 'AC-DC' cannot be assembled at the start"));
}

TEST_F(Verbs, CheckReadsAPipe) {
  const Outcome diagram =
      run_command("cat diagrams/lessons/division.toml | oblique check /dev/stdin", OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(diagram.status, 0) << diagram.err;
  EXPECT_THAT(diagram.out, HasSubstr("algebraic loop with 1 unknown"));
  const Outcome mechanism =
      run_command("cat diagrams/mechanisms/four-bar.toml | oblique check /dev/stdin", OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(mechanism.status, 0) << mechanism.err;
}

TEST_F(Verbs, BlocksListsAndTells) {
  EXPECT_THAT(oblique("blocks").out, ContainsRegex("servo-amplifier +Drives its output until"));
  const Outcome page = oblique("blocks servo-amplifier");
  EXPECT_THAT(page.out, HasSubstr("open-loop gain μ; inf: the ideal amplifier"));
  EXPECT_THAT(page.out, HasSubstr("\"der(out)\" = \"2*pi*bandwidth*(-out - gain*in)\""));
}

TEST_F(Verbs, AFolderOfOwnBlocksExtendsTheLibrary) {
  std::ofstream(file("doubler.toml"))
      << "format = \"oblique-block/1\"\ntitle = \"Doubler\"\nsummary = \"Doubles.\"\n"
         "[inputs]\nin = { doc = \"x\" }\n[outputs]\nout = { doc = \"2 x\" }\n"
         "[equations]\nout = \"2*in\"\n";
  const std::string folder = std::filesystem::path(file("doubler.toml")).parent_path().string();
  EXPECT_THAT(oblique("blocks doubler --blocks " + folder).out, HasSubstr("Doubler (doubler)"));
}

}  // namespace
}  // namespace oblique::test
