// SPDX-License-Identifier: MIT
#include <oblique/solve/run.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/events/branch_end.h>
#include <oblique/solve/integrator/hidden_motion.h>
#include <oblique/solve/integrator/interpolant.h>
#include <oblique/solve/integrator/source_watch.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::column_of;
using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;

constexpr const char* kCircleText = R"toml(x = { type = "integrator", in = ["-y"], initial = 1 }
y = { type = "integrator", in = ["x"] }
)toml";

TEST(Run, SamplesOnAnExactGrid) {
  const Compiled made(kCircleText);
  for (const double until : {1.0, 2 * std::numbers::pi, 0.23, 1e-3, 1e4}) {
    const auto result = run_of(made, {.until = until, .tolerance = 1e-4, .samples = 72});
    const auto t = row_values(result, "t");
    ASSERT_EQ(t.size(), 72U);
    for (int k = 0; k < 72; ++k) {
      // k·until/(n − 1) rounded once or twice; the ends exactly.
      EXPECT_NEAR(t[static_cast<std::size_t>(k)], until * k / 71, 1e-15 * until);
    }
    EXPECT_EQ(t.front(), 0);
    EXPECT_EQ(t.back(), until);  // 0.23 · 71/71 is not 0.23
  }
}

// The square of what goes beyond a dead zone that the source never leaves is 0 throughout: within the zone
// neither its value nor its derivative has any width. It is looked at a few times for the edges of the zone,
// not a million times for itself.
TEST(SourceWatch, LooksNoCloserWhereNothingShows) {
  const Compiled made(R"toml(
u = { type = "sine-source", amplitude = 0.25, frequency = 2 }
z = { type = "dead-zone", in = "u", low = -0.5, high = 0.5 }
q = { type = "squarer", in = "z" }
x = { type = "integrator", in = ["q"] }
)toml");
  const network::Workspace workspace(made.program);
  const std::string file = "d.toml";
  SourceWatch watch(made.program, workspace, SourceWatch::Shown::nothing, file);
  const std::vector<double> states = made.program.start();
  EXPECT_LE(watch.sample_times(0, 3, ConstantStates(states), false).size(), 16U);
}

/// x′ = 1 + decay·x of one state.
struct Growing final : OdeSystem {
  explicit Growing(double decay_) : decay(decay_) {
    one.rows = {0};
    one.column_starts = {0, 1};
  }
  std::size_t size() const override { return 1; }
  const network::SparsePattern& pattern() const override { return one; }
  bool derivatives(double, const double* x, double* dxdt) override {
    *dxdt = 1 + decay * *x;
    return true;
  }
  bool jacobian(double, const double*, double* values) override {
    *values = decay;
    return true;
  }
  network::SparsePattern one;
  double decay;
};

// A solution that moves by 0.5 where x′ = 1 errs by half the length of a part of the step: it misses the
// equations from a hundred absolute tolerances on, and what is pulled back at once errs by less.
TEST(HiddenMotion, IsFoundFromAHundredTolerancesOn) {
  const StraightLine half(0, {0}, {0.5});
  const auto is_found = [&](double length, double decay) {
    Growing system(decay);
    HiddenMotion hidden(system, 1e-6, {1e-6});
    const std::vector<double> times{length, 2 * length};
    return hidden.find(0, times, half).has_value();
  };
  EXPECT_FALSE(is_found(1.9e-4, 0));
  EXPECT_TRUE(is_found(2.1e-4, 0));
  EXPECT_TRUE(is_found(3.9e-4, 0));
  EXPECT_FALSE(is_found(1.9e-4, -4e4));
  EXPECT_TRUE(is_found(3.9e-4, 1e3));
}

// What moves a state that stands still may be a seed, however little it is: it is found, and then again where
// it is ten times as much.
TEST(HiddenMotion, IsFoundOfWhatRestsHoweverSmall) {
  const std::vector<double> rests{0};
  Growing system(0);
  HiddenMotion hidden(system, 1e-6, {1e-6});
  const auto is_found = [&](double length) {
    const std::vector<double> times{length, 2 * length};
    return hidden.find(0, times, ConstantStates(rests)).has_value();
  };
  EXPECT_FALSE(is_found(1e-101));
  EXPECT_TRUE(is_found(1e-30));
  EXPECT_FALSE(is_found(9e-30));
  EXPECT_TRUE(is_found(1.1e-29));
}

