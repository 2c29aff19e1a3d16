// SPDX-License-Identifier: MIT
#include <oblique/compare/monte_carlo.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <Eigen/Core>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/assembly.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

#include "crank.h"

namespace oblique::compare {
namespace {

using std::numbers::pi;

mechanism::Mechanism four_bar() {
  return mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
}

MonteCarlo drawn(const mechanism::Mechanism& mechanism, const MonteCarloOptions& options) {
  patch::PatchOptions patch_options;
  patch_options.gain = 1e6;
  return monte_carlo(mechanism, patch::patch(mechanism, patch_options), diagram::BlockLibrary::shipped(),
                     options);
}

// A crank alone: B = r ((1 + e) cos φ, (1 + f) sin φ), each coordinate a summer, errs most on an axis, by
// r max(|e|, |f|): of two uniform variables on [0, 1] the larger has the mean 2/3, the variance 1/18, and is
// below q with the probability q².
TEST(MonteCarlo, OfACrankIsTheLargerOfTwoTolerances) {
  const mechanism::Mechanism mechanism = testing::crank();
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  options.runs = 4000;
  options.threads = 2;
  const MonteCarlo result = drawn(mechanism, options);
  double sum = 0, squares = 0;
  for (const auto& error : result.errors) {
    const double part = error.value() / (2 * 0.01);
    sum += part;
    squares += part * part;
  }
  const double mean = sum / 4000, deviation = std::sqrt(squares / 4000 - mean * mean);
  // Four standard deviations of the sample's mean, and of its standard deviation, which for this density has
  // the relative deviation √((κ − 1)/4n) with the kurtosis κ = 2.4. The solver adds 1e-5 of 2e-2.
  EXPECT_NEAR(mean, 2.0 / 3, 4 * std::sqrt(1.0 / 18 / 4000) + 1e-3);
  EXPECT_NEAR(deviation, std::sqrt(1.0 / 18), 4 * std::sqrt(1.0 / 18) * std::sqrt(1.4 / 4 / 4000) + 1e-3);
  EXPECT_NEAR(result.percentile(25).value() / 0.02, 0.5, 0.03);  // 4 √(0.25·0.75/n)/(2 · 0.5)
}

// The same crank errs by r √(e² cos² φ + f² sin² φ) at φ, with the e and f that `draw` tells of each run. Of
// 200 runs the k-th smallest is the percentile 100 k/200. The solver adds 1e-5 of 2e-2.
TEST(MonteCarlo, PercentilesAlongTheTurnAreThoseOfTheSortedRuns) {
  const mechanism::Mechanism mechanism = testing::crank();
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  options.runs = 200;
  options.threads = 2;
  const MonteCarlo result = drawn(mechanism, options);
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();  // which the flat diagram refers to
  const diagram::FlatDiagram flat = diagram::flatten(patch::patch(mechanism, {}), library);
  ASSERT_EQ(result.drive.size(), 361U);
  ASSERT_EQ(result.along.size(), 200U);
  std::vector<std::array<double, 2>> scatter;
  for (std::uint64_t run = 0; run < 200; ++run) {
    std::array<double, 2> e{};
    for (const ensemble::Draw& draw : ensemble::draw(flat, options.scatters, {options.seed, run}))
      e.at(flat.blocks[draw.block].path.ends_with("x") ? 0 : 1) = draw.value;
    scatter.push_back(e);
  }
  for (const int percent : {1, 25, 50, 97, 100}) {
    const std::vector<double> found = result.percentile_along(percent);
    ASSERT_EQ(found.size(), 361U);
    for (std::size_t row = 0; row < 361; ++row) {
      const double angle = 2 * pi * static_cast<double>(row) / 360;
      EXPECT_NEAR(result.drive[row], angle, 1e-9);
      std::vector<double> sorted;
      for (const auto& [e, f] : scatter)
        sorted.push_back(2 * std::hypot(e * std::cos(angle), f * std::sin(angle)));
      std::sort(sorted.begin(), sorted.end());
      EXPECT_NEAR(found[row], sorted[static_cast<std::size_t>(2 * percent - 1)], 2e-5)
          << percent << " " << row;
    }
  }
}

// Of that crank the part q² of all machines errs by less than q r w: a quarter by less than half.
TEST(MonteCarlo, TellsTheYieldAndStopsWhereItIsKnown) {
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  options.runs = 2000;
  options.threads = 2;
  options.good_below = 0.01;
  const MonteCarlo all = drawn(testing::crank(), options);
  ASSERT_TRUE(all.yield);
  EXPECT_EQ(all.yield->machines, 2000U);
  const auto good =
      std::count_if(all.errors.begin(), all.errors.end(), [](const auto& e) { return *e < 0.01; });
  EXPECT_EQ(all.yield->good, static_cast<std::uint64_t>(good));
  EXPECT_NEAR(all.yield->part(), 0.25, 4 * std::sqrt(0.25 * 0.75 / 2000));  // four standard deviations
  options.until_within = 0.05;
  const MonteCarlo some = drawn(testing::crank(), options);
  // 1.96 √(0.25·0.75/n) = 0.05 at n = 288
  EXPECT_GE(some.errors.size(), 200U);
  EXPECT_LE(some.errors.size(), 400U);
  EXPECT_LE(some.yield->high - some.yield->low, 0.1);
  EXPECT_EQ(some.along.size(), some.errors.size());
  EXPECT_TRUE(std::equal(some.errors.begin(), some.errors.end(), all.errors.begin()));
}

/// The largest error of the four-bar over 361 positions when the summers of its patch err in their ratio:
/// those of B, of the vector B → D, of C and of M, each for x and y; exact triangles, in closed form.
double four_bar_error(const std::array<double, 8>& e) {
  constexpr double kCouplerLength = 3.5, kRockerLength = 3, kFrameLength = 4;
  using Vector = Eigen::Vector2d;
  const auto scaled = [&](const Vector& v, std::size_t k) {
    return Vector((1 + e[k]) * v.x(), (1 + e[k + 1]) * v.y());
  };
  struct Points {
    Vector b, c, m;
  };
  const auto place = [&](double angle, auto&& summed) {
    Points p;
    p.b = summed(Vector(std::cos(angle), std::sin(angle)), 0);
    const Vector d = summed(Vector(kFrameLength, 0) - p.b, 2);
    const double length = d.norm();
    const double cosine =
        (kCouplerLength * kCouplerLength + length * length - kRockerLength * kRockerLength) /
        (2 * kCouplerLength * length);
    const double sine = std::sqrt(1 - cosine * cosine);
    const Vector along = d / length, across(-along.y(), along.x());
    p.c = summed(p.b + kCouplerLength * (cosine * along + sine * across), 4);
    const Vector bc = p.c - p.b;
    p.m = summed(p.b + 0.5 * bc + Vector(-bc.y(), bc.x()) / kCouplerLength, 6);
    return p;
  };
  double largest = 0;
  for (int row = 0; row < 361; ++row) {
    const double angle = 2 * pi * row / 360;
    const Points exact = place(angle, [](const Vector& v, std::size_t) { return v; });
    const Points here = place(angle, scaled);
    largest =
        std::max({largest, (here.b - exact.b).norm(), (here.c - exact.c).norm(), (here.m - exact.m).norm()});
  }
  return largest;
}

// Of 1500 machines, the part below each percentile of 20 000 closed-form four-bars, drawn by another
// generator, lies within four standard deviations √(p (1 − p)/n) of p. The amplifiers of gain 1e6 and the
// solver add 1e-4 of such an error at the most.
TEST(MonteCarlo, OfTheFourBarIsThatOfItsClosedForm) {
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  options.runs = 1500;
  options.threads = 2;
  const MonteCarlo result = drawn(four_bar(), options);
  std::mt19937_64 generator(99);
  std::uniform_real_distribution<double> uniform(-0.01, 0.01);
  std::vector<double> expected(20'000);
  for (double& error : expected) {
    std::array<double, 8> e{};
    std::generate(e.begin(), e.end(), [&] { return uniform(generator); });
    error = four_bar_error(e);
  }
  std::sort(expected.begin(), expected.end());
  for (const double percent : {5.0, 25.0, 50.0, 75.0, 95.0}) {
    const double p = percent / 100;
    const double bound = expected[static_cast<std::size_t>(p * 20'000)];
    const auto below = std::count_if(result.errors.begin(), result.errors.end(),
                                     [&](const auto& error) { return error.value() < bound; });
    EXPECT_NEAR(static_cast<double>(below) / 1500, p, 4 * std::sqrt(p * (1 - p) / 1500)) << percent;
  }
}

TEST(MonteCarlo, IsTheSameForAnyNumberOfThreads) {
  MonteCarloOptions options;
  options.scatters = ensemble::scatters_of_tolerance(diagram::BlockLibrary::shipped(), 1e-3);
  options.runs = 40;
  const MonteCarlo one = drawn(four_bar(), options);
  for (const int threads : {2, 3, 100}) {
    options.threads = threads;
    const MonteCarlo other = drawn(four_bar(), options);
    EXPECT_EQ(one.errors, other.errors) << threads;  // to the last bit
    EXPECT_EQ(one.along, other.along) << threads;
    EXPECT_EQ(one.worst_run, other.worst_run);
  }
}

// A caller ends it from its progress: the other threads do not go through what is left, here hours of it.
TEST(MonteCarlo, EndsWhereItsProgressThrows) {
  struct Asked {};
  for (const int threads : {1, 3}) {
    MonteCarloOptions options;
    options.scatters = {{"summer", "tolerance", 0.01, ""}};
    options.runs = 10'000'000;
    options.threads = threads;
    options.progress = [](double) { throw Asked{}; };
    EXPECT_THROW(drawn(testing::crank(), options), Asked);
  }
}

TEST(MonteCarlo, GoesOnFromAnyRun) {
  MonteCarloOptions options;
  options.scatters = ensemble::scatters_of_tolerance(diagram::BlockLibrary::shipped(), 1e-3);
  options.runs = 10;
  const MonteCarlo all = drawn(four_bar(), options);
  options.runs = 3;
  options.first_run = 6;
  const MonteCarlo some = drawn(four_bar(), options);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(some.errors[k], all.errors[6 + k]);
}

// Half as large again, |BD| is longer than both links together: the triangle does not close.
TEST(MonteCarlo, CountsWhatFails) {
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.5, ""}};
  options.runs = 30;
  const MonteCarlo result = drawn(four_bar(), options);
  const auto missing = std::count(result.errors.begin(), result.errors.end(), std::nullopt);
  EXPECT_GT(missing, 0);
  EXPECT_LT(missing, 30);
  ASSERT_EQ(result.failures.size(), static_cast<std::size_t>(missing));
  for (const FailedRun& run : result.failures) {
    EXPECT_FALSE(result.errors[run.number]);
    EXPECT_FALSE(run.message.empty());
    EXPECT_EQ(run.message.find('\n'), std::string::npos);
  }
  ASSERT_TRUE(result.worst_run);
  EXPECT_EQ(result.errors[*result.worst_run], result.percentile(100));
}

TEST(MonteCarlo, IsAsFineAsItsScatter) {
  MonteCarloOptions options;
  options.runs = 1;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  EXPECT_EQ(drawn(four_bar(), options).tolerance, 1e-6);
  options.scatters.push_back({"integrator", "tolerance", 1e-5, ""});
  EXPECT_DOUBLE_EQ(drawn(four_bar(), options).tolerance, 1e-8);
}

TEST(MonteCarlo, PercentilesAreRunsByTheNearestRank) {
  MonteCarlo result;
  EXPECT_FALSE(result.percentile(50));
  EXPECT_TRUE(result.percentile_along(50).empty());
  result.errors = {4.0, std::nullopt, 1.0, 3.0, 2.0};
  EXPECT_EQ(result.percentile(0), 1);
  EXPECT_EQ(result.percentile(25), 1);
  EXPECT_EQ(result.percentile(26), 2);
  EXPECT_EQ(result.percentile(50), 2);
  EXPECT_EQ(result.percentile(95), 4);
  EXPECT_EQ(result.percentile(100), 4);
}

// A rocker that cannot turn swings over its range, of which both the patch and the exact motion are.
TEST(MonteCarlo, SwingsWhatCannotTurn) {
  const mechanism::Mechanism mechanism =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/double-rocker.toml");
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 1e-6, ""}};
  options.runs = 2;
  const MonteCarlo result = drawn(mechanism, options);
  ASSERT_TRUE(result.errors[0].has_value());
  // tolerances of 1e-6, magnified where the triangles are flat near the ends of the range
  EXPECT_LT(*result.errors[0], 1e-3 * mechanism.largest_length());
}

// With these draws the solver finds no step at t = 6.28 s and a tolerance of 1e-6, though the machine is as
// good as others: it is off by about its tolerance.
TEST(MonteCarlo, TriesFinerWhereTheSolverFindsNoStep) {
  MonteCarloOptions options;
  options.scatters = ensemble::scatters_of_tolerance(diagram::BlockLibrary::shipped(), 0.002);
  options.runs = 1;
  options.first_run = 5;
  const MonteCarlo result = drawn(four_bar(), options);
  ASSERT_TRUE(result.errors[0].has_value());
  EXPECT_LT(*result.errors[0], 20 * 0.002 * four_bar().largest_length());
}

// A ring of 36 Hz for a second, in all 1001 rows: in 73 it stood at zero in each. With conductances that err
// by a and b its frequency errs by (a + b)/2 of ω, so that the largest error is about ω |a + b|/2 of the
// largest value. Of a triangular density on ±e the magnitude has the median (1 − √½) e, which n runs tell to
// e/(2·√2·√n), standing for one deviation.
TEST(MonteCarlo, OfADiagramLooksAtEveryRow) {
  const double w = 226.1946710584651, scatter = 1e-5;
  const diagram::Diagram ring = diagram::parse_diagram(R"toml(
format = "oblique-diagram/1"
[run]
until = 1
tolerance = 1e-9
[blocks]
x = { type = "integrator", in = "-226.1946710584651*y" }
y = { type = "integrator", in = "226.1946710584651*x", initial = 0.9 }
[outputs]
x = "x"
)toml",
                                                       "ring.toml");
  const diagram::FlatDiagram flat = diagram::flatten(ring, diagram::BlockLibrary::shipped());
  const solve::Trajectory reference =
      solve::run(network::Program(network::assemble(flat)), flat, solve::options_of(ring.run)).trajectory;
  MonteCarloOptions options;
  options.scatters = {{"integrator", "tolerance", scatter, ""}};
  options.runs = 400;
  options.threads = 2;
  const MonteCarlo result = monte_carlo(reference, ring, diagram::BlockLibrary::shipped(), options);
  EXPECT_EQ(result.drive.size(), 1001U);
  const double deviation = 1 / (2 * std::numbers::sqrt2 * 20);
  EXPECT_NEAR(result.percentile(50).value() / (w * scatter), 1 - std::sqrt(0.5), 4 * deviation);
}

// Each turn of the motion has its rows: ten turns err as one does.
TEST(MonteCarlo, LooksAtEachTurn) {
  mechanism::Mechanism once = testing::crank(), often = testing::crank();
  often.motion.until = 20 * pi;
  MonteCarloOptions options;
  options.scatters = {{"summer", "tolerance", 0.01, ""}};
  options.runs = 3;
  const MonteCarlo one = drawn(once, options), ten = drawn(often, options);
  EXPECT_EQ(one.drive.size(), 361U);
  EXPECT_EQ(ten.drive.size(), 3601U);
  for (std::size_t run = 0; run < 3; ++run)
    EXPECT_NEAR(*ten.errors[run], *one.errors[run], 1e-5);  // to the solver's tolerance
}

}  // namespace
}  // namespace oblique::compare
