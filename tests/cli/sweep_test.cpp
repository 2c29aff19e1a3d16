// SPDX-License-Identifier: MIT
#include "verbs.h"

#include <gmock/gmock.h>

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

constexpr const char* kDecay = R"toml(format = "oblique-diagram/1"
title = "Decay"
[blocks]
x = { type = "integrator", in = ["-1*x"], initial = 1 }
)toml";

class Sweep : public Verbs {
 protected:
  Sweep() {
    std::ofstream(file("decay.toml")) << kDecay;
    decay_ = file("decay.toml");
  }
  std::string decay_;
};

TEST_F(Sweep, WritesARowForEachCombination) {
  const Outcome outcome = oblique("sweep " + decay_ +
                                  " --vary 'x.in[1]=-1,-2' --vary x.initial=0.5..1:2 --measure 'max(x)'"
                                  " --measure 'half = time(x <= start)' -o " +
                                  file("t.csv"));
  EXPECT_EQ(outcome.status, 2);  // start is a function
  const Outcome again = oblique("sweep " + decay_ +
                                " --vary 'x.in[1]=-1,-2' --vary x.initial=0.5..1:2 --measure 'max(x)'"
                                " --measure 'late=time(x <= 0.4)' -o " +
                                file("t.csv"));
  ASSERT_EQ(again.status, 0) << again.err;
  std::string header;
  const auto rows = csv_rows(file("t.csv"), header);
  EXPECT_EQ(header, "x.in[1],x.initial,max(x),late");
  ASSERT_EQ(rows.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const double rate = k < 2 ? 1 : 2, height = k % 2 == 0 ? 0.5 : 1;
    EXPECT_EQ(rows[k][0], -rate);
    EXPECT_EQ(rows[k][1], height);
    EXPECT_EQ(rows[k][2], height);
    EXPECT_NEAR(rows[k][3], std::log(height / 0.4) / rate, 1e-7);  // ten times the run's tolerance
  }
  EXPECT_THAT(again.out, HasSubstr("least"));
  EXPECT_THAT(again.err, StartsWith("wrote "));
  EXPECT_THAT(again.err, HasSubstr("\n4 machines"));
}

TEST_F(Sweep, ShowsTheFirstAndTheLastRows) {
  const Outcome outcome = oblique("sweep " + decay_ + " --vary x.initial=0..1:101 --measure 'start(x)'");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, StartsWith("x.initial [machine unit]  start(x)\n"
                                      "                       0         0\n"
                                      "                    0.01      0.01\n"));
  EXPECT_THAT(outcome.out, HasSubstr("(of 101 machines; -o FILE.csv writes all of them)\n\n"
                                     "          least  median  greatest"));
}

// x(1) = h e^(−1): in proportion to h, whatever the rate; and at the fixed time it does not go as a power of
// the rate.
TEST_F(Sweep, TellsHowMeasuresGoWithWhatIsSpacedLogarithmically) {
  const Outcome outcome =
      oblique("sweep " + decay_ +
              " --vary x.initial=1e-3..1:4:log --measure 'end(x)' --measure 'p = 1/end(x)^2'"
              " --measure 'zero = end(x) - end(x)' --measure 'same = 1 + 0*end(x)'");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("\n\nend(x) goes as x.initial^1.00, from 1.00 to 1.00 between neighbours\n"
                        "p goes as x.initial^-2.00, from -2.00 to -2.00 between neighbours\n"));
  EXPECT_EQ(outcome.out.find("zero goes"), std::string::npos);
  EXPECT_EQ(outcome.out.find("same goes"), std::string::npos);
  // h/(1 + h) from h = 0.01 to 10: log10 9.18, log10 5.5 and log10 1.82, the median and the range of which
  // count.
  const Outcome falling =
      oblique("sweep " + decay_ + " --vary x.initial=1e-2..10:4:log --measure 'q = start(x)/(1 + start(x))'");
  EXPECT_THAT(falling.out, HasSubstr("q goes as x.initial^0.74, from 0.26 to 0.96 between neighbours\n"));
  const Outcome linear = oblique("sweep " + decay_ + " --vary x.initial=1,2,3 --measure 'end(x)'");
  EXPECT_EQ(linear.out.find("goes as"), std::string::npos);
}

