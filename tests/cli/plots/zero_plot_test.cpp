// SPDX-License-Identifier: MIT
// A constant 0 is drawn and told as 0, and not as what rounding makes of it.
#include <algorithm>
#include <fstream>

#include <nlohmann/json.hpp>

#include "../../support/arm.h"
#include "plot_reading.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ZeroPlot : public PlotTest {
 protected:
  std::string written(const std::string& name, const std::string& text) const {
    std::ofstream(file(name)) << text;
    return file(name);
  }

  /// Sums of an oscillation that cancel but for its last digits, 5e-17, each with its own unit.
  std::string noise(const std::string& run = "") const {
    return written("noise.toml", R"(
format = "oblique-diagram/1"
[run]
until = 10
)" + run + R"(
[blocks]
x = { type = "integrator", in = ["-y"], initial = 1 }
y = { type = "integrator", in = ["x"] }
d = { type = "summer", in = ["0.1*x", "0.2*x", "-0.3*x"] }
n = { type = "constant", value = "-0.0" }
[outputs]
power   = { signal = "d", scale = -1e3, unit = "W" }
nothing = { signal = "n", unit = "V" }
x       = { signal = "x", unit = "m" }
)");
  }
};

/// The numbers beside a plot, with where they stand.
std::vector<draw::Label> numbers_of(const Svg& svg, int panel) {
  std::vector<draw::Label> numbers = svg.labels();
  const AlignedBox2d plot = svg.plot(panel);
  std::erase_if(numbers, [&](const draw::Label& label) {
    return label.anchor != draw::Anchor::end || label.at.y() < plot.min().y() ||
           label.at.y() > plot.max().y() + 8;
  });
  return numbers;
}

/// A flat line in the middle of its plot, with 0 beside it, above it numbers and under it the same ones below
/// 0.
void expect_zero(const Svg& svg, int panel, int curve) {
  SCOPED_TRACE(panel);
  const AlignedBox2d plot = svg.plot(panel);
  const auto points = svg.curve(panel, curve);
  ASSERT_GE(points.size(), 2U);
  for (const Vector2d& point : points) ASSERT_NEAR(point.y(), plot.center().y(), 0.01);
  std::vector<std::string> above, below, beside;
  constexpr double kHalfDigit = 4;  // [px]; numbers stand on their baseline
  for (const draw::Label& number : numbers_of(svg, panel)) {
    const double off = plot.center().y() - (number.at.y() - kHalfDigit);
    (off > 1 ? above : off < -1 ? below : beside).push_back(number.text);
  }
  EXPECT_THAT(beside, ::testing::ElementsAre("0.0"));
  EXPECT_GE(above.size(), 2U);
  for (std::string& number : above) number = "−" + number;
  EXPECT_THAT(below, ::testing::UnorderedElementsAreArray(above));
}

std::string texts_of(const Svg& svg) {
  std::string texts;
  for (const draw::Label& label : svg.labels()) texts += label.text + "\n";
  return texts;
}

TEST_F(ZeroPlot, SignalsThatAreOnlyRoundingAreFlat) {
  const Svg svg = drawn("run " + noise());
  ASSERT_EQ(svg.panels(), 3);
  expect_zero(svg, 0, 0);
  expect_zero(svg, 1, 0);
  EXPECT_THAT(texts_of(svg), HasSubstr("power [W]\n"));
  const auto wave = svg.curve(2, 0);
  const auto [top, bottom] = std::minmax_element(wave.begin(), wave.end(),
                                                 [](const auto& a, const auto& b) { return a.y() < b.y(); });
  EXPECT_GT(bottom->y() - top->y(), 0.9 * svg.plot(2).sizes().y());  // what is no 0 is as it was
}

TEST_F(ZeroPlot, AFinerToleranceSeesSmallSignals) {
  const Svg svg = drawn("run " + noise("absolute_tolerance = 1e-20"));
  EXPECT_THAT(texts_of(svg), HasSubstr("power [10⁻¹⁵ W]\n"));
}

