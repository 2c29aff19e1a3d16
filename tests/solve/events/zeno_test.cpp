// SPDX-License-Identifier: MIT
// Zeno behaviour: the impacts of a ball.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/solve/solve_error.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using ::testing::HasSubstr;
using testing::message_of;
using testing::row_values;
using testing::run_of;
using testing::shipped_blocks_and;

constexpr const char* kBall = R"toml([outputs]
x = {}
v = {}
impacts = {}
[parameters]
e = { default = 0.9 }
g = { default = 10 }
height = { default = 1 }
[memories]
count = 0
[equations]
"der(x)" = "v"
"der(v)" = "-g"
impacts = "count"
[start]
x = "height"
v = 0
[[events]]
when = "x < 0 and v < 0"
set = { x = 0, v = "-e*v", count = "count + 1" }
)toml";

/// Time of impact k of a ball let fall from height h: the flights shorten by e each time.
double impact_time(int k, double h, double e, double g) {
  const double fall = std::sqrt(2 * h / g);
  double t = fall;
  for (int i = 1; i < k; ++i) t += 2 * fall * std::pow(e, i);
  return t;
}

TEST(Zeno, BouncingBallMeetsTheTwentiethImpact) {
  const diagram::BlockLibrary library = shipped_blocks_and("ball", kBall);
  const Compiled made("b = { type = \"ball\" }", "", library);
  const auto result = run_of(made, {.until = 8.2, .tolerance = 1e-10, .samples = 11});
  ASSERT_GE(result.events.size(), 20U);
  std::vector<double> impacts;
  for (const EventRecord& event : result.events) {
    if (event.what == "b") impacts.push_back(event.time);
  }
  ASSERT_GE(impacts.size(), 20U);
  for (int k = 1; k <= 20; ++k) {  // asked: 1e-8; the tolerance of 1e-10 a flight, over 20 flights
    EXPECT_NEAR(impacts[static_cast<std::size_t>(k) - 1], impact_time(k, 1, 0.9, 10), 1e-8) << k;
  }
}

TEST(Zeno, IsEndedByName) {
  const diagram::BlockLibrary library = shipped_blocks_and("ball", kBall);
  const Compiled made("b = { type = \"ball\", e = 0.5 }", "", library);
  const std::string message = message_of<SolveError>([&] { run_of(made, {.until = 5}); });
  EXPECT_THAT(message, HasSubstr("the events of 'b' come ever faster"));
  // Σ: fall · (1 + 2e/(1 − e)) = √0.2 · 3
  EXPECT_THAT(message, HasSubstr("they pile up at t = 1.3416"));
  EXPECT_THAT(
      message,
      HasSubstr("remedy: end the run before, or tell the block what happens there: 'piling_up' beside "
                "'set' in its [[events]]"));
}

diagram::BlockLibrary library_with_resting_ball() {
  std::string resting = kBall;
  resting.replace(resting.find("count = 0\n"), 10, "count = 0\nrests = 0\n");
  resting.replace(resting.find("\"-g\""), 4, "\"if(rests == 1, 0, -g)\"");
  return shipped_blocks_and("ball", resting + "piling_up = { x = 0, v = 0, rests = 1 }\n");
}

// A block that says what comes after rests there: to what is left of its bounces, 1e-5 of the run, and a
// speed of g times that, half of a flight.
TEST(Zeno, GoesOverIntoWhatItsBlockSays) {
  const diagram::BlockLibrary library = library_with_resting_ball();
  const Compiled made("b = { type = \"ball\", e = 0.5 }", "", library);
  const auto result = run_of(made, {.until = 5, .tolerance = 1e-10, .samples = 501});
  ASSERT_FALSE(result.events.empty());
  EXPECT_EQ(result.events.back().what, "b: its events pile up");
  EXPECT_NEAR(result.events.back().time, std::sqrt(0.2) * 3, 5e-5);
  EXPECT_LT(result.events.back().time, std::sqrt(0.2) * 3);
  const std::size_t last = result.trajectory.rows() - 1;
  EXPECT_EQ(result.trajectory.at(last, 1), 0);
  EXPECT_EQ(result.trajectory.at(last, 2), 0);
  for (std::size_t row = 0; row <= last; ++row) {
    if (result.trajectory.at(row, 0) > std::sqrt(0.2) * 3) {
      EXPECT_EQ(result.trajectory.at(row, 1), 0);
    }
  }
}