TEST(Run, DoesNotDependOnTheNumberOfRows) {
  const Compiled made(kCircleText);
  const auto few = run_of(made, {.until = 10, .samples = 11}),
             many = run_of(made, {.until = 10, .samples = 10001});
  EXPECT_EQ(few.statistics.steps, many.statistics.steps);  // rows are interpolated, never stepped to
  for (std::size_t k = 0; k < 11; ++k) {
    EXPECT_EQ(few.trajectory.at(k, 1), many.trajectory.at(1000 * k, 1)) << k;
  }
}

TEST(Run, InterpolatesAsWellAsItSteps) {
  // Far more rows than steps: the polynomial between two steps is as good as the steps.
  const Compiled made(kCircleText);
  const auto result = run_of(made, {.until = 10, .samples = 5001});
  EXPECT_LT(result.statistics.steps, 2500);
  const auto t = row_values(result, "t"), x = row_values(result, "x");
  for (std::size_t k = 0; k < t.size(); ++k)
    EXPECT_NEAR(x[k], std::cos(t[k]), 2e-6) << t[k];  // as at the ends
}

TEST(Run, GivesRowsAtExtraTimes) {
  const Compiled made(kCircleText);
  const std::vector<double> times{0, 0.3, 0.5, 1 / 3.0 + 0.5, 1};  // with both ends and one row of the grid
  const auto plain = run_of(made, {.samples = 11});
  const auto result = run_of(made, {.samples = 11, .extra_times = times});
  EXPECT_EQ(column_of(result.extra, "t"), times);
  const auto x = column_of(result.extra, "x");
  for (std::size_t k = 0; k < times.size(); ++k) EXPECT_NEAR(x[k], std::cos(times[k]), 1e-6);  // as the rows
  EXPECT_EQ(row_values(result, "t"), row_values(plain, "t"));
  EXPECT_EQ(row_values(result, "x"), row_values(plain, "x"));
}

TEST(Run, FindsPeaksOfEverySignal) {
  const Compiled made(
      "x = { type = \"integrator\", in = [\"-4*y\"], initial = 1 }\n"
      "y = { type = \"integrator\", in = [\"x\"] }\n"
      "s = { type = \"summer\", in = [\"-3*y\"] }\n"
      "o = { type = \"constant\", value = 0 }\n",
      "[outputs]\nx = \"x\"\n");
  // x = cos 2t, y = sin(2t)/2: on the first half turn y is largest at π/4, s = −3y there smallest.
  const auto result = run_of(made, {.until = std::numbers::pi / 2 - 0.1, .samples = 10001});
  const auto& peaks = result.peaks;
  ASSERT_EQ(peaks.size(), 4U);
  EXPECT_NEAR(peaks[made.signal("y")].value, 0.5, 1e-6);  // a grid of 1.5e-4 misses by its square at most
  EXPECT_NEAR(peaks[made.signal("y")].time, std::numbers::pi / 4, 2e-4);
  EXPECT_NEAR(peaks[made.signal("s")].value, -1.5, 1e-6);
  EXPECT_EQ(peaks[made.signal("x")].value, 1);
  EXPECT_EQ(peaks[made.signal("x")].time, 0);
  EXPECT_EQ(peaks[made.signal("o")].value, 0);
  EXPECT_EQ(peaks[made.signal("o")].time, 0);
}

TEST(Run, ScalesOutputsToTheirUnits) {
  const Compiled made("x = { type = \"constant\", value = 0.25 }\n",
                      "[outputs]\nlength = { signal = \"x\", scale = 80, unit = \"mm\" }\n");
  const auto result = run_of(made, {.samples = 3});
  ASSERT_EQ(result.trajectory.columns().size(), 2U);
  EXPECT_EQ(result.trajectory.columns()[0].name, "t");
  EXPECT_EQ(result.trajectory.columns()[0].unit, "s");
  EXPECT_EQ(result.trajectory.columns()[1].name, "length");
  EXPECT_EQ(result.trajectory.columns()[1].unit, "mm");
  EXPECT_EQ(row_values(result, "length"), (std::vector<double>{20, 20, 20}));
  EXPECT_EQ(result.peaks[0].value, 0.25);  // in machine units
}

