// SPDX-License-Identifier: MIT
// What check and the static test print, in words and as JSON.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Check : public ::testing::Test {
 protected:
  Check() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~Check() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name, const std::string& blocks = "") const {
    const std::string path = (folder_ / name).string();
    if (!blocks.empty()) std::ofstream(path) << "format = \"oblique-diagram/1\"\n[blocks]\n" << blocks;
    return path;
  }

 private:
  std::filesystem::path folder_;
};

const std::string kOscillator =
    "x = { type = \"integrator\", in = [\"2*v\"] }\n"
    "v = { type = \"integrator\", in = [\"-2*x\", \"-0.4*v\"], initial = 5 }\n";

TEST_F(Check, PrintsLoopsStabilityOverloadsAndScaling) {
  const Outcome outcome = oblique("check diagrams/lessons/triangle-side.toml");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out,
              HasSubstr("ok: all names, wires, units and ranges are right\n\ntrial run: 6.28319 s"));
  EXPECT_THAT(outcome.out, HasSubstr("keeps +    c2, c\n"));
  EXPECT_THAT(outcome.out, HasSubstr("the servo amplifiers: well damped"));
  EXPECT_THAT(outcome.out, HasSubstr("\noverloads\n"));
  EXPECT_THAT(outcome.out, HasSubstr("phi     6.28319   6.28319    0.1     0.628319\n"));
}

TEST_F(Check, JsonHasTheDocumentedKeysAlone) {
  const Outcome outcome = oblique("check diagrams/lessons/triangle-side.toml --json");
  EXPECT_EQ(outcome.status, 0);
  const auto json = nlohmann::json::parse(outcome.out);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_THAT(keys, ::testing::UnorderedElementsAre("file", "kind", "title", "blocks", "elements", "states",
                                                    "servo_amplifiers", "outputs", "run", "loops",
                                                    "stability", "overloads", "scaling", "bill"));
  const auto& unknown = json.at("loops").at(0).at("unknowns").at(0);
  // μ ∂r/∂c = 1e5 · 2 c, with c = 0.1 − 5e-6 at the start.
  EXPECT_NEAR(unknown.at("least_gain").get<double>(), 2e5 * (0.1 - 5e-6), 0.1);
  EXPECT_NEAR(unknown.at("static_error").get<double>(), 5e-5, 1e-8);
  EXPECT_THAT(json.at("loops").at(0).at("members"), ElementsAre("c2", "c"));
  // A lone amplifier: 90° and a little.
  EXPECT_NEAR(json.at("stability").at("margins").at(0).at("degrees").get<double>(), 90, 0.01);
  const auto& overload = json.at("overloads").at(0);
  EXPECT_EQ(overload.at("signal"), "phi");
  EXPECT_NEAR(overload.at("first").get<double>(), 1, 1e-9);  // φ = t
  EXPECT_NEAR(overload.at("duration").get<double>(), 2 * std::numbers::pi - 1, 1e-9);
  EXPECT_EQ(overload.at("scale"), 0.1);
  EXPECT_EQ(json.at("scaling").at("signals").size(), 11U);
}

TEST_F(Check, JsonOfADampedOscillatorHasItsMode) {
  const Outcome outcome = oblique("check --json " + file("o.toml", kOscillator));
  const auto mode = nlohmann::json::parse(outcome.out).at("stability").at("problem_mode");
  // λ² + 0.4 λ + 4 = 0.
  EXPECT_NEAR(mode.at("natural_frequency").get<double>(), 2, 1e-12);
  EXPECT_NEAR(mode.at("damping_ratio").get<double>(), 0.1, 1e-12);
  EXPECT_EQ(mode.at("verdict"), "badly damped");
  EXPECT_EQ(mode.at("participants").size(), 2U);
}

// Two lags in the loop of an amplifier: unstable from a gain of about 320 on (NumPy: +2801 ± 15402i, −27.8°).
std::string through_lags(int gain) {
  return "r = { type = \"constant\", value = 0.5 }\n"
         "a = { type = \"servo-amplifier\", in = [\"l2\", \"-r\"], bandwidth = 10, gain = " +
         std::to_string(gain) +
         " }\nl1 = { type = \"transfer-lag\", in = \"a\", time_constant = 1e-4 }\n"
         "l2 = { type = \"transfer-lag\", in = \"l1\", time_constant = 1e-4 }\n";
}

