// SPDX-License-Identifier: MIT
// Slides at the corner of what is compared, behind which it is zero and no comparison holds.
#include <cmath>
#include <numbers>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;
using testing::row_values;
using testing::run_of;

// x slides along 1 − t/2, and the dead zone that it comes into at t = 1.2 gives 0, which is not above zero;
// nor is that below, until x leaves it again at t = 2.8.
TEST(Slide, LeavesNothingHoldingThatComesToZeroBesideIt) {
  const Compiled made(R"toml(
u = { type = "ramp", slope = -0.5, initial = 1 }
d = { type = "summer", in = ["u", "-x"] }
r = { type = "sign", in = "d" }
x = { type = "integrator", in = "r", initial = 1 }
z = { type = "dead-zone", in = "x", low = -0.4, high = 0.4 }
a = { type = "comparator", in = "z" }
b = { type = "comparator", in = "-z" }
p = { type = "integrator", in = "a" }
q = { type = "integrator", in = "b" }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 4, .samples = 41});
  const std::vector<double> t = row_values(result, "t"), a = row_values(result, "a"),
                            b = row_values(result, "b");
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (std::abs(t[row] - 1.2) > 1e-6) {
      EXPECT_EQ(a[row], t[row] < 1.2 ? 1 : 0) << t[row];
    }
    if (std::abs(t[row] - 2.8) > 1e-6) {
      EXPECT_EQ(b[row], t[row] > 2.8 ? 1 : 0) << t[row];
    }
  }
  EXPECT_NEAR(row_values(result, "p").back(), 1.2, 1e-6);  // a slide may drift by 1e-7
  EXPECT_NEAR(row_values(result, "q").back(), 1.2, 1e-6);
}

// dx/dt = 0.3 − a from −0.5, or its mirror image. What a compares is zero from the first edge that x comes to
// on, where it does not hold: x goes on, to the other edge if there is one, and slides there.
TEST(Slide, BeginsAtNoCornerBehindWhichNothingHolds) {
  struct Flat {
    const char* blocks;
    double sign, x, a;  ///< whether it comes from below; at the end
  };
  const Flat flats[] = {
      {"m = { type = \"dead-zone\", in = \"x\", low = -0.2, high = 0.2 }\na = { type = \"comparator\", in = "
       "\"m\" }",
       1, 0.2, 0.3},
      {"m = { type = \"minimum\", x = \"x\", y = \"o\" }\na = { type = \"comparator\", in = \"m\" }", 1, 0.7,
       0},
      {"m = { type = \"absolute-value\", in = \"x\" }\na = { type = \"comparator\", in = [\"x\", \"-m\"] }",
       1, 0.7, 0},
      {"m = { type = \"limiter\", in = \"x\", low = -1, high = 0.2 }\na = { type = \"electronic-switch\", on "
       "= "
       "\"one\", control = \"m\", threshold = 0.2 }",
       1, 0.7, 0},
      {"m = { type = \"dead-zone\", in = \"x\", low = -0.2, high = 0.2 }\na = { type = \"comparator\", in = "
       "\"-m\" }",
       -1, -0.2, 0.3},
      {"m = { type = \"limiter\", in = \"x\", low = 0, high = 1 }\na = { type = \"comparator\", in = \"-m\" "
       "}",
       -1, -0.7, 0},
      {"m = { type = \"diode\", in = \"x\" }\na = { type = \"comparator\", in = \"-m\" }", -1, -0.7, 0},
  };
  using enum diagram::IntegrationMethod;
  for (const Flat& flat : flats) {
    for (const auto method : {adams, bdf, rodas}) {
      const Compiled made(fmt::format(
          "one = {{ type = \"constant\" }}\no = {{ type = \"constant\", value = 0 }}\n{0}\nx = {{ type = "
          "\"integrator\", in = [\"{1}*one\", \"{2}*a\"], initial = {3} }}\n",
          flat.blocks, 0.3 * flat.sign, -flat.sign, -0.5 * flat.sign));
      const oblique::solve::Run result = run_of(made, {.until = 4, .samples = 5, .method = method});
      EXPECT_NEAR(row_values(result, "x").back(), flat.x, 1e-6) << flat.blocks;  // a slide may drift by 1e-7
      EXPECT_NEAR(row_values(result, "a").back(), flat.a, 1e-6) << flat.blocks;
      EXPECT_TRUE(result.warnings.empty()) << flat.blocks;
      EXPECT_LE(result.event_count, 5) << flat.blocks;
    }
  }
}

// x comes to the edge of its dead zone at t = 1/7 and slides there, with a up for 0.7 of the time, though y,
// which depends on it, slides already: within the zone a does not hold.
TEST(Slide, BeginsAtACornerBesideAnother) {
  const Compiled made(R"toml(
one = { type = "constant" }
m = { type = "dead-zone", in = "x", low = -0.1, high = 0.1 }
a = { type = "comparator", in = "m" }
x = { type = "integrator", in = ["-a", "0.7*one"] }
b = { type = "comparator", in = "y" }
y = { type = "integrator", in = ["-1.27*b", "0.5*one", "-0.01*x"], initial = 0.1 }
)toml");
  using enum diagram::IntegrationMethod;
  for (const auto method : {adams, bdf, rodas}) {
    const oblique::solve::Run result = run_of(made, {.until = 3, .samples = 7, .method = method});
    EXPECT_NEAR(row_values(result, "x").back(), 0.1, 1e-6);  // a slide may drift by 1e-7
    EXPECT_NEAR(row_values(result, "a").back(), 0.7, 1e-6);
    EXPECT_NEAR(row_values(result, "y").back(), 0, 1e-6);
    EXPECT_NEAR(row_values(result, "b").back(), 0.499 / 1.27, 1e-6);
  }
}