// The errors of the height, at this tolerance, are as large as the last bounces, which then come in no rhythm
// any more: it would bounce for some 10⁶ times more. The last ones took 2e-7 of the run each.
TEST(Zeno, OfABallThatBouncesByItsErrorsComesToRest) {
  const diagram::BlockLibrary library = library_with_resting_ball();
  const Compiled made("b = { type = \"ball\", e = 0.98, g = 90.8, height = 0.02 }", "", library);
  const auto result = run_of(made, {.until = 2.6, .tolerance = 1e-10, .max_steps = 200'000});
  EXPECT_EQ(result.trajectory.at(result.trajectory.rows() - 1, 1), 0);
  EXPECT_NEAR(result.event_times.back(), std::sqrt(0.04 / 90.8) * 1.98 / 0.02, 1e-3);
}

// Where each flight is a tenth of the one before, the seventh is within the errors of the height: it rests
// before that.
TEST(Zeno, OfAQuickBallDoesNotFallThroughTheFloor) {
  const diagram::BlockLibrary library = library_with_resting_ball();
  for (const double e : {0.05, 0.1, 0.25, 0.3}) {
    const Compiled made(fmt::format("b = {{ type = \"ball\", e = {} }}", e), "", library);
    for (const double tolerance : {1e-6, 1e-8}) {
      const auto result = run_of(made, {.until = 8, .tolerance = tolerance, .samples = 501});
      const std::size_t last = result.trajectory.rows() - 1;
      double least = 0;
      for (std::size_t row = 0; row <= last; ++row) least = std::min(least, result.trajectory.at(row, 1));
      EXPECT_GE(least, -1e-8) << e << ' ' << tolerance;  // an event is as exact as the height
      EXPECT_EQ(result.trajectory.at(last, 1), 0) << e << ' ' << tolerance;
    }
  }
}

/// The least height of the ball of a run, and its last.
struct Heights {
  double least = 0, last = 0;
};
Heights heights_of(const oblique::solve::Run& result) {
  Heights heights;
  for (std::size_t row = 0; row < result.trajectory.rows(); ++row)
    heights.least = std::min(heights.least, heights.last = result.trajectory.at(row, 1));
  return heights;
}

// Wherever the run is cut in two, also so late that no more flights are left than tell of Zeno behaviour.
TEST(Zeno, IsSeenInARunThatGoesOn) {
  const diagram::BlockLibrary library = library_with_resting_ball();
  for (const double e : {0.6, 0.9}) {
    const Compiled made(fmt::format("b = {{ type = \"ball\", e = {}, g = 2.5 }}", e), "", library);
    const double rest = impact_time(400, 1, e, 2.5);
    for (const double part : {0.2, 0.5, 0.9, 0.99, 0.999, 0.9999, 0.99999, 0.999999, 1.1}) {
      for (const double tolerance : {1e-6, 1e-8}) {
        const auto first = run_of(made, {.until = part * rest, .tolerance = tolerance, .samples = 11});
        RunOptions options;
        options.until = 3 * rest;
        options.tolerance = tolerance;
        options.from = parse_run_state(to_text(first.state), "s.toml");
        const Heights heights = heights_of(run(made.program, made.flat, options));
        EXPECT_GE(heights.least, -10 * tolerance) << part;  // an event is as exact as the height
        EXPECT_EQ(heights.last, 0) << e << ' ' << part << ' ' << tolerance;
      }
    }
  }
}

// What reads the ball comes to its own events as often, and knows no more of their end than that it is the
// ball's: a function generator with a breakpoint at the floor, and a counter of the impacts.
TEST(Zeno, OfABallIsNotThatOfWhatReadsIt) {
  const diagram::BlockLibrary library = library_with_resting_ball();
  for (const double e : {0.35, 0.5, 0.66}) {
    const std::string ball = fmt::format("b = {{ type = \"ball\", e = {} }}\n", e);
    const std::string reading = R"toml(
f = { type = "function-generator", in = "-1.7*b.x", points = [[-1, 0.75], [0, 0], [0.5, 1], [1, -0.75]] }
n = { type = "counter", clock = "rises", step = 0.01 }
rises = { type = "comparator", in = "b.v" }
)toml";
    const Compiled first(ball + reading, "", library), last(reading + ball, "", library);
    for (const auto& [made, tolerance] :
         {std::pair(&last, 1e-6), {&last, 1e-8}, {&last, 1e-10}, {&first, 1e-8}}) {
      const auto result = run_of(*made, {.until = 5, .tolerance = tolerance, .samples = 501});
      EXPECT_TRUE(result.warnings.empty()) << e;
      const auto t = row_values(result, "t"), x = row_values(result, "b.x"), f = row_values(result, "f");
      const auto n = row_values(result, "n.out");
      for (std::size_t row = 0; row < t.size(); ++row)
        EXPECT_NEAR(f[row], 0.75 * 1.7 * x[row], 10 * tolerance) << t[row];  // of an event at the floor
      EXPECT_EQ(x.back(), 0);
      // As soon as it has come n times: Σ of the flights.
      for (std::size_t row = 0; row < t.size(); ++row) {
        const int impacts = static_cast<int>(std::lround(n[row] / 0.01));
        if (impacts > 0) {
          EXPECT_GE(t[row] + 1e-6, impact_time(impacts, 1, e, 10)) << t[row];
        }
        if (t[row] < impact_time(5, 1, e, 10)) {
          EXPECT_LE(t[row] - 1e-6, impact_time(impacts + 1, 1, e, 10));
        }
      }
    }
  }
}

// A ball that lies on the floor from the start falls no deeper; one that is only pressed against it does not
// either, and where the block does not say what it does there, the run ends.
TEST(Zeno, OfFlightsOfNoLengthIsSeenAtOnce) {
  const diagram::BlockLibrary balls = library_with_resting_ball();
  const Compiled lying("b = { type = \"ball\", height = 0 }", "", balls);
  const Heights heights = heights_of(run_of(lying));
  EXPECT_EQ(heights.least, 0);
  EXPECT_EQ(heights.last, 0);

  const diagram::BlockLibrary library = shipped_blocks_and("stop", R"toml([inputs]
in = {}
[outputs]
x = {}
[equations]
"der(x)" = "in"
[start]
x = 0
[[events]]
when = "x > 1"
set = { x = 1 }
)toml");
  const Compiled pressed("one = { type = \"constant\" }\ns = { type = \"stop\", in = \"2*one\" }", "",
                         library);
  EXPECT_EQ(
      message_of<SolveError>([&] { run_of(pressed, {.until = 2}); }),
      "d.toml: the events of 's' come again at once at t = 0.5 s: what they set leads back to their "
      "condition\n  remedy: end the run before, or tell the block what happens there: 'piling_up' beside "
      "'set' in its [[events]]");
}

// A ball between two walls meets one just where something else has its event: it lies at the wall to
// rounding, but its speed leads away. Without losses it is at 1 − |1 − 2 {t/2 + 1/4}| at any t.
TEST(Zeno, IsNotABounceWhereSomethingElseHasItsEvent) {
  const diagram::BlockLibrary library = shipped_blocks_and("walls", R"toml([outputs]
x = {}
v = {}
[equations]
"der(x)" = "v"
"der(v)" = "0"
[start]
x = 0.5
v = 1
[[events]]
when = "x > 1"
set = { v = "-v" }
[[events]]
when = "x < 0"
set = { v = "-v" }
)toml");
  for (const double at : {0.5, 1.5, 0.3}) {
    const Compiled both(
        fmt::format("w = {{ type = \"walls\" }}\nclock = {{ type = \"step\", at = {} }}\n", at), "", library);
    const oblique::solve::Run run = run_of(both, {.until = 2.2});
    EXPECT_NEAR(row_values(run, "w.x").back(), 0.7, 1e-7) << at;
  }
}

// v passes 0.5 once, at 2/3 s and to rounding, and puts y back to the 1 that it has: v goes on, whatever was
// set.
TEST(Zeno, IsNotWhatLeadsOnWhereNothingHasSetIt) {
  const oblique::solve::Run run = run_of(Compiled(R"toml(one = { type = "constant" }
v = { type = "integrator", in = ["one"], rate = 0.75 }
zero = { type = "constant", value = 0 }
s = { type = "servo-amplifier", in = ["s", "y"], gain = 8000, bandwidth = 6.5 }
y = { type = "integrator", in = ["zero"], set = "v", initial = 1, rate = 0.5085693359375 }
)toml"),
                                         {.until = 4, .tolerance = 1e-9});
  EXPECT_EQ(row_values(run, "y").back(), 1);
}

// What is set may also end what led to it: then nothing comes again, and put on its level the state is not
// above it, also where it leaves that level no faster than its third power.
TEST(Zeno, IsNotWhereASetStateStays) {
  const diagram::BlockLibrary library = shipped_blocks_and("stop", R"toml([inputs]
in = {}
[outputs]
x = {}
v = {}
[memories]
stuck = 0
[equations]
"der(x)" = "if(stuck == 1, 0, v)"
"der(v)" = "if(stuck == 1, 0, in)"
[start]
x = 0
v = 0
[[events]]
when = "x > 1 and stuck == 0"
set = { x = 1, v = 0, stuck = 1 }
[[events]]
when = "stuck == 1 and in < 0"
set = { stuck = 0 }
)toml");
  const Compiled made(
      "w = { type = \"sine-source\", frequency = \"1/8 Hz\" }\ns = { type = \"stop\", in = \"w\" }", "",
      library);
  const auto result = run_of(made, {.until = 6, .samples = 61});
  const std::size_t x = result.trajectory.find("s.x").value();
  double greatest = 0;
  for (std::size_t row = 0; row < result.trajectory.rows(); ++row)
    greatest = std::max(greatest, result.trajectory.at(row, x));
  EXPECT_EQ(greatest, 1);
  // It is let go at t = 4, at x = 1, and moves by −∬ sin(π t/4) over 2 s.
  const double pi = 3.141592653589793;
  EXPECT_NEAR(result.trajectory.at(60, x), 1 - 4 / pi * (2 - 4 / pi), 1e-7);
}

// A. T. Fuller's problem (1960): x″ = −sgn(x + C x′|x′|) from (1, 0) turns over infinitely often, each time
// with ρ = √((½ − C)/(½ + C)) of the speed of the turn before; the first comes at t = |x′| = 1/√(½ + C), and
// after them all it stays at the origin.
TEST(Zeno, OfTurnsThatComeToRestEndsInASlide) {
  constexpr double kC = 0.4446;
  const Compiled made(fmt::format(R"(
v = {{ type = "integrator", in = "-u" }}
x = {{ type = "integrator", in = "v", initial = 1 }}
m = {{ type = "absolute-value", in = "v" }}
vv = {{ type = "multiplier", in = ["v", "m"] }}
u = {{ type = "sign", in = "y" }}
y = {{ type = "summer", in = ["x", "{}*vv"] }}
)",
                                  kC));
  const double first = 1 / std::sqrt(0.5 + kC), shrinks = std::sqrt((0.5 - kC) / (0.5 + kC));
  const double end = first + first * (1 + shrinks) / (1 - shrinks);
  for (const double tolerance : {1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    const auto result = run_of(made, {.until = 6, .tolerance = tolerance});
    EXPECT_LT(result.event_count, 10'000) << tolerance;  // it used to go on, with a million
    const auto slides = std::find_if(result.events.begin(), result.events.end(), [](const EventRecord& e) {
      return e.what.find("stays at") != std::string::npos;
    });
    ASSERT_NE(slides, result.events.end());
    EXPECT_NEAR(slides->time, end, 1e-3)
        << tolerance;  // what the errors of the states leave to the last turns
    const auto t = row_values(result, "t"), x = row_values(result, "x"), v = row_values(result, "v");
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (t[k] < first) {
        EXPECT_NEAR(x[k], 1 - t[k] * t[k] / 2, 100 * tolerance) << t[k];
      }
      if (t[k] < end + 1e-3) continue;
      EXPECT_NEAR(x[k], 0, 100 * tolerance) << t[k];
      EXPECT_NEAR(v[k], 0, std::sqrt(100 * tolerance)) << t[k];  // x is within its error for that long
    }
  }
}

// The super-twisting controller (A. Levant 1993): no slide holds x, which does not depend on the sign there.
// In dτ = dt/(2√|x|) it is linear: half a turn leaves r = e^(−kπ/2ω) of z, and takes Δz/a.
TEST(Zeno, OfTurnsThatNothingHoldsIsEndedByName) {
  constexpr double kK = 1.5, kA = 1.1;
  const diagram::BlockLibrary library = shipped_blocks_and("twist", fmt::format(R"toml([outputs]
x = {{}}
z = {{}}
[equations]
"der(x)" = "-{}*sqrt(abs(x))*sign(x) + z"
"der(z)" = "-{}*sign(x)"
[start]
x = 1
z = 0
)toml",
                                                                                kK, kA));
  const Compiled made("s = { type = \"twist\" }", "", library);
  const double omega = std::sqrt(2 * kA - kK * kK / 4),
               half = std::exp(-kK * 3.141592653589793 / (2 * omega));
  const double first = std::exp(-kK / (2 * omega) * std::atan(2 * omega / kK)) * std::sqrt(2 / kA);
  for (const double tolerance : {1e-8, 1e-9, 1e-10}) {
    EXPECT_THAT(message_of<SolveError>([&] { run_of(made, {.until = 10, .tolerance = tolerance}); }),
                HasSubstr(fmt::format("'s' (x > 0) turns over ever faster: its turns pile up at t = {:.3g}",
                                      2 * first / (1 - half))))
        << tolerance;
  }
}