TEST_F(Check, TextAndJsonGiveOneVerdictAndTheLoopOfEveryMargin) {
  const std::string path = file("l.toml", "");
  for (const int gain : {100, 1000}) {
    std::ofstream(path) << "format = \"oblique-diagram/1\"\n[run]\nuntil = 0.01\n[blocks]\n"
                        << through_lags(gain);
    const Outcome text = oblique("check " + path);
    const auto json = nlohmann::json::parse(oblique("check --json " + path).out);
    const auto& stability = json.at("stability");
    ASSERT_EQ(json.at("loops").size(), 1U);
    EXPECT_THAT(json.at("loops").at(0).at("members"), ElementsAre("a", "l1", "l2"));
    ASSERT_EQ(stability.at("margins").size(), 1U);
    EXPECT_TRUE(stability.at("problem_mode").is_null());
    if (gain == 100) {
      EXPECT_EQ(stability.at("verdict"), "stable");
      EXPECT_THAT(text.out, HasSubstr("  verdict: stable: every mode of the closed system decays\n"));
      EXPECT_NEAR(stability.at("margins").at(0).at("degrees").get<double>(), 37.416325, 1e-4);
    } else {
      EXPECT_EQ(stability.at("verdict"), "servo loops unstable");
      EXPECT_EQ(stability.at("growing"), 2);
      EXPECT_THAT(text.out, HasSubstr("  verdict: unstable by the servo loops, not by the problem: "
                                      "+2.8e+03 ± 1.54e+04i 1/s at t = 0 s\n"));
      EXPECT_THAT(text.out, HasSubstr("  right of the axis: 2 eigenvalues\n"));
      EXPECT_THAT(text.out, HasSubstr("no: the servo loops are unstable from t = 0 s on"));
      EXPECT_NEAR(stability.at("margins").at(0).at("degrees").get<double>(), -27.813490, 1e-4);
    }
  }
}

TEST_F(Check, AmplifiersWithoutALoopAreNotCalledOne) {
  const std::string path = file("m.toml",
                                "x = { type = \"integrator\", in = [\"-x\"], initial = 0.5 }\n"
                                "m = { type = \"multiplier\", in = [\"x\", \"x\"], bandwidth = 1e6 }\n");
  const std::string text = oblique("check " + path).out;
  EXPECT_THAT(text, HasSubstr("loops: no servo loops and no algebraic ones"));
  EXPECT_THAT(text, HasSubstr("the amplifiers by themselves: well damped"));
  EXPECT_THAT(text, Not(HasSubstr("phase margin")));
}

// x′ = (2 cos t − 1) x grows at times, and not along the run.
TEST_F(Check, DoesNotSayOfStoresThatNothingGrows) {
  // One store takes x while the other holds: x(n + 1) = x(n) - 2.1 x(n).
  const Outcome outcome = oblique("check " + file("sampled.toml", R"(one = { type = "constant" }
clk = { type = "pulse-train", width = 0.1 }
nclk = { type = "summer", in = ["one", "-clk"] }
m = { type = "track-and-store", in = "x", track = "nclk" }
h = { type = "track-and-store", in = "m", track = "clk" }
x = { type = "integrator", in = "-2.1*h", initial = 0.01 }
)"));
  EXPECT_THAT(outcome.out, HasSubstr("between events; what switches and stores bring back is not told"));
  const Outcome fed =
      oblique("check " +
              file("fed.toml", "c = { type = \"constant\" }\nx = { type = \"integrator\", in = \"c\" }\n"));
  EXPECT_THAT(fed.out, HasSubstr("no state acts back on itself, so that nothing grows or decays by itself"));
}

TEST_F(Check, NamesNoElementOfAModeOfVeryMany) {
  std::string ring;
  for (int k = 0; k < 250; ++k) {
    const std::string number = std::to_string(k);
    ring += "x" + number + " = { type = \"integrator\", in = [\"-3*x" + number + "\", \"2*x" +
            std::to_string((k + 1) % 250) + "\"], initial = 0.01 }\n";
  }
  EXPECT_THAT(oblique("check " + file("ring.toml", ring)).out,
              HasSubstr("elements: many, each by less than 1 %"));
}

TEST_F(Check, TellsTheGrowthAlongARunThatVaries) {
  const std::string path = file("v.toml", "");
  std::ofstream(path) << R"toml(format = "oblique-diagram/1"
[run]
until = "8*pi"
[blocks]
c = { type = "integrator", in = "-s", initial = 1 }
s = { type = "integrator", in = "c" }
cx = { type = "multiplier", in = ["c", "x"] }
x = { type = "integrator", in = ["2*cx", "-x"], initial = 0.1 }
)toml";
  const std::string text = oblique("check " + path).out;
  EXPECT_THAT(text, HasSubstr("verdict: a mode of the problem itself grows at times, +1 1/s at t = "));
  EXPECT_THAT(text, HasSubstr("and small disturbances do not grow along the run\n"));
  EXPECT_THAT(text, HasSubstr(", -1 1/s in the second half\n"));
  const auto growth = nlohmann::json::parse(oblique("check --json " + path).out).at("stability").at("growth");
  EXPECT_NEAR(growth.at("exponent").get<double>(), -1, 1e-3);
  EXPECT_NEAR(growth.at("to").get<double>(), 8 * std::numbers::pi, 1e-12);
}