TEST(Run, EvaluatesADiagramWithoutStates) {
  const diagram::BlockLibrary library =
      testing::shipped_blocks_and("clock", "[outputs]\nt = {}\n[equations]\nt = \"time\"\n");
  // q = √(t + 1) by an algebraic loop that each row continues from the last.
  const Compiled made(
      "c = { type = \"clock\" }\none = { type = \"constant\" }\n"
      "s = { type = \"summer\", in = [\"c\", \"one\"] }\n"
      "q = { type = \"square-root\", in = \"s\", gain = inf, bandwidth = inf }\n",
      "", library);
  const auto result = run_of(made, {.until = 3, .samples = 31, .extra_times = {0.25}});
  const auto t = row_values(result, "t"), q = row_values(result, "q");
  ASSERT_EQ(q.size(), 31U);
  for (std::size_t k = 0; k < q.size(); ++k)
    EXPECT_NEAR(q[k], std::sqrt(t[k] + 1), 1e-15);  // Newton to rounding
  EXPECT_NEAR(column_of(result.extra, "q")[0], std::sqrt(1.25), 1e-15);
  EXPECT_EQ(result.statistics.steps, 0);
}

TEST(Run, TellsItsProgressAndItsRows) {
  const Compiled made(kCircleText);
  std::vector<double> fractions, seen;
  RunOptions options;
  options.until = 200;
  options.samples = 5;
  options.progress = [&](double fraction) { fractions.push_back(fraction); };
  options.on_sample = [&](double t, std::span<const double> states, std::span<const double>) {
    EXPECT_EQ(states.size(), 2U);
    EXPECT_NEAR(states[0], std::cos(t), 1e-3);
    seen.push_back(t);
  };
  const auto result = run(made.program, made.flat, options);
  EXPECT_EQ(seen, row_values(result, "t"));
  ASSERT_FALSE(fractions.empty());
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_GT(fractions.front(), 0);
  EXPECT_LE(fractions.back(), 1);
}

TEST(Run, TakesItsOptionsFromTheDiagram) {
  const Compiled made(kCircleText, "[run]\nuntil = 3\ntolerance = 1e-5\nsamples = 7\nmax_steps = 99\n");
  const RunOptions options = options_of(made.diagram.run);
  EXPECT_EQ(options.until, 3);
  EXPECT_EQ(options.tolerance, 1e-5);
  EXPECT_EQ(options.samples, 7);
  EXPECT_EQ(options.max_steps, 99);
}

TEST(Run, CountsItsWork) {
  const Compiled made(kCircleText);
  const SolverStatistics work = run_of(made).statistics;
  EXPECT_GT(work.steps, 10);
  EXPECT_GE(work.evaluations, work.steps);
  EXPECT_GE(work.factorizations, work.jacobians);
  EXPECT_GE(work.jacobians, 1);
  EXPECT_GT(work.last_step, 0);
}

// A square wave turns over at 0.5, 1, … 9.5: behind each of them a Jacobian is new.
TEST(Run, CountsTheWorkOfAllItsSegments) {
  const Compiled made(
      "g = { type = \"sine-source\", amplitude = 1, frequency = 1 }\n"
      "c = { type = \"comparator\", in = \"g\" }\n"
      "x = { type = \"integrator\", in = [\"c\", \"-x\"] }\n");
  const auto result = run_of(made, {.until = 9.75, .method = diagram::IntegrationMethod::bdf});
  ASSERT_GE(result.event_count, 19);
  EXPECT_GE(result.statistics.jacobians, result.event_count);
  EXPECT_GE(result.statistics.factorizations, result.statistics.jacobians);
}

// x = e^-t with an absolute tolerance far above it is not looked at; with the usual one it is right.
TEST(Run, HoldsStatesToTheAbsoluteToleranceOfTheDiagram) {
  const std::string decay = "x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n";
  const Compiled coarse(decay, "[run]\nabsolute_tolerance = 10\ntolerance = 1e-3\n");
  const Compiled usual(decay, "[run]\ntolerance = 1e-3\n");
  const oblique::solve::Run a = run(coarse.program, coarse.flat, options_of(coarse.diagram.run));
  const oblique::solve::Run b = run(usual.program, usual.flat, options_of(usual.diagram.run));
  EXPECT_LT(2 * a.statistics.steps, b.statistics.steps);
  EXPECT_NEAR(testing::row_values(b, "x").back(), std::exp(-1.0), 1e-3);
  EXPECT_GT(std::abs(testing::row_values(a, "x").back() - std::exp(-1.0)),
            10 * std::abs(testing::row_values(b, "x").back() - std::exp(-1.0)));
}