// An integrator fires at 0.8 and begins anew, ever faster: its drive is φ′ for φ = rate (t + faster t²). Once
// a pulse resets it some microseconds after it has fired, and it goes on as before. A gate that joins the two
// goes up and down at each firing, within an instant, and rests at its own level in between.
TEST(Zeno, IsNotOnePulseBesideARhythm) {
  struct Rhythm {
    double rate, faster;
    int number;  // of the firing behind which the pulse comes
    double behind;
  };
  constexpr double kNever = 50;
  for (const Rhythm& r :
       {Rhythm{2000, 0.05, 700, kNever}, Rhythm{2000, 0.05, 700, 5e-6}, Rhythm{100, 0.25, 37, 1e-6}}) {
    const auto phase = [&](double t) { return r.rate * (t + r.faster * t * t); };
    const double pulse =
        (std::sqrt(1 + 4 * r.faster * r.number * 0.8 / r.rate) - 1) / (2 * r.faster) + r.behind;
    const Compiled made(fmt::format(R"(
one = {{ type = "constant" }}
k = {{ type = "ramp", initial = 1, slope = {} }}
x = {{ type = "integrator", in = ["k"], rate = {}, set = "reset" }}
c = {{ type = "comparator", in = ["x", "-0.8*one"] }}
p = {{ type = "pulse-train", period = 100, width = 1e-6, delay = {} }}
reset = {{ type = "maximum", x = "c", y = "p" }}
n = {{ type = "counter", clock = "c" }}
)",
                                    2 * r.faster, r.rate, pulse));
    const solve::Run run = run_of(made, {.until = 0.9});
    const double end = phase(0.9);
    const double fired = r.behind == kNever
                             ? std::floor(end / 0.8)
                             : std::floor(phase(pulse) / 0.8) + std::floor((end - phase(pulse)) / 0.8);
    EXPECT_EQ(row_values(run, "n.out").back(), fired) << r.rate << ' ' << r.behind;
    EXPECT_TRUE(run.warnings.empty()) << r.rate << ' ' << r.behind;
  }
}

