// SPDX-License-Identifier: MIT
// What each verb prints and writes when all is well.
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "verbs.h"

namespace oblique::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Verbs, VersionTellsOfTheSolverToo) {
  const Outcome outcome = oblique("--version");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, ContainsRegex("^oblique [0-9.]+\nsolver: SUNDIALS [0-9.]+(, compiled with "
                                         "optimisation| as it was installed [^\n]+)\n$"));
}

TEST_F(Verbs, WithoutArgumentsTheProgramIntroducesItself) {
  const Outcome outcome = oblique("");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("First steps:"));
  for (const char* verb : {"run", "check", "solve", "patch", "compare", "fit", "blocks", "machines"})
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

TEST_F(Verbs, RunTakesOtherWeightsOfInputs) {
  const std::string run = "run diagrams/lessons/triangle-side.toml -o ";
  const Outcome outcome = oblique(run + file("number.csv") + " --set 'c.in[4]=1.5'");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::string header;
  const auto rows = csv_rows(file("number.csv"), header);
  ASSERT_EQ(rows.size(), 1001U);
  for (const auto& row : rows) {
    // c² − a² − b² + w a b cos φ = 0 with w = 1.5 in place of 2; 1/(2 gain) = 5e-6 of static error, and
    // tolerance.
    EXPECT_NEAR(row[1], std::sqrt(0.09 + 0.16 - 1.5 * 0.12 * std::cos(row[0])), 6e-6);
  }
  ASSERT_EQ(oblique(run + file("signal.csv") + " --set 'c.in[abc]=3/2'").status, 0);
  EXPECT_EQ(csv_rows(file("signal.csv"), header), rows);
}

TEST_F(Verbs, RunTellsHowManyDigitsStand) {
  const Outcome outcome = oblique("run diagrams/lessons/damped-oscillator.toml --trust --check");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("trust: errors of the outputs, from a run at a tolerance of 1e-12 by adams and a "
                        "run at a tolerance of 1e-12 by rodas\n"));
  EXPECT_THAT(outcome.err, HasSubstr("digits at the end"));
  EXPECT_THAT(outcome.out, Not(HasSubstr("trust")));
  EXPECT_THAT(oblique("run diagrams/lessons/damped-oscillator.toml").err, Not(HasSubstr("trust")));
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
  EXPECT_THAT(header, ::testing::StartsWith("t,crank,B.x,B.y,B.vx,B.vy,B.ax,B.ay,C.x"));
  EXPECT_THAT(header, ::testing::EndsWith(".angle,CD.omega,CD.alpha,status"));
  ASSERT_EQ(rows.size(), 13U);
  for (const auto& row : rows) {
    EXPECT_NEAR(row[2], std::cos(row[1]), 1e-12);
    EXPECT_NEAR(std::hypot(row[8] - row[2], row[9] - row[3]), 3.5, 1e-12);
  }
}

/// Holds the numbers of the other formats against those of the CSV file, column by column. All rows of a
/// `status` are ok.
void expect_same_numbers(const std::string& header, const std::vector<std::vector<double>>& rows,
                         const std::string& npy, const std::string& mat, const nlohmann::json& json) {
  std::vector<std::string> names;
  std::istringstream fields(header);
  for (std::string name; std::getline(fields, name, ',');) names.push_back(name);
  const std::size_t npy_data = npy.size() - rows.size() * names.size() * sizeof(double);
  EXPECT_EQ(npy_data % 64, 0U);
  std::size_t mat_at = 0;
  for (std::size_t c = 0; c < names.size(); ++c) {
    EXPECT_THAT(npy.substr(0, npy_data), HasSubstr("('" + names[c] + "', '<f8')"));
    EXPECT_EQ(json.at("columns").at(c).at("name"), names[c]);
    mat_at += 20 + names[c].size() + 1;
    for (std::size_t r = 0; r < rows.size(); ++r) {
      double from_npy = 0, from_mat = 0;
      std::memcpy(&from_npy, npy.data() + npy_data + (r * names.size() + c) * sizeof(double), sizeof(double));
      std::memcpy(&from_mat, mat.data() + mat_at, sizeof(double));
      mat_at += sizeof(double);
      if (names[c] == "status") {
        EXPECT_EQ(from_npy, 0);
        EXPECT_EQ(from_mat, 0);
        EXPECT_EQ(json.at("rows").at(r).at(c), "ok");
        continue;
      }
      EXPECT_EQ(from_npy, rows[r][c]);
      EXPECT_EQ(from_mat, rows[r][c]);
      EXPECT_EQ(json.at("rows").at(r).at(c).get<double>(), rows[r][c]);
    }
  }
  EXPECT_EQ(mat_at, mat.size());
}

