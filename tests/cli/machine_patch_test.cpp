// SPDX-License-Identifier: MIT
// `oblique patch --machine`: what it writes, and where it writes nothing.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <unistd.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

/// An empty folder with the program at hand.
class PatchForMachine : public ::testing::Test {
 protected:
  PatchForMachine() : folder_(make_scratch_folder()) {
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~PatchForMachine() override { std::filesystem::remove_all(folder_); }
  PatchForMachine(const PatchForMachine&) = delete;
  PatchForMachine& operator=(const PatchForMachine&) = delete;

  Outcome patch(const std::string& mechanism, const std::string& options) const {
    return run_command("oblique patch " + std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" +
                           mechanism + ".toml " + options,
                       folder_.string());
  }
  Outcome oblique(const std::string& arguments) const {
    return run_command("oblique " + arguments, folder_.string());
  }
  std::string text_of(const std::string& file) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }
  /// Makes the folders of `file` too.
  void write(const std::string& file, const std::string& text) const {
    std::filesystem::create_directories((folder_ / file).parent_path());
    std::ofstream(folder_ / file) << text;
  }
  bool is_empty() const { return std::filesystem::is_empty(folder_); }

 private:
  std::filesystem::path folder_;
};

TEST_F(PatchForMachine, WritesADiagramThatRunsAndItsComponentList) {
  const Outcome outcome = patch("slider-crank", "--machine tr-10 -o made.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out, "");
  EXPECT_THAT(outcome.err, HasSubstr("elements of EAI PACE TR-10 (1959)\n"));
  EXPECT_THAT(outcome.err, ContainsRegex("multipliers +5 +9\n"));
  EXPECT_THAT(outcome.err, HasSubstr("\nit fits\n"));
  EXPECT_EQ(oblique("run made.toml").status, 0);
  const Outcome check = oblique("check made.toml");
  EXPECT_THAT(check.out, HasSubstr("elements of EAI PACE TR-10 (1959)\n"));
  EXPECT_THAT(check.out, HasSubstr("\nit fits\n"));
  const auto json = nlohmann::json::parse(oblique("check made.toml --json").out);
  EXPECT_EQ(json["bill"]["fits"], true);
  EXPECT_EQ(json["bill"]["rows"][0]["available"], 20);
}

TEST_F(PatchForMachine, WritesTheDiagramThatDoesNotFitAndSaysWhatIsMissing) {
  const Outcome outcome = patch("four-bar", "--machine tr-10");
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err, HasSubstr("it does not fit; missing: multipliers (6)\n"));
  EXPECT_THAT(outcome.out, StartsWith("# Coordinates"));
  EXPECT_THAT(outcome.out, HasSubstr("profile   = \"tr-10\"\ninverting = true\n"));
}

TEST_F(PatchForMachine, SaysWhichTimeFactorIsMissing) {
  const Outcome outcome = patch("four-bar", "--method gradient --machine tr-10 --bandwidth 20 --force");
  EXPECT_THAT(outcome.err, HasSubstr("integrators with k0 = 1.257e+08 1/s (k0 on this machine: 1, 500 1/s)"));
}

// Its summers of 200 kHz stand in loops of 20 MHz.
TEST_F(PatchForMachine, IsJudgedOnTheMachinesOwnElements) {
  const Outcome refused = patch("four-bar", "--method gradient --machine tr-10 --bandwidth 20 -o made.toml");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err,
              HasSubstr("on the machine EAI PACE TR-10 (1959) this patch would not run: it is unstable"));
  EXPECT_THAT(refused.err, HasSubstr("remedy: --bandwidth \"0.02 Hz\" is stable; --force writes this one"));
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(
      patch("four-bar", "--method gradient --machine tr-10 --bandwidth 0.02 --force -o made.toml").status, 0);
  const Outcome slower = patch("four-bar", "--method gradient --machine tr-10 -o made.toml");
  EXPECT_EQ(slower.status, 0);
  EXPECT_THAT(slower.err,
              AllOf(HasSubstr("servo amplifiers of 0.01 Hz here: with 20 Hz on the elements of EAI "
                              "PACE TR-10 (1959), it is unstable: the loops '"),
                    HasSubstr("its servo loops come to rest everywhere"), Not(HasSubstr("warning"))));
}