// A ball of two integrators under g = 2, from 1 with the restitution e, lies at rest from (1 + e)/(1 − e) on.
// No comparator turns over there any more, and it would fall through the floor: the run ends before, or says
// that its last turns are hidden.
TEST(Zeno, ThatErrorsHideIsToldOf) {
  int warned = 0;
  for (const double e : {0.5, 0.65, 0.72, 0.735, 0.75, 0.795, 0.9, 0.93}) {
    for (const double longer : {1.15, 1.3, 2.0}) {
      const std::string blocks = fmt::format(R"toml(one = {{ type = "constant" }}
hit = {{ type = "comparator", in = "-y" }}
v = {{ type = "integrator", in = "-2*one", start = "start", set = "hit" }}
on = {{ type = "step", at = 0.5 }}
start = {{ type = "multiplier", in = ["-{}*v", "on"] }}
y = {{ type = "integrator", in = "v", initial = 1 }}
)toml",
                                             e);
      try {
        const auto result = run_of(Compiled(blocks), {.until = longer * (1 + e) / (1 - e)});
        ASSERT_EQ(result.warnings.size(), 1U) << e << ' ' << longer;
        EXPECT_THAT(result.warnings[0].what,
                    ::testing::StartsWith("the events of 'v' came ever faster, at last at"));
        EXPECT_THAT(result.warnings[0].what,
                    HasSubstr("then the errors of the states hid them, and what follows may be wrong"));
        ++warned;
      } catch (const SolveError& error) {
        EXPECT_EQ(error.kind(), SolveError::Kind::chatter) << error.what();
      }
    }
  }
  EXPECT_GT(warned, 5);
}

}  // namespace
}  // namespace oblique::solve
