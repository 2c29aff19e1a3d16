// SPDX-License-Identifier: MIT
// What lanes give, against closed forms.
#include <oblique/ensemble/lanes/lane_runner.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/ensemble/engine/ensemble.h>
#include <oblique/ensemble/lanes/lane_method.h>
#include <oblique/network/assembly/parameter_numbers.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

using Rows = std::vector<double>;

struct Machines {
  testing::Compiled compiled;
  std::vector<std::uint32_t> varied;
  EnsembleOptions options;
  EnsembleCount count;
  std::map<std::uint64_t, std::size_t> steps;

  Machines(std::string_view blocks, const std::vector<std::string>& names,
           const std::string& outputs = "x = \"x\"")
      : compiled(blocks, "\n[outputs]\n" + outputs + "\n") {
    const network::ParameterNumbers numbers(compiled.flat);
    for (const std::string& name : names)
      varied.push_back(network::find_parameter(compiled.flat, numbers, name).value().number);
    options.run.samples = 11;
    options.run.tolerance = 1e-6;
  }

  /// Machine k with these values of what varies.
  std::map<std::uint64_t, Rows> run(std::uint64_t count_, const Ensemble::Values& values) {
    const Ensemble ensemble(compiled.flat, varied, options);
    std::map<std::uint64_t, Rows> all;
    count = ensemble.run(0, count_, values, [&](const MachineRun& run) {
      all[run.number] = {run.rows.begin(), run.rows.end()};
      steps[run.number] = run.steps;
    });
    return all;
  }
};

double at(std::uint64_t number) {
  return static_cast<double>(number);
}

TEST(LaneRunner, DecaysOfDrawnRatesAndStarts) {
  Machines decays("x = { type = \"integrator\", in = [\"-1*x\"], initial = 1 }", {"x.in[1]", "x.initial"});
  const auto all = decays.run(100, [](std::uint64_t k, std::span<double> values) {
    values[0] = -0.1 * at(k);
    values[1] = 1 - 0.005 * at(k);
  });
  EXPECT_EQ(decays.count.in_lanes, 100U);
  for (const auto& [k, rows] : all) {
    ASSERT_EQ(rows.size(), 22U);
    for (std::size_t r = 0; r < 11; ++r) {
      const double t = 0.1 * static_cast<double>(r);
      EXPECT_NEAR(rows[2 * r], t, 1e-15);
      // the tolerance asked for
      EXPECT_NEAR(rows[2 * r + 1], (1 - 0.005 * at(k)) * std::exp(-0.1 * at(k) * t), 1e-6) << k;
    }
  }
}

// x″ = −ω² x + sin(Ω t) with ω and Ω drawn: the drive may turn some thousand times within what would else be
// a step.
TEST(LaneRunner, DrivesThatTurnFastAreNotSteppedOver) {
  Machines driven(R"(
      drive = { type = "sine-source", amplitude = 1, frequency = 10 }
      x = { type = "integrator", in = ["v"] }
      v = { type = "integrator", in = ["-1*x", "drive"] })",
                  {"drive.frequency", "v.in[1]"});
  driven.options.run.until = 3;
  const auto all = driven.run(8, [](std::uint64_t k, std::span<double> values) {
    values[0] = 0.3 * std::pow(3.0, at(k));
    values[1] = -(2.0 + at(k));
  });
  EXPECT_GE(driven.count.in_lanes, 6U);  // the others begin with beats below the tolerance
  for (const auto& [k, rows] : all) {
    const double drive = 2 * std::numbers::pi * 0.3 * std::pow(3.0, at(k)), own = std::sqrt(2.0 + at(k));
    for (std::size_t r = 0; r < 11; ++r) {
      const double t = rows[2 * r];
      const double truth =
          (std::sin(drive * t) - drive / own * std::sin(own * t)) / (own * own - drive * drive);
      EXPECT_NEAR(rows[2 * r + 1], truth, 2e-6)
          << k;  // the tolerance, and twice it for the length of the run
    }
  }
}