// Servo amplifiers of 50 MHz around multipliers of 1 MHz.
TEST_F(PatchForMachine, WarnsOfBadDamping) {
  const Outcome asked =
      patch("slider-crank", "--machine the-analog-thing --gain 1e4 --bandwidth 5000 -o made.toml");
  EXPECT_EQ(asked.status, 0);
  EXPECT_THAT(asked.err,
              HasSubstr("warning: it is badly damped: the loops 'C_slide_half2', 'C_slide_half' oscillate "
                        "for long before they settle (ζ = 0.016); a run takes many steps\n"));
  const Outcome chosen = patch("slider-crank", "--machine the-analog-thing --gain 1e4 -o made.toml");
  EXPECT_THAT(chosen.err,
              AllOf(HasSubstr("servo amplifiers of 10 Hz here: with 5000 Hz"), Not(HasSubstr("warning"))));
}

TEST_F(PatchForMachine, WritesSheets) {
  EXPECT_EQ(patch("slider-crank", "--machine tr-10 -o made.toml --sheets made").status, 0);
  EXPECT_THAT(text_of("made-patch.csv"), StartsWith("from,signal,to,element,input\n"));
  EXPECT_THAT(text_of("made-pots.csv"),
              HasSubstr("\nP1,0.3142,A5,A3 ×1,157.1 1/s of crank_sine in crank_cosine\n"));
  EXPECT_THAT(text_of("made-static.csv"),
              HasSubstr("\nA3,crank_cosine,\"integrator, k0 = 500 1/s\",10.0000,0.0000\n"));
  const std::string paper = text_of("made.txt");
  for (const char* const part : {"it fits\n", "come to rest everywhere", "\n\npatch list\n",
                                 "\n\npotentiometers\n", "\n\nstatic test\n"})
    EXPECT_THAT(paper, HasSubstr(part));
}

TEST_F(PatchForMachine, WritesNothingWhereTheMachineLacksAKindOfElement) {
  const Outcome outcome = patch("four-bar", "--machine ec-1 -o made.toml --sheets made");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("the machine Heathkit EC-1 has no multipliers, so nothing is written\n"
                        "  remedy: choose another machine (oblique machines), or write the diagram "
                        "all the same with --force\n"));
  EXPECT_TRUE(is_empty());
  EXPECT_EQ(patch("four-bar", "--machine ec-1 -o made.toml --force").status, 0);
  EXPECT_THAT(text_of("made.toml"), HasSubstr("type = \"multiplier\""));
}