TEST(Run, TakesNoLongerStepsThanAskedFor) {
  const Compiled made("x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n",
                      "[run]\nmax_step = 1e-3\n");
  EXPECT_GE(run(made.program, made.flat, options_of(made.diagram.run)).statistics.steps, 1000);
}

// Without states and with two rows there is one step, in which a thousand samples meet few of the 2000
// crossings.
TEST(Run, TakesNoLongerStepsThanAskedForWithoutStates) {
  const std::string blocks =
      "s = { type = \"time-function\", formula = \"sin(2*pi*1000*time + 1)\" }\n"
      "is_above = { type = \"comparator\", in = \"s\" }\n";
  const Compiled made(blocks, "[run]\nsamples = 2\nmax_step = 1e-4\n");
  EXPECT_EQ(run(made.program, made.flat, options_of(made.diagram.run)).event_count, 2000);
}

TEST(Run, RefusesStepsThatNoBudgetHolds) {
  for (const char* const blocks :
       {"x = { type = \"integrator\", in = [\"-x\"], initial = 1 }\n", "x = { type = \"constant\" }\n"}) {
    const Compiled made(blocks, "[run]\nmax_step = 1e-300\n");
    EXPECT_EQ(
        testing::message_of<SolveError>([&] { run(made.program, made.flat, options_of(made.diagram.run)); }),
        "d.toml: steps of 1e-300 s at most would be more than 10000000 over a run of 1 s\n"
        "  remedy: raise max_step or max_steps in [run], or end the run earlier with 'until'");
  }
}