// A multiplier of the class of real ones, whose error is ε sin(7π cos Ωt) sin(7π · 0.5): x is an integral of
// what turns 7π times as fast as the drive.
TEST(LaneRunner, ErrorsOfMultipliersOfTheTimeAreNotSteppedOver) {
  Machines product(R"(
      half = { type = "constant", value = 0.5 }
      drive = { type = "sine-source", amplitude = 1, frequency = 2 }
      m = { type = "multiplier", in = ["drive", "half"], error = 0.01 }
      x = { type = "integrator", in = ["10*m"] })",
                   {"m.error"});
  product.options.run.until = 0.9;
  const auto all =
      product.run(4, [](std::uint64_t k, std::span<double> values) { values[0] = 0.01 * at(k + 1); });
  EXPECT_EQ(product.count.in_lanes, 4U);
  const double pi = std::numbers::pi;
  for (const auto& [k, rows] : all) {
    double truth = 0;  // by the rule of midpoints, whose error is 1e-9 here
    constexpr int kParts = 200'000;
    for (int i = 0; i < kParts; ++i) {
      const double drive = std::sin(2 * pi * 2 * 0.9 * (i + 0.5) / kParts);
      truth += 10 * (drive / 2 + 0.01 * at(k + 1) * std::sin(7 * pi * drive) * std::sin(7 * pi / 2)) * 0.9 /
               kParts;
    }
    EXPECT_NEAR(rows[21], truth, 1e-6) << k;
  }
}

// s = a x − b s, so that dx/dt = −s = −a x/(1 + b): the loop is an unknown of its own in the lanes.
TEST(LaneRunner, LoopsAreUnknowns) {
  Machines loops(R"(
      s = { type = "summer", in = ["1*x", "-0.5*s"] }
      x = { type = "integrator", in = ["-1*s"], initial = 1 })",
                 {"s.in[1]", "s.in[2]"}, "x = \"x\"\ns = \"s\"");
  const auto all = loops.run(20, [](std::uint64_t k, std::span<double> values) {
    values[0] = 1 + 0.002 * at(k);
    values[1] = -0.5 - 0.002 * at(k);
  });
  EXPECT_EQ(loops.count.in_lanes, 20U);
  for (const auto& [k, rows] : all) {
    const double rate = (1 + 0.002 * at(k)) / (1.5 + 0.002 * at(k));
    for (std::size_t r = 0; r < 11; ++r) {
      EXPECT_NEAR(rows[3 * r + 1], std::exp(-rate * rows[3 * r]), 1e-6);
      EXPECT_NEAR(rows[3 * r + 2], rate * std::exp(-rate * rows[3 * r]), 2e-6);
    }
  }
}

// A servo amplifier that follows √x: at rest before the clock starts, stiff afterwards (a rate of 6e7/s), and
// between the ends of a step no worse than there.
TEST(LaneRunner, ServosComeToRestAndFollowBetweenTheStepsToo) {
  Machines roots(R"(
      one = { type = "constant" }
      x = { type = "integrator", in = ["0.8*one"], initial = 0.1 }
      y = { type = "servo-amplifier", in = ["square", "-x"], gain = 1e6, bandwidth = 100, initial = 1 }
      square = { type = "squarer", in = "y" })",
                 {"x.in[1]", "x.initial"}, "y = \"y\"");
  roots.options.run.samples = 301;
  const auto all = roots.run(20, [](std::uint64_t k, std::span<double> values) {
    values[0] = 0.8 + 0.002 * at(k);
    values[1] = 0.1 + 0.001 * at(k);
  });
  EXPECT_EQ(roots.count.in_lanes, 20U);
  for (const auto& [k, rows] : all) {
    EXPECT_LT(roots.steps.at(k), 100U);  // so that most rows lie between
    for (std::size_t r = 0; r < 301; ++r) {
      const double x = 0.1 + 0.001 * at(k) + (0.8 + 0.002 * at(k)) * rows[2 * r];
      EXPECT_NEAR(rows[2 * r + 1], std::sqrt(x), 1e-6 + 1e-6 / std::sqrt(x))
          << k << " row " << r;  // 1/gain of the loop
    }
  }
}

// Of order p, ten times finer: the steps grow by 10^(1/p). The start and the last step weigh some per cent.
TEST(LaneRunner, IsOfOrderFiveOrSeven) {
  Machines swings(R"(
      x = { type = "integrator", in = ["v"], initial = 1 }
      v = { type = "integrator", in = ["-1*sine"] }
      sine = { type = "sine", in = "x" })",
                  {"v.in[1]"});
  swings.options.run.until = 10;
  swings.options.run.samples = 2;
  const auto steps_at = [&](diagram::IntegrationMethod method, double tolerance) {
    swings.options.run.method = method;
    swings.options.run.tolerance = tolerance;
    swings.run(4, [](std::uint64_t, std::span<double> values) { values[0] = -1; });
    EXPECT_EQ(swings.count.in_lanes, 4U);
    return static_cast<double>(swings.steps.at(0));
  };
  using Method = diagram::IntegrationMethod;
  EXPECT_NEAR(std::log10(steps_at(Method::bdf, 1e-10) / steps_at(Method::bdf, 1e-6)) / 4, 1. / 5, 0.02);
  EXPECT_NEAR(std::log10(steps_at(Method::adams, 1e-11) / steps_at(Method::adams, 1e-6)) / 5, 1. / 7, 0.02);
}