// Ten periods of a sine in 61 rows: six rows a period, where the polynomial is not taken. max is a row's, up
// to 1 − cos(π/6) = 13 % below 1; with 1001 rows there is nothing to tell.
TEST_F(Sweep, TellsWhereRowsAreFewForWhatIsMeasured) {
  std::ofstream(file("swing.toml")) << R"toml(format = "oblique-diagram/1"
[run]
until = 10
[blocks]
w = { type = "sine-source", amplitude = 1, frequency = 1, phase = 0.4 }
x = { type = "integrator", in = ["1*w"] }
)toml";
  const std::string sweep = "sweep " + file("swing.toml") + " --vary w.amplitude=0.5,1 --measure 'max(w)'";
  const Outcome few = oblique(sweep + " --samples 61");
  ASSERT_EQ(few.status, 0) << few.err;
  EXPECT_THAT(few.err,
              HasSubstr("note: in 2 machines the rows are few for what is measured: between them a signal "
                        "bends, and a measure may err by "));
  EXPECT_EQ(oblique(sweep + " --samples 1001").err.find("note: "), std::string::npos);
}

TEST_F(Sweep, GivesTheSameNumbersWithAnyNumberOfThreads) {
  for (const std::string jobs : {"1", "2"}) {
    const Outcome outcome = oblique("sweep " + decay_ + " --scatter 'integrator.tolerance=±1%' --runs 20" +
                                    " --measure 'end(x)' --jobs " + jobs + " -o " + file(jobs + ".csv"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  EXPECT_EQ(bytes_of("1.csv"), bytes_of("2.csv"));
}

// A percentage is one of 1: of a gain of 1000 nobody means ±0.1 by 10 %.
TEST_F(Sweep, RefusesAPercentageOfWhatIsBeyondOne) {
  const auto sweep = [&](const std::string& factor, const std::string& width) {
    std::ofstream(file("gain.toml"))
        << "format = \"oblique-diagram/1\"\n[blocks]\nx = { type = \"integrator\", in = \"-x\", initial = 1 "
           "}\n"
           "low = { type = \"gain\", in = \"x\", factor = 0.5 }\ny = { type = \"gain\", in = \"x\", factor = "
        << factor << " }\n[outputs]\ny = \"y\"\n";
    return oblique("sweep " + file("gain.toml") + " --scatter gain.factor=" + width +
                   " --runs 3 --measure 'start(y)'");
  };
  EXPECT_EQ(
      sweep("-20", "10%").err,
      "error: --scatter gain.factor=10%: 'y.factor' is -20, and 10 % is ±0.1, not a part of it; expected "
      "half the width itself, without %\n"
      "  remedy: write 0.1 for that, or 2 for 10 % of 20\n");
  EXPECT_EQ(sweep("-20", "10%").status, 2);
  EXPECT_EQ(sweep("-20", "0.1").status, 0);
  EXPECT_EQ(sweep("0.9", "10%").status, 0);
}

TEST_F(Sweep, TellsOfMachinesThatFailAndGoesOn) {
  const Outcome outcome =
      oblique("sweep " + decay_ + " --vary 'x.in[1]=-1,1e300' --measure 'end(x)' -o " + file("t.csv"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.err,
              HasSubstr("FAILED 1 of 2 machines, without values; the first, x.in[1] = 1e+300: "));
  std::string header;
  const auto rows = csv_rows(file("t.csv"), header);
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[1].size(), 1U);  // the cell of the measure is empty
  EXPECT_EQ(oblique("sweep " + decay_ + " --vary 'x.in[1]=1e300,2e300'").status, 3);
}

TEST_F(Sweep, KeepsWhatIsDoneWhereCtrlCEndsIt) {
  std::vector<std::vector<double>> rows;
  for (const std::string seconds :
       {"1", "3", "9"}) {  // a busy computer may have done nothing after the first
    const Outcome outcome =
        run_command("timeout --foreground --preserve-status -s INT " + seconds + " oblique sweep " + decay_ +
                        " --vary x.initial=0..1:1000000 --jobs 2 --measure 'start(x)' -o " + file("t.csv"),
                    OBLIQUE_SOURCE_DIR);
    if (outcome.status == 130 && outcome.err.empty()) continue;  // it had not begun
    EXPECT_THAT(outcome.err, HasSubstr("interrupted: "));
    if (outcome.err.find("there is nothing to write") != std::string::npos) continue;
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(" of 1000000 machines were run\nwrote "));
    std::string header;
    rows = csv_rows(file("t.csv"), header);
    break;
  }
  EXPECT_GE(rows.size(), 1U);
  EXPECT_LT(rows.size(), 1'000'000U);
  for (const auto& row : rows) ASSERT_EQ(row[0], row[1]);
}

struct BadSweep {
  const char *arguments, *message;
};

TEST_F(Sweep, RefusesWhatMakesNoSense) {
  const BadSweep bad[]{
      {"--vary 'x.initial'",
       "error: --vary x.initial: this varies nothing; expected NAME=VALUES\n"
       "  remedy: for example --vary c.gain=1e2..1e6:5:log\n"},
      {"--vary x.inital=1,2",
       "error: --vary x.inital=1,2: 'inital' of block type 'integrator' is not a parameter\n"
       "  remedy: did you mean 'initial'?\n"},
      {"--vary x.initial=1,2 --measure 'end(y)'",
       "error: --measure end(y): there is no output or signal 'y'\n  remedy: known: x\n"},
      {"--vary x.initial=1,2 --measure x",
       "error: --measure x: 'x' has a value at every moment, and a measure is one number of a run; expected "
       "end(x), max(x), mean(x) …\n"},
      {"--vary x.initial=1,2 --gain 1e3",
       "error: --gain is of a mechanism's patch, and DECAY is a diagram; expected --vary 'c.gain=…' of a "
       "block "
       "of the diagram\n"},
      {"--vary x.initial=1..2 --latin --sobol --runs 3",
       "error: --latin and --sobol both choose the points; expected one of the two\n"},
      {"--scatter multiplier --runs 3",
       "error: --scatter multiplier: nothing scatters; expected TYPE.PARAMETER=±HALF-WIDTH\n"
       "  remedy: for example --scatter multiplier.error=0.1%\n"},
      {"",
       "error: nothing is varied and nothing scatters, so that all machines are one; expected names with "
       "values, such as c.gain=1e2..1e6:5:log\n"},
  };
  for (const BadSweep& one : bad) {
    const Outcome outcome = oblique("sweep " + decay_ + " " + one.arguments);
    EXPECT_EQ(outcome.status, 2) << one.arguments;
    std::string message = one.message;
    if (const std::size_t at = message.find("DECAY"); at != std::string::npos) message.replace(at, 5, decay_);
    EXPECT_EQ(outcome.err, message);
    EXPECT_EQ(outcome.out, "");
  }
}

TEST_F(Sweep, DrawsACurveAndAHistogram) {
  for (const std::string what :
       {"--vary x.initial=0.1..1:9:log", "--scatter integrator.tolerance=1% --runs 50"}) {
    const Outcome outcome =
        oblique("sweep " + decay_ + " " + what + " --measure 'end(x)' --plot " + file("p.svg"));
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_THAT(bytes_of("p.svg"), HasSubstr("id=\"curve-0-0\""));
  }
}

TEST_F(Sweep, RunGivesAFamilyOfCurves) {
  const Outcome outcome = oblique("run " + decay_ + " --vary x.initial=0.25..1:4 -o " + file("f.csv") +
                                  " --plot " + file("f.svg"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  std::string header;
  const auto rows = csv_rows(file("f.csv"), header);
  EXPECT_EQ(header, "t,x (x.initial = 0.25),x (x.initial = 0.5),x (x.initial = 0.75),x (x.initial = 1)");
  for (const auto& row : rows) {
    for (std::size_t k = 1; k <= 4; ++k)
      ASSERT_NEAR(row[k], 0.25 * static_cast<double>(k) * std::exp(-row[0]), 1e-7);  // the tolerance is 1e-8
  }
  const std::string svg = bytes_of("f.svg");
  EXPECT_THAT(svg, HasSubstr("id=\"curve-0-3\""));
  EXPECT_THAT(svg, HasSubstr("x.initial = 0.75"));
  const Outcome refused = oblique("run " + decay_ + " --vary x.initial=1,2 --trust");
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(
      refused.err,
      "error: --vary runs the diagram several times, and --trust is of one run; expected one of the two\n");
}

// With and without a picture: an output is its columns of all values, a column may be named in full.
TEST_F(Sweep, RunWritesTheChosenColumnsOfAFamily) {
  const auto written = [&](const std::string& options) {
    const Outcome outcome =
        oblique("run " + decay_ + " --vary x.initial=0.5,1 -o " + file("f.csv") + options);
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    std::string header;
    csv_rows(file("f.csv"), header);
    return header;
  };
  EXPECT_EQ(written(" --columns x"), "x (x.initial = 0.5),x (x.initial = 1)");
  EXPECT_EQ(written(" --columns t,x --plot " + file("f.svg")), "t,x (x.initial = 0.5),x (x.initial = 1)");
  EXPECT_EQ(written(" --columns 'x (x.initial = 1),t'"), "x (x.initial = 1),t");
  for (const char* const name : {"v", "v (x.initial = 1)"}) {
    const Outcome refused = oblique("run " + decay_ + " --vary x.initial=0.5,1 -o " + file("f.csv") +
                                    " --columns '" + name + "'");
    EXPECT_EQ(refused.status, 2);
    EXPECT_THAT(refused.err, HasSubstr("error: --columns: there is no column 'v'"));
    EXPECT_EQ(refused.out, "") << "it was run before it was refused";
  }
}

}  // namespace
}  // namespace oblique::test