TEST_F(Verbs, RunAndSolveWriteTheSameNumbersInAllFormats) {
  for (const char* const command :
       {"solve diagrams/mechanisms/six-bar.toml --positions 29", "run diagrams/lessons/triangle-side.toml",
        "run diagrams/lessons/circle.toml --until 1 --columns y,t",
        "solve diagrams/mechanisms/jansen.toml --positions 5 --columns P5.x,status,t"}) {
    for (const char* const name : {"a.csv", "a.npy", "a.mat", "a.json"}) {
      const Outcome outcome = oblique(command + std::string(" -o ") + file(name));
      EXPECT_EQ(outcome.status, 0) << outcome.err;
      EXPECT_THAT(outcome.err, HasSubstr("wrote " + file(name) + "\n"));
    }
    std::string header;
    const auto rows = csv_rows(file("a.csv"), header);
    expect_same_numbers(header, rows, bytes_of("a.npy"), bytes_of("a.mat"),
                        nlohmann::json::parse(bytes_of("a.json")));
  }
}

TEST_F(Verbs, SolveWritesTheColumnsThatAreAskedForInTheirOrder) {
  ASSERT_EQ(oblique("solve diagrams/mechanisms/jansen.toml --columns status,P5.x --positions 3 -o " +
                    file("foot.csv"))
                .status,
            0);
  EXPECT_THAT(bytes_of("foot.csv"),
              ContainsRegex("^status,P5.x\nok,-?[0-9.]+\nok,-?[0-9.]+\nok,-?[0-9.]+\n$"));
}

TEST_F(Verbs, SolveWritesWhereAMechanismCannotBeAssembledAsANumber) {
  std::ofstream(file("open.toml")) << "format = \"oblique-mechanism/1\"\n[frame]\nA = [0, 0]\nD = [4, "
                                      "0]\n[bodies]\nAB = { points = [\"A\", "
                                      "\"B\"], length = 2 }\nBC = { points = [\"B\", \"C\"], length = 2 "
                                      "}\nCD = { points = [\"C\", \"D\"], "
                                      "length = 1.5 }\n[drives]\ncrank = { turns = \"AB\", about = \"A\", "
                                      "speed = 1 }\n[sketch]\nC = [3.5, 1]\n";
  const std::string solve = "solve " + file("open.toml") + " --positions 3 --columns C.x,status -o ";
  for (const char* const name : {"a.csv", "a.npy", "a.json"}) {
    const Outcome outcome = oblique(solve + file(name));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.err, HasSubstr("1 of 3 positions cannot be assembled"));
  }
  EXPECT_THAT(bytes_of("a.csv"), HasSubstr("\n,open\n"));
  EXPECT_THAT(bytes_of("a.json"), HasSubstr("[null, \"open\"]"));
  const std::string npy = bytes_of("a.npy");
  double record[2] = {};
  std::memcpy(record, npy.data() + npy.size() - 2 * sizeof(record), sizeof(record));
  EXPECT_TRUE(std::isnan(record[0]));
  EXPECT_EQ(record[1], 2);
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
  EXPECT_THAT(header, ::testing::StartsWith("t,B.x,B.y,C.x,C.y,E.x,E.y,F.x,F.y"));
  // The link BC is 140 mm long; the gain of 1e5 costs 1e-3 mm.
  for (const auto& row : rows) EXPECT_NEAR(std::hypot(row[3] - row[1], row[4] - row[2]), 140, 2e-3);
}

TEST_F(Verbs, PatchPrintsToStdoutWithoutAFile) {
  const Outcome outcome = oblique("patch diagrams/mechanisms/four-bar.toml --bandwidth '1 kHz'");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("bandwidth = 1000 }"));
  EXPECT_THAT(outcome.err, HasSubstr("its servo loops come to rest everywhere"));
  EXPECT_THAT(oblique("patch diagrams/mechanisms/four-bar.toml --unit '0.1 m'").err,
              HasSubstr("warning: it overloads the machine"));
}

// A slider-crank beside a dead centre at 270°, where the gradient goes over into the other assembly mode.
TEST_F(Verbs, PatchTellsOfAModeThatItsRunLeaves) {
  std::ofstream(file("crank.toml")) << R"(format = "oblique-mechanism/1"
[units]
length = "mm"
[frame]
A = [0, 0]
X = [100, 0]
[bodies]
AB = { points = ["A", "B"], length = 30 }
BC = { points = ["B", "C"], length = 50.0001 }
[slides]
piston = { point = "C", along = ["A", "X"], offset = 20 }
[drives]
crank = { turns = "AB", about = "A", speed = "60 rpm", start = "0 deg" }
[sketch]
C = [75, 20]
)";
  const std::string patch = "patch " + file("crank.toml") + " -o " + file("patched.toml");
  EXPECT_THAT(oblique(patch + " --method gradient").err,
              HasSubstr("warning: its run goes over into another assembly mode, from crank = 27"));
  EXPECT_THAT(oblique(patch).err, Not(HasSubstr("assembly mode")));
}