// x″ = −x, by both methods, at many rows within each step.
TEST(LaneRunner, BothMethodsAreExactBetweenTheSteps) {
  for (const auto method : {diagram::IntegrationMethod::bdf, diagram::IntegrationMethod::adams}) {
    Machines circles(R"(
        x = { type = "integrator", in = ["2*v"], initial = 1 }
        v = { type = "integrator", in = ["-2*x"] })",
                     {"x.in[1]", "v.in[1]"});
    circles.options.run.method = method;
    circles.options.run.until = 10;
    circles.options.run.samples = 1001;
    circles.options.run.tolerance = 1e-8;
    const auto all = circles.run(5, [](std::uint64_t k, std::span<double> values) {
      values[0] = 1 + at(k);
      values[1] = -1 - at(k);
    });
    EXPECT_EQ(circles.count.in_lanes, 5U);
    for (const auto& [k, rows] : all) {
      for (std::size_t r = 0; r < 1001; ++r) {
        // the tolerance, for each of the up to 8 turns
        EXPECT_NEAR(rows[2 * r + 1], std::cos((1 + at(k)) * rows[2 * r]), 8e-8) << k << " row " << r;
      }
    }
  }
}

TEST(LaneRunner, TheSameNumbersHoweverTheyAreRun) {
  const auto run = [](int width, const char* set, int threads, std::uint64_t first) {
    Machines decays(R"(
        x = { type = "integrator", in = ["v"], initial = 1 }
        v = { type = "integrator", in = ["-1*cube", "0.3*c"] }
        c = { type = "sine-source", amplitude = 1, frequency = 0.3 }
        square = { type = "squarer", in = "x" }
        cube = { type = "multiplier", in = ["square", "x"] })",
                    {"v.in[1]", "v.in[2]"});
    decays.options.width = width;
    decays.options.set = set;
    decays.options.threads = threads;
    decays.options.run.until = 5;
    const Ensemble ensemble(decays.compiled.flat, decays.varied, decays.options);
    std::vector<Rows> all(60);
    const EnsembleCount count = ensemble.run(
        first, 60 - first,
        [](std::uint64_t k, std::span<double> values) {
          values[0] = -0.2 - 0.7 * at(k);
          values[1] = 0.1 * at(k);
        },
        [&](const MachineRun& one) {
          all[one.number] = {one.rows.begin(), one.rows.end()};
        });
    EXPECT_EQ(count.in_lanes, 60 - first);
    return all;
  };
  const std::vector<Rows> truth = run(4, "sse2", 1, 0);
  for (const char* set : {"sse2", "avx2", "avx512"}) {
    if (lane_kernels(4, set) == nullptr) continue;
    for (const int width : {4, 8, 16}) EXPECT_EQ(run(width, set, 1, 0), truth) << set << " " << width;
  }
  EXPECT_EQ(run(0, "", 2, 0), truth);
  std::vector<Rows> last = run(0, "", 1, 37);
  EXPECT_TRUE(std::equal(last.begin() + 37, last.end(), truth.begin() + 37));
}

// What a lane cannot do is told of, and its neighbours have the numbers that they have without it.
TEST(LaneRunner, AMachineThatGrowsWithoutBoundLeavesItsNeighboursAlone) {
  Machines squares(R"(
      x = { type = "integrator", in = ["-1*square"], initial = 0.5 }
      square = { type = "squarer", in = "x" })",
                   {"x.in[1]"});
  const auto values = [](std::uint64_t k, std::span<double> rates) { rates[0] = k == 5 ? 4 : -0.1 * at(k); };
  const auto all = squares.run(16, values);
  EXPECT_EQ(squares.count.in_lanes, 15U);
  EXPECT_EQ(squares.count.by_cvodes, 1U);
  EXPECT_EQ(squares.count.failed, 1U);  // x = 1/(2 − 4 t) has no end
  for (const auto& [k, rows] : all) {
    if (k == 5) continue;
    EXPECT_NEAR(rows[21], 1 / (2 + 0.1 * at(k)), 1e-6) << k;
  }
}