// (1 − t²) a = t v − 25 y is singular at t = 1, where y = T₅(t) passes smoothly; the overload of t is there.
TEST_F(Check, ASingularInstantThatTheRunPassesIsNoFailure) {
  const std::string path = file("c.toml", "");
  std::ofstream(path) << R"toml(format = "oblique-diagram/1"
[run]
until = 1.2
[blocks]
one = { type = "constant" }
x = { type = "integrator", in = ["one"] }
xx = { type = "squarer", in = "x" }
w = { type = "summer", in = ["one", "-xx"] }
xv = { type = "multiplier", in = ["x", "v"] }
a = { type = "servo-amplifier", in = ["wa", "-xv", "25*y"], gain = "inf", bandwidth = "inf" }
wa = { type = "multiplier", in = ["w", "a"] }
v = { type = "integrator", in = ["a"], initial = 5 }
y = { type = "integrator", in = ["v"], initial = 0 }
)toml";
  const Outcome outcome = oblique("check --json " + path);
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  bool found = false;
  const auto json = nlohmann::json::parse(outcome.out);
  for (const auto& overload : json.at("overloads")) {
    if (overload.at("signal") != "x") continue;
    found = true;
    EXPECT_NEAR(overload.at("first").get<double>(), 1, 1e-9);
  }
  EXPECT_TRUE(found);
  EXPECT_THAT(oblique("run " + path).err, Not(HasSubstr("leaves the machine")));
}

TEST_F(Check, InfiniteNumbersAreNullInJson) {
  const Outcome outcome = oblique(
      "check --json " + file("i.toml",
                             "z = { type = \"constant\" }\nq = { type = \"servo-amplifier\", in = [\"q\", "
                             "\"-z\"], gain = inf }\n"));
  const auto loop = nlohmann::json::parse(outcome.out).at("loops").at(0);
  EXPECT_EQ(loop.at("type"), "algebraic");
  EXPECT_TRUE(loop.at("unknowns").at(0).at("least_gain").is_null());
  EXPECT_EQ(loop.at("unknowns").at(0).at("static_error"), 0);
}

TEST_F(Check, MechanismsHaveJsonToo) {
  const Outcome outcome = oblique("check diagrams/mechanisms/four-bar.toml --json");
  EXPECT_EQ(outcome.status, 0);
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json.at("kind"), "mechanism");
  EXPECT_EQ(json.at("mobility"), 1);
  EXPECT_EQ(json.at("groups").size(), 2U);
  EXPECT_EQ(json.at("ok"), true);
}

TEST_F(Check, ARunThatFailsIsReportedUpToThere) {
  // The divisor x passes zero at t = 0.5.
  const std::string path = file("b.toml", R"toml(one = { type = "constant" }
x  = { type = "integrator", in = ["-2*one"], initial = 1 }
xq = { type = "multiplier", in = ["x", "q"] }
q  = { type = "servo-amplifier", in = ["xq", "-0.01*one"], gain = 1e4 }
)toml");
  const Outcome text = oblique("check " + path);
  EXPECT_EQ(text.status, 3);
  EXPECT_THAT(text.out, HasSubstr("trial run: failed at t = 0.53"));
  EXPECT_THAT(text.out, HasSubstr("changes at t = 0.5"));
  EXPECT_THAT(text.out, HasSubstr("no: the servo loops are unstable from t = 0.5"));
  EXPECT_THAT(text.err, HasSubstr("error: "));
  const Outcome json = oblique("check --json " + path);
  EXPECT_EQ(json.status, 3);
  EXPECT_TRUE(nlohmann::json::parse(json.out).at("overloads").is_null());
}