// An arm that swings, its angle 30° + sin(t)/2: a TR-10 has no element for the law of its drive, but two
// integrators that draw it, as for any diagram. Its multipliers, to 0.8 %, leave the arm's end within 1 % of
// its length.
TEST_F(PatchForMachine, PutsAMechanismWithALawOntoTheMachineAsADiagram) {
  write("arm.toml", R"(format = "oblique-mechanism/1"
[units]
length = "mm"
[frame]
O = [0, 0]
[bodies]
arm = { points = ["O", "P"], length = 50 }
[drives]
d = { turns = "arm", about = "O", speed = "0.5*cos(time) rad/s", start = "30 deg" }
[motion]
until = "2*pi"
)");
  const Outcome made = oblique("patch arm.toml --machine tr-10 -o made.toml --sheets made");
  EXPECT_EQ(made.status, 0) << made.err;
  EXPECT_THAT(made.err,
              HasSubstr("it fits\nput onto the machine as a diagram is, since it has no time-function\n"));
  EXPECT_THAT(text_of("made.toml"), HasSubstr("d_speed_source_sine "));
  write("made.toml", text_of("made.toml") + R"toml([expect]
"P.x at pi/2" = { value = "50*cos(pi/6 + 0.5)", within = 0.5 }
"P.y at pi/2" = { value = "50*sin(pi/6 + 0.5)", within = 0.5 }
"P.x at 3*pi/2" = { value = "50*cos(pi/6 - 0.5)", within = 0.5 }
"P.y at 3*pi/2" = { value = "50*sin(pi/6 - 0.5)", within = 0.5 }
)toml");
  const Outcome run = oblique("run made.toml --check");
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST_F(PatchForMachine, RefusesWhatCannotBeBeforeAnythingIsWritten) {
  const Outcome unknown = patch("four-bar", "--machine tr-11 -o made.toml");
  EXPECT_EQ(unknown.status, 2);
  EXPECT_THAT(unknown.err, HasSubstr("there is no machine 'tr-11'"));
  EXPECT_THAT(unknown.err, HasSubstr("did you mean 'tr-10'?"));
  const Outcome alone = patch("four-bar", "-o made.toml --sheets made");
  EXPECT_EQ(alone.status, 2);
  EXPECT_THAT(
      alone.err,
      HasSubstr(
          "--sheets writes the sheets of a machine, and none is named; expected --machine NAME beside it"));
  const Outcome nowhere = patch("four-bar", "--machine tr-10 -o made.toml --sheets no/made");
  EXPECT_EQ(nowhere.status, 2);
  EXPECT_THAT(nowhere.err, HasSubstr("no/made-patch.csv: the folder of this file does not exist"));
  EXPECT_TRUE(is_empty());
}

TEST_F(PatchForMachine, HasNoComponentListForTheIdealMachineInCheck) {
  EXPECT_EQ(patch("slider-crank", "-o made.toml").status, 0);
  EXPECT_THAT(oblique("check made.toml").out, Not(HasSubstr("elements of")));
}

// An integrator of one's own, without a time factor, in the place of the shipped one: no element of a
// machine.
TEST_F(PatchForMachine, TakesAUsersBlockOfAShippedNameForWhatItIs) {
  write("own/integrator.toml", R"toml(format = "oblique-block/1"
title = "Own integrator"
[inputs]
in = { sum = true }
[outputs]
out = {}
[parameters]
initial = { default = 0, unit = "machine unit" }
[equations]
"der(out)" = "in"
[start]
out = "initial"
)toml");
  write("own.toml", R"toml(format = "oblique-diagram/1"
[machine]
profile = "tr-10"
[run]
until = 1
[blocks]
x = { type = "integrator", in = "-x", initial = 1 }
)toml");
  const Outcome checked = oblique("check own.toml --blocks own");
  EXPECT_EQ(checked.status, 0) << checked.err;
  EXPECT_THAT(checked.out, HasSubstr("as it is drawn it has blocks that are no elements: integrator (1)\n"));
}

TEST_F(PatchForMachine, RefusesAFolderAsTheBeginningOfNames) {
  write("sheets/other.txt", "");
  write(
      "decay.toml",
      "format = \"oblique-diagram/1\"\n[blocks]\nx = { type = \"integrator\", in = \"-x\", initial = 1 }\n");
  const Outcome refused = oblique("patch decay.toml --machine tr-10 --sheets sheets");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err,
            "error: --sheets sheets is a folder; expected what the names of the sheets begin with\n"
            "  remedy: --sheets sheets/sheet\n");
}

// `run` has an option for the end of a run, and `patch` has none.
TEST_F(PatchForMachine, NamesOnlyItsOwnOptions) {
  write("escapes.toml", R"toml(format = "oblique-diagram/1"
[run]
until = 2
[blocks]
x = { type = "integrator", in = "s", initial = 1 }
s = { type = "squarer", in = "x" }
)toml");
  EXPECT_THAT(oblique("run escapes.toml").err, HasSubstr("; or end the run earlier with --until\n"));
  EXPECT_THAT(oblique("patch escapes.toml --machine tr-48 -o made.toml").err,
              HasSubstr("; or end the run earlier with 'until' of [run]\n"));
}

// One without a bandwidth, on which the machine's figure for it cannot act.
TEST_F(PatchForMachine, ComparesWithAUsersBlockThatLacksAParameter) {
  write("own/summer.toml", R"(format = "oblique-block/1"
title = "Own summer"
[inputs]
in = { sum = true }
[outputs]
out = {}
[equations]
out = "polarity*in"
)");
  const Outcome compared =
      oblique("compare " + std::string(OBLIQUE_SOURCE_DIR) +
              "/diagrams/mechanisms/four-bar.toml --machine tr-10 --gain 1e3 --blocks own");
  EXPECT_EQ(compared.status, 0) << compared.err;
  EXPECT_THAT(compared.out, Not(HasSubstr(" summer ")));
}

// A diagram of one's own in problem units: a mass on a spring, 40 mm from its rest.
constexpr const char* kSpring = R"toml(format = "oblique-diagram/1"
title = "Spring"
[run]
until = 10
[blocks]
v    = { type = "integrator", in = ["-0.2*v", "-4*x"] }
x    = { type = "integrator", in = "v", initial = 40 }
[outputs]
x = { signal = "x", unit = "mm" }
)toml";