// y³ − y = a, from `initial`: whoever comes from below 0 comes to another root than the typical machine,
// which Newton's method from the typical rest would not find.
TEST(LaneRunner, AMachineComesToTheRestThatItsLoopsRunTo) {
  Machines roots(R"(
      a = { type = "constant", value = 0.1 }
      y = { type = "servo-amplifier", gain = 1e6, bandwidth = 100, in = ["y3", "-y", "-a"], initial = 1 }
      yy = { type = "squarer", in = "y" }
      y3 = { type = "multiplier", in = ["yy", "y"] }
      k = { type = "integrator", in = ["0.1*y"] })",
                 {"y.initial", "a.value"}, "y = \"y\"");
  const auto all = roots.run(9, [](std::uint64_t k, std::span<double> values) {
    values[0] = k < 3 ? 1 : k < 6 ? -2 : 2;
    values[1] = 0.1 + 0.001 * at(k);
  });
  EXPECT_EQ(roots.count.in_lanes, 9U);
  for (const auto& [k, rows] : all) {
    const double y = rows[1], a = 0.1 + 0.001 * at(k);
    EXPECT_NEAR(y * y * y - y, a, 1e-5);  // 1/gain
    EXPECT_EQ(y > 0, k < 3 || k >= 6) << k;
  }
}

// A loop whose sign turns runs away, although it has a rest: the lanes' method would damp it.
TEST(LaneRunner, ALoopThatRunsAwayHasNoNumbers) {
  Machines loops(R"(
      c = { type = "constant", value = 0.1 }
      g = { type = "gain", factor = 1, in = "y" }
      y = { type = "servo-amplifier", gain = 1e6, bandwidth = 100, in = ["g", "-c"] }
      k = { type = "integrator", in = ["y"] })",
                 {"g.factor"}, "y = \"y\"");
  const auto all =
      loops.run(6, [](std::uint64_t k, std::span<double> values) { values[0] = k < 3 ? 1 : -1; });
  EXPECT_EQ(loops.count.in_lanes, 3U);
  EXPECT_EQ(loops.count.failed, 3U);
}

// ∫ sin^2048: its peaks are a fiftieth of a radian wide. By Wallis' product the integral over a turn is 2π
// C(2n, n)/4^n.
TEST(LaneRunner, NarrowPowersOfASineAreNotSteppedOver) {
  std::string blocks = "w = { type = \"sine-source\", frequency = \"1/(2*pi)\", phase = 0 }\n";
  blocks += "s0 = { type = \"squarer\", in = \"w\" }\n";
  for (int k = 1; k <= 10; ++k)
    blocks +=
        "s" + std::to_string(k) + " = { type = \"squarer\", in = \"s" + std::to_string(k - 1) + "\" }\n";
  Machines peaks(blocks + "x = { type = \"integrator\", in = [\"s10\"] }", {"w.phase"});
  peaks.options.run.until = 2 * std::numbers::pi;
  const auto all = peaks.run(20, [](std::uint64_t k, std::span<double> values) { values[0] = 0.1 * at(k); });
  EXPECT_EQ(peaks.count.in_lanes, 20U);
  double truth = 2 * std::numbers::pi;
  for (int n = 1; n <= 1024; ++n) truth *= (2.0 * n - 1) / (2.0 * n);
  for (const auto& [k, rows] : all) EXPECT_NEAR(rows[21], truth, 1e-6) << k;
}