// A pulse late in a run is seen, and what lies before it costs no steps as short as it is.
TEST(Run, GoesToAShortPulseByLongSteps) {
  for (const double sharpness : {1e2, 1e4, 1e6, 1e8}) {
    const Compiled made(
        fmt::format("p = {{ type = \"time-function\", formula = \"{0}*exp(-((time - 99.999)*{0})^2)\" }}\n"
                    "x = {{ type = \"integrator\", in = [\"p\"] }}\n",
                    sharpness));
    const auto result = run_of(made, {.until = 100, .samples = 11});
    const double truth = std::sqrt(std::numbers::pi) / 2 * (1 + std::erf(1e-3 * sharpness));
    // Each of some hundred steps errs by up to a tolerance of 1e-8, and the time by its rounding there.
    EXPECT_NEAR(row_values(result, "x").back(), truth, 1e-6 + 1e-14 * sharpness) << sharpness;
    // At 1e8 the rounding of the time is 1e-6 of the pulse, which an error test of 1e-8 sees.
    EXPECT_LT(result.statistics.steps, sharpness < 1e8 ? 2000 : 50'000) << sharpness;
  }
}

// Early in a run of a second, and in one of 2³⁰: behind the pulse the steps become long again, in either.
TEST(Run, TakesTheSameStepsBehindAPulseInAnyUnitOfTime) {
  const auto run_in = [](double unit) {
    const Compiled made(
        fmt::format("p = {{ type = \"time-function\", formula = \"exp(-((time/{0} - 0.1)*1e3)^2)/{0}\" }}\n"
                    "x = {{ type = \"integrator\", in = [\"p\"] }}\n",
                    unit));
    return run_of(made, {.until = unit, .samples = 11, .max_steps = 10'000});
  };
  const auto brief = run_in(1), lasting = run_in(std::ldexp(1.0, 30));
  EXPECT_EQ(lasting.statistics.steps, brief.statistics.steps);
  EXPECT_NEAR(row_values(brief, "x").back(), std::sqrt(std::numbers::pi) / 1e3, 1e-7);
  EXPECT_EQ(row_values(lasting, "x"), row_values(brief, "x"));
}

// A pulse upon a signal that does not vanish beside it: twice as high as that, and two milliseconds long.
TEST(Run, SeesAPulseUponASteadySignal) {
  const Compiled made(R"toml(
p = { type = "time-function", formula = "1 + 2*exp(-((time - 7.3)*1e3)^2)" }
x = { type = "integrator", in = ["p"] }
)toml");
  const auto result = run_of(made, {.until = 10, .samples = 11});
  // each of some hundred steps errs by up to a tolerance of 1e-8 of 10; the pulse is 3.5e-3
  EXPECT_NEAR(row_values(result, "x").back(), 10 + 2e-3 * std::sqrt(std::numbers::pi), 1e-5);
}

TEST(Run, EndsWhereItIsInterrupted) {
  const Compiled made(kCircleText);
  RunOptions options;
  options.until = 1000;
  int asked = 0;  // at every evaluation
  options.interrupted = [&] { return ++asked > 500; };
  const auto result = run(made.program, made.flat, options);
  EXPECT_GT(result.state.time, 0);
  EXPECT_LT(result.state.time, 100);
  EXPECT_EQ(result.state.states.size(), 2U);
  // Wherever that is within a step, what is kept is the end of a whole one: of x = t on its line.
  const Compiled line(
      "one = { type = \"constant\", value = 1 }\nx = { type = \"integrator\", in = \"one\" }\n"
      "half = { type = \"constant\", value = 0.5 }\n"
      "s = { type = \"summer\", in = [\"x\", \"-half\"] }\n"
      "a = { type = \"absolute-value\", in = \"s\" }\n");
  for (int most = 20; most < 200; ++most) {
    asked = 0;
    options.until = 1;
    options.interrupted = [&] { return ++asked > most; };
    const auto part = run(line.program, line.flat, options);
    EXPECT_NEAR(part.state.states[0].second, part.state.time, 1e-8) << most;
    EXPECT_EQ(part.state.memories[0].second == 1, part.state.time >= 0.5) << most;
  }
  asked = 0;
  options.interrupted = [&] { return ++asked > 0; };
  EXPECT_EQ(message_of<SolveError>([&] { run(line.program, line.flat, options); }),
            "d.toml: interrupted before the run had begun: it has no state yet");
}

TEST(Run, TakesTolerancesOfSingleBlocks) {
  // Two equal decays to zero, one beside a coarse tolerance of its own: its error may grow to that.
  const std::string blocks =
      "a = { type = \"integrator\", in = [\"-a\"], initial = 1 }\nb = { type = \"integrator\", in = "
      "[\"-30*b\"], initial = 1 }\n";
  const auto steps = [&](const std::string& run) {
    return run_of(Compiled(blocks, run), {.until = 20, .samples = 2}).statistics.steps;
  };
  EXPECT_LT(steps("[run]\ntolerances = { b = 0.1, a = 0.1 }\n"), steps("") / 2);
  EXPECT_GT(steps("[run]\ntolerances = { b = 1e-14 }\n"), steps(""));
  EXPECT_THAT(message_of<diagram::DiagramError>([&] { Compiled(blocks, "[run]\ntolerances = { c = 0 }\n"); }),
              HasSubstr("tolerance of 'c' in [run] is 0; expected a finite number above 0 [machine unit]"));
  EXPECT_THAT(message_of<diagram::DiagramError>([&] { Compiled(blocks, "[run]\ntolerances = { c = 1 }\n"); }),
              HasSubstr("tolerances of [run]: there is no block 'c'"));
  const diagram::Diagram diagram =
      diagram::parse_diagram(testing::diagram_text(blocks, "[run]\ntolerances = { a = 0.1 }\n"), "d.toml");
  EXPECT_EQ(diagram::parse_diagram(diagram::write_diagram(diagram), "d.toml"), diagram);
}

TEST(Run, FindsExtremesBetweenItsRows) {
  const Compiled made(
      "x = { type = \"integrator\", in = [\"y\"], initial = 0.6 }\ny = { type = \"integrator\", in = "
      "[\"-x\"], initial = 0.8 }");
  RunOptions options;
  options.until = 2 * std::numbers::pi;
  options.samples = 2;
  options.extremes = true;
  const auto result = run(made.program, made.flat, options);
  EXPECT_NEAR(result.extremes[0].maximum.value, 1, 1e-7);  // the solver's tolerance
  EXPECT_NEAR(result.extremes[0].maximum.time, std::atan2(0.8, 0.6), 1e-3);
  EXPECT_NEAR(result.extremes[1].minimum.value, -1, 1e-7);
  options.tolerance = 1e-12;  // of which some hundred steps leave less than 1e-10
  const auto finer = run(made.program, made.flat, options);
  EXPECT_NEAR(finer.extremes[0].maximum.value, 1, 1e-10);
  EXPECT_NEAR(finer.extremes[1].minimum.value, -1, 1e-10);
}

// Steps of a second and more: no row of the same run, however near to each other they are, is beyond its
// extremes, but by what parabolas through neighbours 1/256 of a step away leave.
TEST(Run, FindsExtremesWithinLongSteps) {
  const Compiled made(R"toml(
x = { type = "integrator", in = ["v"], initial = 1 }
v = { type = "integrator", in = ["-x", "-0.2*v"] }
)toml");
  RunOptions options;
  options.until = 10;
  options.tolerance = 1e-2;
  options.method = diagram::IntegrationMethod::rodas;
  options.samples = 20'001;
  const auto rows = run(made.program, made.flat, options);
  ASSERT_LT(rows.statistics.steps, 20);
  options.extremes = true;
  const auto found = run(made.program, made.flat, options).extremes;
  for (std::size_t k = 0; k < 2; ++k) {
    const std::vector<double> values = row_values(rows, k == 0 ? "x" : "v");
    EXPECT_LE(found[k].minimum.value, *std::min_element(values.begin(), values.end()) + 1e-9);
    EXPECT_GE(found[k].maximum.value, *std::max_element(values.begin(), values.end()) - 1e-9);
  }
}

// (1 + x²) y = x by an ideal amplifier, with x the integral of 1 from −4: the solver goes by steps of
// seconds, in one of which y turns at ±1/2.
TEST(Run, FindsExtremesOfALoopWithinLongSteps) {
  const Compiled made(R"toml(
one = { type = "constant" }
x = { type = "integrator", in = "one", initial = -4 }
xx = { type = "squarer", in = "x" }
d = { type = "summer", in = ["one", "xx"] }
dy = { type = "multiplier", x = "d", y = "y" }
y = { type = "servo-amplifier", in = ["dy", "-x"], gain = inf, bandwidth = inf, initial = -0.2 }
)toml");
  RunOptions options;
  options.until = 8;
  options.samples = 7;
  options.extremes = true;
  const std::vector<Extremes> found = run(made.program, made.flat, options).extremes;
  const std::size_t y = made.flat.outputs.size() - 1;
  ASSERT_EQ(made.flat.outputs[y].name, "y");
  EXPECT_NEAR(found[y].maximum.value, 0.5, 1e-9);  // a parabola through neighbours 1e-4 s away
  EXPECT_NEAR(found[y].minimum.value, -0.5, 1e-9);
  EXPECT_NEAR(found[y].maximum.time, 5, 1e-3);
}

// A dyad on a crank's pin and the crank's bearing, which turns with it as a whole: the sides of its triangle
// stay as they are, but for what steps of the first order take from the crank's circle, and the angle between
// them is some times as steep. CVODES came into a circle of steps that grew fourfold and failed, 10 million
// of them and more.
TEST(Run, ComesOutOfStepsThatGrowAndFail) {
  struct Truss {
    double crank, r1, r2;
  };
  for (const auto& [crank, r1, r2] :
       {Truss{0.9027, 0.1886, 0.9426}, Truss{0.6, 0.54, 0.82}, Truss{0.6, 0.8, 1}}) {
    const auto result = run_of(Compiled(fmt::format(
                                   R"toml(
one  = {{ type = "constant", value = 1 }}
zero = {{ type = "constant", value = 0 }}
q    = {{ type = "crank-generator", speed = "one", rate = 6.283185307179586, start = 0.3490658503988659 }}
x    = {{ type = "summer", in = "{0}*q.cos" }}
y    = {{ type = "summer", in = "{0}*q.sin" }}
p    = {{ type = "dyad-rrr", px = "x", py = "y", qx = "zero", qy = "zero", r1 = {1}, r2 = {2}, side = -1, reach = {0}, gain = 1e6, bandwidth = 100 }}
)toml",
                                   crank, r1, r2)),
                               {.until = 1, .tolerance = 1e-10, .samples = 11});
    EXPECT_LT(result.statistics.steps, 5000) << r1;
    const auto x = row_values(result, "p.x"), y = row_values(result, "p.y");
    for (std::size_t r = 0; r < x.size(); ++r)
      EXPECT_NEAR(std::hypot(x[r], y[r]), r2, 1e-7) << r;  // ten times what loops of 1e9/s lag
  }
}

}  // namespace
}  // namespace oblique::solve