TEST_F(Check, ADiagramThatCannotStartIsStillReported) {
  const Outcome outcome = oblique(
      "check " + file("n.toml",
                      "one = { type = \"constant\" }\ncc = { type = \"multiplier\", in = [\"c\", \"c\"] }\n"
                      "c = { type = \"servo-amplifier\", in = [\"cc\", \"one\"] }\n"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_THAT(outcome.out, HasSubstr("it could not start"));
  EXPECT_THAT(outcome.err, HasSubstr("do not come to rest"));
}

TEST_F(Check, RescaleWritesADiagramThatGivesTheSame) {
  const Outcome written = oblique("check " + file("o.toml", kOscillator) + " --rescale -o " + file("s.toml"));
  EXPECT_EQ(written.status, 0);
  EXPECT_THAT(written.err, HasSubstr("0 overloads"));
  EXPECT_THAT(written.err, Not(HasSubstr("warning")));
  EXPECT_THAT(oblique("check " + file("s.toml")).out, HasSubstr("overloads: none"));
  EXPECT_EQ(oblique("run " + file("s.toml")).out, oblique("run " + file("o.toml")).out);
}

// An undamped oscillator of amplitude 5 on a machine that saturates at 1.2, started where the sine is zero:
// its scale is that of 5, not of what is left of it, and scaled it is what it would have been.
TEST_F(Check, ScalesByHowFarSaturatedSignalsWouldGo) {
  const std::string path = file(
      "saturated.toml",
      "x = { type = \"integrator\", in = \"v\", initial = 5 }\nv = { type = \"integrator\", in = \"-x\" }\n"
      "[machine]\nprofile = \"the-analog-thing\"\ninverting = false\n[run]\nuntil = 7\n");
  const Outcome outcome = oblique("check " + path + " --rescale -o " + file("scaled.toml"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("\noverloads (as far as signals would go if no amplifier saturated)\n"));
  EXPECT_THAT(outcome.out, ContainsRegex("\nx +0 +5 .* 0\\.2\n"));
  EXPECT_THAT(outcome.err, HasSubstr("0 overloads"));
  const Outcome scaled = oblique("run " + file("scaled.toml") + " --until 2*pi");
  EXPECT_THAT(scaled.out,
              HasSubstr("  4.99"));  // 5, and what its amplifiers' offset of 1e-4 and the pole add
}

TEST_F(Check, RescaleLeavesTheFileThatItReads) {
  const std::string path = file("o.toml", kOscillator);
  const auto before = std::filesystem::last_write_time(path);
  EXPECT_EQ(oblique("check " + path).status, 0);
  EXPECT_EQ(std::filesystem::last_write_time(path), before);
}

TEST_F(Check, APatchedMechanismSurvivesRescaling) {
  ASSERT_EQ(oblique("patch diagrams/mechanisms/six-bar.toml -o " + file("p.toml")).status, 0);
  const Outcome written = oblique("check " + file("p.toml") + " --rescale -o " + file("s.toml"));
  EXPECT_EQ(written.status, 0) << written.err;
  EXPECT_THAT(written.err, HasSubstr("0 overloads"));
  EXPECT_THAT(written.err, Not(HasSubstr("warning")));
}

TEST_F(Check, StaticTestPrintsEveryElementAndRunsNothing) {
  const Outcome outcome = oblique("run --static-test " + file("o.toml", kOscillator));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, IsEmpty());
  EXPECT_THAT(outcome.out, HasSubstr("x        state               0                10\n"));
  EXPECT_THAT(outcome.out, HasSubstr("v        state               5                -2\n"));
}

TEST_F(Check, HaltOnOverloadEndsTheRunWithStatusOne) {
  const Outcome halted = oblique("run diagrams/lessons/triangle-side.toml --halt-on-overload --check");
  EXPECT_EQ(halted.status, 1);
  EXPECT_THAT(halted.err,
              HasSubstr("overload: 'phi' leaves ±1 machine unit at t = 1 s; the run ends there\n"));
  const Outcome whole = oblique("run diagrams/lessons/triangle-side.toml");
  EXPECT_EQ(whole.status, 0);
  EXPECT_THAT(whole.err, Not(HasSubstr("overload")));
  EXPECT_EQ(oblique("run diagrams/lessons/circle.toml --until 1 --halt-on-overload").status, 0);
}

}  // namespace
}  // namespace oblique::test