// x′ = x − x² from 1e-12: below the absolute tolerance the size of x is not known, and it comes back from
// there. And x′ = (t − 10) x, which sinks to e^−50 of its start.
TEST(LaneRunner, WhatGrowsFromBelowTheToleranceIsLeftToCvodes) {
  Machines logistic(R"(
      x = { type = "integrator", in = ["x", "-xx"], initial = 0.1 }
      xx = { type = "squarer", in = "x" })",
                    {"x.initial"});
  logistic.options.run.until = 40;
  const auto all = logistic.run(
      4, [](std::uint64_t k, std::span<double> values) { values[0] = std::pow(10.0, -4 * at(k + 1)); });
  EXPECT_GE(logistic.count.by_cvodes, 3U);
  for (const auto& [k, rows] : all) {
    const double start = std::pow(10.0, -4 * at(k + 1));
    for (std::size_t r = 0; r < 11; ++r) {
      const double grown = start * std::exp(rows[2 * r]);
      EXPECT_NEAR(rows[2 * r + 1], grown / (1 - start + grown), 1e-5) << k << " row " << r;
    }
  }
  Machines trough(R"(
      one = { type = "constant" }
      c = { type = "integrator", in = ["one"], initial = -10 }
      p = { type = "multiplier", in = ["c", "x"] }
      x = { type = "integrator", in = ["p"], rate = 0.1, initial = 1 })",
                  {"x.rate"});
  trough.options.run.until = 20;
  const auto back =
      trough.run(6, [](std::uint64_t k, std::span<double> values) { values[0] = 0.1 + 0.15 * at(k); });
  EXPECT_GE(trough.count.by_cvodes, 2U);
  for (const auto& [k, rows] : back)
    EXPECT_NEAR(rows[21], 1, 1e-4) << k;  // four digits are what lanes know at least
}

// x = cos t + sin t, and v, which has the size that its machine gives it. In the order of pivots of the
// typical machine, of size 1, a rate of v is divided by one of x.
TEST(LaneRunner, AMachineThatItsOrderOfPivotsDoesNotSuitIsLeftToCvodes) {
  Machines circles(R"(
      x = { type = "integrator", in = ["1*v"], initial = 1 }
      v = { type = "integrator", in = ["-1*x"], initial = 1 })",
                   {"x.in[1]", "v.in[1]", "v.initial"});
  circles.options.run.method = diagram::IntegrationMethod::rodas;
  const auto all = circles.run(8, [](std::uint64_t k, std::span<double> values) {
    const double size = k == 3 ? 1e10 : 1;
    values[0] = 1 / size;
    values[1] = -size;
    values[2] = size;
  });
  EXPECT_EQ(circles.count.in_lanes, 7U);
  EXPECT_EQ(circles.count.reasons,
            (std::map<std::string, std::uint64_t>{{"the order of pivots does not suit", 1}}));
  for (const auto& [k, rows] : all)
    EXPECT_NEAR(rows[21], std::cos(1) + std::sin(1), 2e-6) << k;  // the tolerance, of a size of √2
}

// Of the servo y² = x with x below zero there is no rest near that of the typical machine.
TEST(LaneRunner, AMachineWithoutRestIsLeftToCvodes) {
  Machines roots(R"(
      one = { type = "constant" }
      x = { type = "integrator", in = ["0.2*one"], initial = 0.5 }
      y = { type = "servo-amplifier", in = ["square", "-x"], gain = 1e6, bandwidth = 100, initial = 1 }
      square = { type = "squarer", in = "y" })",
                 {"x.initial"}, "y = \"y\"");
  const auto all =
      roots.run(8, [](std::uint64_t k, std::span<double> values) { values[0] = k == 3 ? -0.5 : 0.5; });
  EXPECT_EQ(roots.count.in_lanes, 7U);
  EXPECT_EQ(roots.count.reasons, (std::map<std::string, std::uint64_t>{
                                     {"its loops do not settle as those of the typical machine do", 1}}));
}

// y³ − y = x has three solutions near x = 0; a servo comes to the outer ones, to that on whose side its
// amplifier starts, and follows it: 4 (y/2)³ − 3 (y/2) is the cosine of a triple angle. The servo is behind
// by 1e-7, and the run errs by less than its tolerance.
TEST(LaneRunner, FarMachinesComeToTheRestThatTheirLoopsRunTo) {
  Machines cubes(R"(
      one = { type = "constant" }
      x = { type = "integrator", in = ["0.01*one"], initial = 0 }
      y = { type = "servo-amplifier", in = ["cube", "-y", "-x"], gain = 1e6, bandwidth = 100, initial = 1 }
      square = { type = "squarer", in = "y" }
      cube = { type = "multiplier", in = ["square", "y"] })",
                 {"y.initial", "x.initial", "y.gain"}, "y = \"y\"");
  const auto all = cubes.run(48, [](std::uint64_t k, std::span<double> values) {
    values[0] = (k % 2 == 0 ? 1 : -1) * (0.7 + 0.02 * at(k));
    values[1] = -0.3 + 0.01 * at(k);
    values[2] = k % 3 == 0 ? 1e5 : 1e7;
  });
  EXPECT_EQ(cubes.count.in_lanes, 48U);
  for (const auto& [k, rows] : all) {
    for (std::size_t r = 0; r < 11; ++r) {
      const double x = -0.3 + 0.01 * at(k) + 0.01 * rows[2 * r];
      const double side = k % 2 == 0 ? 1 : -1;
      const double angle = std::acos(side * x * std::sqrt(27.0) / 2) / 3;
      EXPECT_NEAR(rows[2 * r + 1], side * 2 / std::sqrt(3.0) * std::cos(angle), 2e-5) << k << " row " << r;
    }
  }
}