TEST_F(ZeroPlot, TheTerminalShowsTheSame) {
  const std::string text = oblique("run " + noise() + " --columns power --plot -").out;
  EXPECT_THAT(text, HasSubstr("power [W]\n"));
  EXPECT_THAT(text, HasSubstr(" 0.0 ┤⠤⠤⠤⠤⠤⠤⠤"));
  EXPECT_THAT(text, Not(HasSubstr("10⁻")));
}

// A rod that is only shifted: the analog one errs by the last digits of its coordinates, 1e-14 mm of 30.
TEST_F(ZeroPlot, ErrorsOfAnExactPatchAreFlat) {
  const Svg svg = drawn("compare " + written("lift.toml", R"(
format = "oblique-mechanism/1"
[units]
length = "mm"
[frame]
O = [0.1, 0.2]
X = [1, 3]
[bodies]
rod = { points = ["A", "B"], length = 30 }
[slides]
s = { point = "A", along = ["O", "X"], of = "rod", angle = "30 deg" }
[drives]
lift = { slides = "s", speed = "-20 mm/s", start = 50 }
[motion]
until = 1
)"));
  expect_zero(svg, 0, 0);
  for (int gain = 0; gain < 5; ++gain) expect_zero(svg, 1, gain);
  const std::string texts = texts_of(svg);
  EXPECT_THAT(texts, HasSubstr("largest error [mm]\n"));
  EXPECT_THAT(texts, HasSubstr("no more than rounding are drawn as 0"));
  EXPECT_THAT(texts, Not(HasSubstr("solver's tolerance leaves")));
}

// The arm has no loops that could lag; what its integrators err is the solver's, and no rounding.
TEST_F(ZeroPlot, APartThatIsNothingHasNoSign) {
  const std::string arm = written("arm.toml", test::kArm);
  const Outcome table = oblique("compare " + arm);
  EXPECT_EQ(table.status, 0) << table.err;
  EXPECT_THAT(table.out, HasSubstr("  0.000e+00  "));
  EXPECT_THAT(table.out, Not(HasSubstr("-0.000e+00")));
  EXPECT_THAT(oblique("compare " + arm + " --json").out, Not(HasSubstr("\"lag\": -0.0")));
  const Svg svg = drawn("compare " + arm);
  EXPECT_THAT(texts_of(svg), HasSubstr("10⁻¹¹"));
}

// The guide of the yoke keeps a right angle, whose cosine is no weight.
TEST_F(ZeroPlot, WeightsOfRightAnglesAreZeroInSchematics) {
  for (const std::string method : {"triangles", "gradient"}) {
    ASSERT_EQ(
        oblique("patch diagrams/mechanisms/scotch-yoke.toml --method " + method + " -o " + file("yoke.toml"))
            .status,
        0);
    ASSERT_EQ(oblique("draw " + file("yoke.toml") + " -o " + file("yoke.svg")).status, 0);
    const std::string texts = texts_of(Svg(bytes_of("yoke.svg")));
    EXPECT_THAT(texts, HasSubstr("\n0\n")) << method;
    EXPECT_THAT(texts, Not(HasSubstr("e-1"))) << method;
  }
}

// The end of an arm that folds back onto its pivot stands still: 1e-14 mm in place, 1e-13 mm/s.
TEST_F(ZeroPlot, APointThatStandsHasNoVelocity) {
  const std::string folded = written("folded.toml", R"(
format = "oblique-mechanism/1"
[units]
length = "mm"
[frame]
O = [0, 0]
[bodies]
bar = { points = ["O", "Q"], length = 100.1 }
arm = { points = ["Q", "R"], length = 50, marks = { M = [100.1, 0] } }
[drives]
crank   = { turns = "bar", about = "O", speed = "60 rpm", start = "10 deg" }
counter = { turns = "arm", about = "Q", speed = "60 rpm", start = "190 deg" }
)");
  ASSERT_EQ(oblique("draw " + folded + " --plots M -o " + file("points.svg")).status, 0);
  const Svg svg(bytes_of("points.svg"));
  EXPECT_THAT(texts_of(svg), Not(HasSubstr("10⁻")));
  for (int panel = 2; panel < 6; ++panel) {
    for (const Vector2d& point : svg.curve(panel, 0))
      EXPECT_NEAR(point.y(), svg.plot(panel).center().y(), 0.01) << panel;
  }
}

}  // namespace
}  // namespace oblique::test