// dx/dt = cos(t)/2 − a from the edge of a dead zone, where x slides until π/2 and then falls into it.
TEST(Slide, BeginsWithTheRunAtACorner) {
  const Compiled made(R"toml(
u = { type = "sine-source", frequency = "1 rad/s", phase = "90 deg" }
x = { type = "integrator", in = ["-a", "0.5*u"], initial = 0.2 }
a = { type = "comparator", in = "n" }
n = { type = "dead-zone", in = "x", low = -0.1, high = 0.2 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 2.5, .samples = 26});
  const std::vector<double> t = row_values(result, "t"), x = row_values(result, "x"),
                            a = row_values(result, "a");
  for (std::size_t row = 0; row < t.size(); ++row) {
    const bool slides = t[row] < std::numbers::pi / 2;
    EXPECT_NEAR(x[row], slides ? 0.2 : 0.2 + (std::sin(t[row]) - 1) / 2, 1e-6)
        << t[row];  // it may drift by 1e-7
    EXPECT_NEAR(a[row], slides ? std::cos(t[row]) / 2 : 0, 1e-5) << t[row];
  }
  EXPECT_TRUE(result.warnings.empty());
}

// Beside the slides of b and c an integrator of c comes to its limit and is held there by the mean of what
// drives it: while c is low it drives out, and what holds it then moves with b as steadily as a corner of b
// would. (It was taken for one, and the run was refused.) c leaves it there to the end: what b and c do is
// not changed by it.
TEST(Slide, OfALimitIsNoCornerOfWhatSlidesBesideIt) {
  const auto run_with = [](const char* limit) {
    const Compiled made(fmt::format(R"toml(
u = {{ type = "time-function", formula = "0.752*sin(4.7*time + 2.2)" }}
one = {{ type = "constant" }}
b = {{ type = "comparator", in = "0.8451*x", low = -1 }}
c = {{ type = "comparator", in = ["-0.6*y", "1.065*z", "-0.9*one"], low = -1 }}
x = {{ type = "integrator", in = ["-2*b", "0.9*c", "0.8*x"], initial = -0.4 }}
y = {{ type = "integrator", in = ["-1.173*b", "-0.53*u", "-0.85*y"], initial = -0.28 }}
z = {{ type = "integrator", in = ["-1.85*c", "-1.26*y", "-0.191*z"], initial = 0.9 }}
w = {{ type = "integrator", in = "-3.65*c", initial = -0.065{} }}
)toml",
                                    limit));
    return run_of(made, {.until = 4.5, .samples = 46});
  };
  const oblique::solve::Run free = run_with(""), limited = run_with(", limit = 1.85");
  const std::vector<double> t = row_values(free, "t"), w = row_values(free, "w"),
                            held = row_values(limited, "w");
  EXPECT_GT(w.back(), 1.9);  // it would go on
  for (std::size_t row = 0; row < t.size(); ++row) {
    if (t[row] < 4.155) {
      EXPECT_NEAR(held[row], w[row], 1e-6) << t[row];  // slides drift by 1e-7
    } else {
      EXPECT_NEAR(held[row], 1.85, 1e-6) << t[row];
    }
  }
  const std::vector<double> z = row_values(free, "z"), z_limited = row_values(limited, "z");
  for (std::size_t row = 0; row < t.size(); ++row) EXPECT_NEAR(z_limited[row], z[row], 1e-6) << t[row];
}

// An integrator leaves its limit where the mean of a slide that drives it turns round: at that moment it is
// at zero along with the slide, and none is told that it would turn over as often.
TEST(Slide, TellsNothingOfALimitThatIsLeftInAMoment) {
  const Compiled made(R"toml(
u = { type = "time-function", formula = "sin(time)" }
s = { type = "comparator", in = ["-z", "u"], low = -1 }
z = { type = "integrator", in = ["2*s"] }
x = { type = "integrator", in = ["s"], limit = 0.3 }
)toml");
  const oblique::solve::Run result = run_of(made, {.until = 5});
  for (const text::Diagnostic& warning : result.warnings)
    EXPECT_THAT(warning.what, ::testing::Not(::testing::HasSubstr("is at zero along"))) << warning.what;
}

// What drives a limited integrator turns over with the slide of its sign; nothing counts that, though the
// block has events.
TEST(Slide, TellsNothingOfADriveThatNoEventReads) {
  const Compiled made(R"toml(
c = { type = "sign", in = "x" }
x = { type = "integrator", in = "-0.3319*c", initial = 0.158, limit = 1.3, set = "zero" }
zero = { type = "constant", value = 0 }
)toml");
  EXPECT_TRUE(run_of(made, {.until = 3}).warnings.empty());
}

// What drives w is twice what slides, once the clock is low; as long as w is not at its limit nothing reads
// its sign.
TEST(Slide, TellsNothingOfADriveThatIsMaskedByItsLimit) {
  const Compiled made(R"toml(
clock = { type = "step", at = 0.5, from = 1, to = 0 }
a = { type = "sign", in = "x" }
x = { type = "integrator", in = "-3*a", initial = 0.4 }
w = { type = "integrator", in = ["2*x", "0.1*clock"], limit = 1 }
)toml");
  EXPECT_TRUE(run_of(made, {.until = 1}).warnings.empty());
}

}  // namespace
}  // namespace oblique::solve