// x′ = g x: e^(10 g) is above 100 from g = 0.47 on, and grows by √2 and more in an eighth of the run from
// 0.28 on. The square that no output has passes 100 from 0.23 on, and grows twice as fast.
TEST(LaneRunner, WhatARunWarnsOfOrFailsForIsLeftToCvodes) {
  Machines growing(R"(
      g = { type = "gain", factor = 0.1, in = "x" }
      x = { type = "integrator", in = ["g"], initial = 1 }
      square = { type = "squarer", in = "x" })",
                   {"g.factor"});
  growing.options.run.until = 10;
  growing.options.run.samples = 81;
  const auto all =
      growing.run(21, [](std::uint64_t k, std::span<double> values) { values[0] = 0.05 * at(k) + 0.01; });
  EXPECT_EQ(growing.count.in_lanes, 5U);
  EXPECT_EQ(growing.count.warned, 16U);
  EXPECT_EQ(growing.count.first_warned.value().first, 5U);
  EXPECT_EQ(growing.count.reasons,
            (std::map<std::string, std::uint64_t>{{"a signal leaves the machine", 16}}));
  for (const auto& [k, rows] : all) EXPECT_NEAR(rows.back() * std::exp(-0.5 * at(k) - 0.1), 1, 1e-4) << k;

  Machines logarithms(R"(
      x = { type = "integrator", in = ["-1*x"], initial = 1 }
      log = { type = "logarithm", in = "x" })",
                      {"x.initial"});
  logarithms.run(8, [](std::uint64_t k, std::span<double> values) { values[0] = 1 - 0.4 * at(k) + 0.01; });
  EXPECT_EQ(logarithms.count.in_lanes, 3U);
  EXPECT_EQ(logarithms.count.failed, 5U);
  EXPECT_EQ(logarithms.count.reasons,
            (std::map<std::string, std::uint64_t>{{"a signal that is no number", 5}}));
}

// Of y² = x with y below zero the servo runs away, and CVODES says so.
TEST(LaneRunner, LoopsThatDoNotSettleAreLeftToCvodes) {
  Machines roots(R"(
      x = { type = "constant", value = 0.5 }
      y = { type = "servo-amplifier", in = ["square", "-x"], gain = 1e6, bandwidth = 100, initial = 1 }
      square = { type = "squarer", in = "y" })",
                 {"y.initial"}, "y = \"y\"");
  const auto all = roots.run(
      8, [](std::uint64_t k, std::span<double> values) { values[0] = k < 4 ? 3 + at(k) : -3 - at(k); });
  EXPECT_EQ(roots.count.in_lanes, 4U);
  EXPECT_EQ(roots.count.failed, 4U);
  for (const std::uint64_t k : {0U, 1U, 2U, 3U}) EXPECT_NEAR(all.at(k).back(), std::sqrt(0.5), 1e-5) << k;
}

// With the first terms of (1.5 + x)^(−1/p) about x = 0, of which the next are left out: less than
// (1/3)⁵/10 = 4e-4 for |x| ≤ 1/2.
TEST(LaneRunner, MakesTheNextStepLongerByTheRootOfTheError) {
  for (const int p : {5, 7}) {
    double root[5] = {std::pow(1.5, -1.0 / p)};
    for (int n = 1; n < 5; ++n) root[n] = root[n - 1] * (-1.0 / p - (n - 1)) / n / 1.5;
    std::vector<double> powers(static_cast<std::size_t>(p));
    for (int k = 0; k < p; ++k)
      powers[static_cast<std::size_t>(k)] = std::pow(2.0, -static_cast<double>(k) / p);
    for (double error = 1e-8; error < 1e8; error *= 1.1) {
      const double exact = std::clamp(0.9 * std::pow(error, -1.0 / p), 0.2, 6.0);
      EXPECT_NEAR(step_factor_of(error, p, root, powers.data()) / exact, 1, 5e-4) << error;
    }
  }
}

}  // namespace
}  // namespace oblique::ensemble