// With the crank upright B = (0, 1): |BD|² = 17, and C is where circles of 3.5 about B and of 3 about D meet.
TEST_F(Verbs, ModesAreThoseWhereTheDriveIsAskedToStand) {
  const auto modes =
      nlohmann::json::parse(oblique("modes diagrams/mechanisms/four-bar.toml --at '90 deg' --json").out);
  ASSERT_EQ(modes.at("groups").at(1).at("modes").size(), 2U);
  for (const auto& mode : modes.at("groups").at(1).at("modes")) {
    const double x = mode.at("points").at("C").at(0), y = mode.at("points").at("C").at(1);
    EXPECT_NEAR(std::hypot(x, y - 1), 3.5, 1e-12);
    EXPECT_NEAR(std::hypot(x - 4, y), 3, 1e-12);
  }
}

// A triad with a parallelogram, whose branch from the start ends before a quarter turn of the crank, closes
// there in four others.
TEST_F(Verbs, ModesSaysThatAPositionIsNotReachedFromTheStart) {
  std::ofstream(file("m.toml")) << R"toml(format = "oblique-mechanism/1"
[frame]
O = [-0.2, 0]
G2 = [3, 0]
G3 = [5, 0]
[bodies]
crank = { points = ["O", "A"], length = 0.2 }
leg1 = { points = ["A", "P1"], length = 2.785677655436824 }
leg2 = { points = ["G2", "P2"], length = 1.6552945357246849 }
leg3 = { points = ["G3", "P3"], length = 1.6552945357246849 }
plat = { points = ["P2", "P3"], length = 2, marks = { P1 = [-2.7, 1.1] } }
[drives]
crank = { turns = "crank", about = "O", speed = "1 rad/s" }
[sketch]
P1 = [1, 2.6]
P2 = [3.7, 1.5]
P3 = [5.7, 1.5]
)toml";
  const Outcome outcome = oblique("modes " + file("m.toml") + " --at '90 deg'");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("(class 3): 4 modes"));
  EXPECT_EQ(outcome.err,
            "the mechanism does not come there from its start: it can only be assembled there anew\n");
}

/// A command that prints JSON, or writes $SCRATCH/x.json.
struct JsonCall {
  std::string name, arguments;
};

class Json : public ::testing::TestWithParam<JsonCall> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, Json,
    ::testing::Values(
        JsonCall{"CheckDiagram", "check diagrams/lessons/division.toml --json"},
        JsonCall{"CheckMechanism", "check diagrams/mechanisms/four-bar.toml --json"},
        JsonCall{"Modes", "modes diagrams/mechanisms/four-bar.toml --json"},
        JsonCall{"Machines", "machines --json"},
        JsonCall{"Compare", "compare diagrams/mechanisms/four-bar.toml --gain 1e3,1e4 --json"},
        JsonCall{"CompareScattered",
                 "compare diagrams/mechanisms/four-bar.toml --gain 1e3 --tolerance 1% "
                 "--monte-carlo 3 --json"},
        JsonCall{"CompareOnMachine", "compare diagrams/mechanisms/four-bar.toml --machine model-1 --json"},
        JsonCall{"CompareToFile", "compare diagrams/mechanisms/four-bar.toml --gain 1e3 -o $SCRATCH/x.json"},
        JsonCall{"Run", "run diagrams/lessons/division.toml -o $SCRATCH/x.json"},
        JsonCall{"Solve", "solve diagrams/mechanisms/four-bar.toml -o $SCRATCH/x.json"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(Json, IsTheSameBytesTwice) {
  const std::string to_file =
      GetParam().arguments.find("x.json") == std::string::npos ? "" : " >$SCRATCH/out && cat $SCRATCH/x.json";
  const std::string command = "oblique " + GetParam().arguments + to_file;
  const Outcome once = run_command(command, OBLIQUE_SOURCE_DIR);
  EXPECT_LE(once.status, 1) << once.err;  // 1: the check finds something
  ASSERT_TRUE(nlohmann::json::accept(once.out)) << once.out << once.err;
  EXPECT_EQ(run_command(command, OBLIQUE_SOURCE_DIR).out, once.out);
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
  EXPECT_THAT(oblique("blocks multiplier").out, HasSubstr("[let]\nproduct = \"x*y + offset\"\n"))
      << "what its equations name";
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