TEST_F(PatchForMachine, PutsADiagramOntoAMachine) {
  write("spring.toml", kSpring);
  const Outcome outcome = oblique("patch spring.toml --machine tr-10 --sheets made -o made.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("elements of EAI PACE TR-10 (1959)\n"));
  EXPECT_THAT(outcome.err, HasSubstr("\nit fits\n"));
  EXPECT_THAT(outcome.err, ContainsRegex("its signals reach 0\\.9[0-9] \\('v'\\) to (1|0\\.99) "));
  EXPECT_THAT(outcome.err,
              ContainsRegex("outputs differ from the diagram's by [0-9.]+e-(08|09|10|11|12|13) of"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("warning")));
  EXPECT_THAT(outcome.err, HasSubstr("run it with: oblique run made.toml\n"));
  EXPECT_EQ(oblique("run made.toml --halt-on-overload").status, 0);
  // 1 V of x is 4 mm, as 40 mm are the whole of the 10 V.
  EXPECT_THAT(text_of("made-scales.csv"), HasSubstr(",x,4,10.0000\n"));
  EXPECT_THAT(text_of("made-scales.csv"), StartsWith("element,signal,1 V is,largest [V]\n"));
  EXPECT_THAT(text_of("made.txt"), HasSubstr("\nscales\n"));
  // What is read where, and for how long it runs.
  EXPECT_THAT(text_of("made-outputs.csv"),
              ContainsRegex("^output,element,signal,1 V is,0 V is,unit\nx,A[0-9],(minus_)?x,-?4,0,mm\n$"));
  EXPECT_THAT(text_of("made-modes.csv"),
              ContainsRegex("hold by,for [0-9]+ s\nall,\"A[0-9], A[0-9]\",,,operate\n$"));
  EXPECT_THAT(text_of("made.txt"), HasSubstr("outputs differ from the diagram's by"));
  EXPECT_THAT(text_of("made-pots.csv"), StartsWith("pot,setting,from,to,stands for\n"));
  EXPECT_THAT(text_of("made-patch.csv"), HasSubstr("initial value"));
}

// A stop of 20 mm, six times as stiff as the spring: a diode, which the machine makes of a function
// generator.
TEST_F(PatchForMachine, SaysHowFunctionGeneratorsAreSet) {
  std::string stopped = kSpring;
  stopped.replace(stopped.find("\"-4*x\""), 6, "\"-4*x\", \"-24*stop\"");
  stopped.insert(stopped.find("[outputs]"), "stop = { type = \"diode\", in = \"x\", drop = 20 }\n");
  write("stopped.toml", stopped);
  const Outcome outcome = oblique("patch stopped.toml --machine tr-10 --sheets made -o made.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("wrote made-functions.csv\n"));
  // The stop throws x back to −55.5 mm: it gets the factor 0.018 of two digits, by which 20 mm are 3.6 V.
  const std::string functions = text_of("made-functions.csv");
  EXPECT_THAT(functions, StartsWith("element,signal,breakpoint [V],output [V],slope beyond,slope added,side\n"
                                    "F1,stop,0.0000,0.0000,0.0000,,\n"));
  EXPECT_THAT(functions, HasSubstr("F1,stop,3.6000,0.0000,"));
  EXPECT_THAT(text_of("made.txt"), HasSubstr("\nfunction generators\n"));
}

TEST_F(PatchForMachine, TakesTheTimeScaleThatIsAskedFor) {
  write("spring.toml", kSpring);
  const Outcome outcome = oblique("patch spring.toml --machine tr-10 --time-scale 5 -o made.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("1 s of the diagram takes 5 s on the machine\n"));
  EXPECT_THAT(text_of("made.toml"), ContainsRegex("until *= 50\n"));
}

TEST_F(PatchForMachine, RefusesADiagramThatTheMachineHasNoElementsFor) {
  write("own/distance.toml", R"toml(format = "oblique-block/1"
title = "Distance"
[inputs]
x = {}
y = {}
[outputs]
out = {}
[equations]
out = "sqrt(x^2 + y^2)"
)toml");
  write("far.toml", std::string(kSpring).insert(std::string(kSpring).find("[outputs]"),
                                                "far = { type = \"distance\", x = \"x\", y = \"x\" }\n") +
                        "far = \"far\"\n");
  const Outcome refused = oblique("patch far.toml --machine tr-10 -o made.toml --blocks own");
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("far.toml:8:1: the machine EAI PACE TR-10 (1959) has no distance, "
                                     "which 'far' is, and no circuit of its elements for it"));
  EXPECT_THAT(refused.err,
              HasSubstr("  remedy: build it of these; --force writes the diagram unscaled, with its own "
                        "blocks\n"));
  const Outcome forced = oblique("patch far.toml --machine tr-10 -o made.toml --blocks own --force");
  EXPECT_EQ(forced.status, 0) << forced.err;
  EXPECT_THAT(forced.err,
              HasSubstr("warning: not scaled: the machine EAI PACE TR-10 (1959) has no distance"));

  const Outcome product = oblique("patch " + std::string(OBLIQUE_SOURCE_DIR) +
                                  "/diagrams/historical/van-der-pol.toml --machine ec-1 -o other.toml");
  EXPECT_EQ(product.status, 1);
  EXPECT_THAT(product.err,
              ContainsRegex("the machine Heathkit EC-1 has no multipliers \\(for '[a-z0-9_]+', .*\\), "
                            "so nothing is written"));
  EXPECT_THAT(product.err, HasSubstr("choose another machine (oblique machines)"));
}

// x′ = −0.00008 x − y, y′ = x: ten times as fast, the pot of the leak is at 0.0008, of 4000 steps 3.2.
TEST_F(PatchForMachine, WarnsOfASettingBelowTheStepsOfThePotentiometers) {
  const auto leak = [&](const std::string& weight) {
    write("leak.toml",
          "format = \"oblique-diagram/1\"\n[run]\nuntil = 10\n[blocks]\n"
          "x = { type = \"integrator\", in = [\"" +
              weight +
              "*x\", \"-y\"], initial = 1 }\ny = { type = \"integrator\", in = \"x\" }\n"
              "[outputs]\nx = \"x\"\n");
    return oblique("patch leak.toml --machine tr-10 --sheets made -o made.toml");
  };
  const Outcome small = leak("-0.00008");
  EXPECT_EQ(small.status, 0) << small.err;
  const std::string told =
      "warning: P1 ('pot_1') is set to 0.0008, and the potentiometers of EAI PACE TR-10 (1959) have steps of "
      "0.00025: it may be off by 16 %\n  remedy: scale the signals so that it is larger, or put 2 "
      "potentiometers in series, each at 0.0283\n";
  EXPECT_THAT(small.err, HasSubstr(told));
  EXPECT_THAT(text_of("made.txt"), HasSubstr(told));
  EXPECT_THAT(text_of("made-pots.csv"), HasSubstr("\nP1,0.0008,"));
  EXPECT_THAT(leak("-0.008").err, Not(HasSubstr("warning")));
  EXPECT_THAT(leak("0").err, Not(HasSubstr("warning")));
}

// A root that begins at zero: the machine's offset and multiplier take it below, where there is none.
TEST_F(PatchForMachine, WritesNothingThatDoesNotRunOnTheMachine) {
  write("root.toml", R"toml(format = "oblique-diagram/1"
[run]
until = 5
[blocks]
one = { type = "constant" }
z = { type = "integrator", in = "0.2*one" }
r = { type = "square-root", in = "z" }
[outputs]
r = "r"
)toml");
  const Outcome refused = oblique("patch root.toml --machine tr-10 -o made.toml");
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.err,
              AllOf(HasSubstr("root.toml: on the elements of EAI PACE TR-10 (1959) it does not run, so "
                              "nothing is written: the servo loops do not come to rest"),
                    HasSubstr("or write the diagram all the same with --force\n")));
  EXPECT_EQ(text_of("made.toml"), "");
  const Outcome forced = oblique("patch root.toml --machine tr-10 --force -o made.toml");
  EXPECT_EQ(forced.status, 0) << forced.err;
  EXPECT_THAT(forced.err, HasSubstr("warning: on the elements of EAI PACE TR-10 (1959) it does not run: "));
  EXPECT_EQ(oblique("run made.toml").status, 3);
}

TEST_F(PatchForMachine, TakesNoOptionsOfTheOtherKindOfFile) {
  write("spring.toml", kSpring);
  const auto says = [&](const std::string& options, const std::string& message) {
    const Outcome outcome = oblique("patch spring.toml " + options);
    EXPECT_EQ(outcome.status, 2) << options;
    EXPECT_THAT(outcome.err, HasSubstr(message)) << options;
  };
  says(
      "",
      "spring.toml: this is a diagram already, and no machine is named to put it on; expected --machine NAME "
      "beside it\n  remedy: oblique machines lists them");
  says("--machine tr-10 --gain 1e4",
       "--gain for a diagram; expected a mechanism beside it\n  remedy: leave it out");
  says("--machine tr-10 --period '3 s'", "--period for a diagram");
  says("--machine tr-10 --time-scale 0", "--time-scale 0");
  const Outcome mechanism = patch("slider-crank", "--machine tr-10 --segments 5");
  EXPECT_EQ(mechanism.status, 2);
  EXPECT_THAT(mechanism.err, HasSubstr("--segments for a mechanism"));
}

// x = exp(-(1 + d) t) for a relative error d of the integrator's input, uniform within h: dx/dd is -t
// exp(-t), which is largest at t = 1, so that x errs there by h/e at most, and by h/(e sqrt 3) in the root of
// the mean square.
TEST_F(PatchForMachine, ComparesADiagramWhoseElementsScatterWithItsIdealSelf) {
  write("decay.toml", R"toml(format = "oblique-diagram/1"
[run]
until = 4
[blocks]
x = { type = "integrator", in = "-x", initial = 1 }
)toml");
  const Outcome outcome = oblique("compare decay.toml --tolerance 1% --budget --monte-carlo 200 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_EQ(json["budget"]["point"], "x");
  EXPECT_NEAR(json["budget"]["drive"].get<double>(), 1, 1e-9);  // a row stands there
  EXPECT_NEAR(json["budget"]["error"].get<double>(), 0.01 / std::exp(1) / std::sqrt(3), 1e-7);
  // 200 draws of a uniform number: the largest lies within some percent of the bound, the median within a
  // sixth.
  const auto& percentiles = json["monte_carlo"]["percentiles"];
  EXPECT_NEAR(percentiles["100"].get<double>() * std::exp(1) / 0.01, 0.98, 0.03);
  EXPECT_NEAR(percentiles["50"].get<double>() * std::exp(1) / 0.01, 0.5, 0.08);
  EXPECT_THAT(oblique("compare decay.toml --tolerance 1% --budget").out,
              HasSubstr("together they change output x by 2.124e-03 of its largest value"));
}

// A gain of μ = 1000 in two integrators and an inverter: the amplitude falls by e^(−t/μ), and the frequency
// by 2/μ, half of it by the inverter (−1/(1 + 2/μ)) and half by the integrators. At t = 61.8, where the
// program finds its largest error, the vector of the circle is 0.940 long and 0.124 rad behind: 0.134 away;
// the next order in 1/μ is a hundredth of that.
TEST_F(PatchForMachine, ComparesADiagramOnAMachineWithItsIdealSelf) {
  const std::string circle = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/lessons/circle-on-ec-1.toml";
  const Outcome outcome = oblique("compare " + circle + " --machine ec-1 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = nlohmann::json::parse(outcome.out);
  EXPECT_NEAR(json["machine"]["max_error"].get<double>(), 0.134, 2e-3);
  EXPECT_NEAR(json["machine"]["explained"].get<double>(), 1, 0.05);
  const Outcome text = oblique("compare " + circle + " --machine ec-1");
  EXPECT_THAT(text.out, HasSubstr("on Heathkit EC-1, of as many elements as it takes\n"));
  EXPECT_THAT(text.out, ContainsRegex("amplifier, open-loop gain +integrator +[0-9.]+e-02"));

  const Outcome nothing = oblique("compare " + circle);
  EXPECT_EQ(nothing.status, 2);
  EXPECT_THAT(nothing.err,
              HasSubstr("this is a diagram, and nothing is named to hold it against; expected --machine "
                        "NAME, or --tolerance X with --budget or --monte-carlo N"));
  EXPECT_THAT(oblique("compare " + circle + " --machine ec-1 --gain 1e4").err,
              HasSubstr("--gain for a diagram"));
}

}  // namespace
}  // namespace oblique::test
