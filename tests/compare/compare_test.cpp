// SPDX-License-Identifier: MIT
#include <oblique/compare/compare.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <thread>
#include <tuple>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

#include "../support/shipped.h"

namespace oblique::compare {
namespace {

using test::shipped;

struct Case {
  const char* mechanism;
  double relative_error;  ///< allowed at gain 1e6, of the largest link
};

void PrintTo(const Case& tested, std::ostream* out) {
  *out << tested.mechanism;
}

class Convergence : public ::testing::TestWithParam<Case> {};
INSTANTIATE_TEST_SUITE_P(Compare, Convergence,
                         ::testing::Values(Case{"four-bar", 1e-6}, Case{"six-bar", 1e-6},
                                           Case{"jansen", 1e-5}),
                         [](const auto& tested) {
                           std::string name = tested.param.mechanism;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

// A servo loop errs by −x/(μ ∂r/∂x): the error of the whole falls as 1/μ, from gain 1e2 to 1e6.
TEST_P(Convergence, ErrorFallsWithTheGainOverFourDecades) {
  const Comparison comparison = compare(shipped(GetParam().mechanism), diagram::BlockLibrary::shipped());
  ASSERT_EQ(comparison.runs.size(), 5U);
  ASSERT_EQ(comparison.series.size(), 1U);
  const GainSeries& series = comparison.series.front();
  ASSERT_TRUE(series.order);
  EXPECT_NEAR(*series.order, -1, 0.05);
  for (std::size_t i = 1; i < comparison.runs.size(); ++i) {
    const double decade = comparison.runs[i].max_error / comparison.runs[i - 1].max_error;
    EXPECT_NEAR(std::log10(decade), -1, 0.05) << "gain " << comparison.runs[i].gain;
  }
  EXPECT_LT(comparison.runs.back().max_error, GetParam().relative_error * comparison.size);
  // The tolerance must not hide the last run: 1e-10 over some hundred steps against 1e-7.
  EXPECT_LT(series.floor.value(), 0.1 * comparison.runs.back().max_error);
  const std::vector<mechanism::Point> points = shipped(GetParam().mechanism).points;
  const auto moving = static_cast<double>(std::count_if(
      points.begin(), points.end(), [](const mechanism::Point& point) { return !point.fixed; }));
  for (const ComparedRun& run : comparison.runs) {
    EXPECT_TRUE(run.stable) << run.gain;
    EXPECT_LT(run.slowest_pole, 0);
    EXPECT_TRUE(run.overloads.empty()) << run.gain << " " << run.overloads.front().signal;
    EXPECT_LE(run.rms_error, run.max_error);
    // The largest of each row is one of those whose mean square it is.
    double sum = 0;
    for (const double error : run.error_along) sum += error * error;
    const double rows = static_cast<double>(run.error_along.size());
    EXPECT_LE(run.rms_error, std::sqrt(sum / rows) * (1 + 1e-12));  // roundings of a thousand terms
    EXPECT_GE(run.rms_error, std::sqrt(sum / rows / moving) * (1 - 1e-12));
    EXPECT_GT(run.steps, 0);
  }
}

// From 1e8 on the error of the leg is what the tolerance of 1e-10 leaves in the states of the loops, 6e-7 mm;
// a fit that takes this plateau in gives −0.9.
TEST(Compare, TheOrderLeavesOutThePlateauOfTheTolerance) {
  CompareOptions options;
  options.gains = {1e5, 1e6, 1e7, 1e8, 1e9, 1e10};
  const Comparison comparison = compare(shipped("jansen"), diagram::BlockLibrary::shipped(), options);
  const GainSeries& series = comparison.series.front();
  ASSERT_TRUE(series.order);
  // the last run that counts stands ten times above the floor, so that is off by 10 % at most, and by 0.1/2
  // in a fit over two decades and more
  EXPECT_NEAR(*series.order, -1, 0.03);
  EXPECT_GT(series.floor.value(), 0.1 * comparison.runs.back().max_error);
}

TEST(Compare, SizeIsTheLargestLink) {
  CompareOptions options;
  options.gains = {1e3};
  const Comparison comparison = compare(shipped("six-bar"), diagram::BlockLibrary::shipped(), options);
  EXPECT_EQ(comparison.size, 150);
  EXPECT_EQ(comparison.unit, "mm");
  EXPECT_FALSE(comparison.series.front().order);  // one gain has no slope
}

TEST(Compare, RunsEveryMethodWithEveryBandwidthAndGain) {
  CompareOptions options;
  options.methods = {patch::PatchMethod::triangles, patch::PatchMethod::gradient};
  options.bandwidths = {5, 50};
  options.gains = {1e3, 1e4};
  const Comparison comparison = compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options);
  ASSERT_EQ(comparison.runs.size(), 8U);
  ASSERT_EQ(comparison.series.size(), 4U);
  std::size_t at = 0;
  for (const patch::PatchMethod method : options.methods) {
    for (const double bandwidth : options.bandwidths) {
      const GainSeries& series = comparison.series[at / 2];
      EXPECT_EQ(series.method, method);
      EXPECT_EQ(series.bandwidth, bandwidth);
      ASSERT_TRUE(series.order);
      EXPECT_NEAR(*series.order, -1, 0.01);  // four decades above the floor
      for (const double gain : options.gains) {
        EXPECT_EQ(comparison.runs[at].method, method);
        EXPECT_EQ(comparison.runs[at].bandwidth, bandwidth);
        EXPECT_EQ(comparison.runs[at].gain, gain);
        ++at;
      }
    }
  }
  // The gradient servo's K is gain times bandwidth; to 1e-3, since K is some 1e4 times the crank's speed.
  EXPECT_NEAR(comparison.runs[4].max_error / comparison.runs[6].max_error, 10, 0.01);
}

TEST(Compare, LeavesOutWhatIsRefusedAndWhatFails) {
  CompareOptions options;
  options.methods = {patch::PatchMethod::paper, patch::PatchMethod::triangles};
  options.gains = {1e3, 1e4};
  const Comparison comparison = compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options);
  ASSERT_EQ(comparison.runs.size(), 2U);
  EXPECT_EQ(comparison.runs.front().method, patch::PatchMethod::triangles);
  ASSERT_EQ(comparison.series.size(), 1U);
  ASSERT_EQ(comparison.refused.size(), 1U);
  EXPECT_EQ(comparison.refused.front().method, patch::PatchMethod::paper);
  EXPECT_FALSE(comparison.refused.front().gain);
  EXPECT_THAT(comparison.refused.front().why.what,
              ::testing::HasSubstr("is of a kind that the source does not have"));
  options.methods = {patch::PatchMethod::paper};
  EXPECT_THROW(compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options), patch::PatchError);
}

// A four-bar a hundred-millionth of its size from a change point. Its amplifiers of ordinary gain run in some
// thousand steps, and the one of the floor, which nobody asked for, would take minutes until it fails.
TEST(Compare, GivesUpAFloorThatTakesTooLong) {
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [100, 0]
[bodies]
AB = { points = ["A", "B"], length = 40 }
BC = { points = ["B", "C"], length = 90 }
CD = { points = ["C", "D"], length = 50.000001 }
[drives]
crank = { turns = "AB", about = "A", speed = "60 rpm", start = "90 deg" }
[sketch]
C = [80, 50]
)",
                                                                    "near.toml");
  CompareOptions options;
  options.gains = {1e3, 1e4};
  const Comparison comparison = compare(mechanism, diagram::BlockLibrary::shipped(), options);
  ASSERT_EQ(comparison.runs.size(), 2U);
  EXPECT_LT(comparison.runs[1].steps, 10'000);
  EXPECT_FALSE(comparison.series.front().floor);
  // C² = b² where the triangle is all but flat: an amplifier of gain μ leaves a root of 1/μ
  EXPECT_NEAR(comparison.series.front().order.value(), -0.5, 0.01);
}

TEST(Compare, IsTheSameWithAnyNumberOfThreads) {
  CompareOptions options;
  options.methods = {patch::PatchMethod::paper, patch::PatchMethod::triangles, patch::PatchMethod::gradient};
  options.gains = {1e3, 1e4, 1e5};
  options.bandwidths = {
      20, 1e-3};  // far too slow for a turn a second: its runs err by as much as the links are long
  const Comparison one = compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options);
  std::vector<double> told;
  const std::thread::id asker = std::this_thread::get_id();
  options.threads = 5;
  options.progress = [&](double fraction) {
    EXPECT_EQ(std::this_thread::get_id(), asker);
    told.push_back(fraction);
  };
  const Comparison five = compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options);
  ASSERT_EQ(one.runs.size(), five.runs.size());
  for (std::size_t k = 0; k < one.runs.size(); ++k) {
    const ComparedRun &a = one.runs[k], &b = five.runs[k];
    EXPECT_EQ(std::tie(a.method, a.gain, a.bandwidth, a.max_error, a.rms_error, a.error_along, a.steps,
                       a.slowest_pole, a.worst.point, a.worst.reason),
              std::tie(b.method, b.gain, b.bandwidth, b.max_error, b.rms_error, b.error_along, b.steps,
                       b.slowest_pole, b.worst.point, b.worst.reason));
    ASSERT_EQ(a.parts.has_value(), b.parts.has_value());
    if (a.parts) {
      EXPECT_EQ(a.parts->solver, b.parts->solver);
    }
  }
  ASSERT_EQ(one.series.size(), five.series.size());
  for (std::size_t k = 0; k < one.series.size(); ++k) {
    EXPECT_EQ(one.series[k].floor, five.series[k].floor);
    EXPECT_EQ(one.series[k].order, five.series[k].order);
  }
  ASSERT_EQ(one.refused.size(), five.refused.size());
  for (std::size_t k = 0; k < one.refused.size(); ++k) {
    EXPECT_EQ(one.refused[k].method, five.refused[k].method);
    EXPECT_EQ(one.refused[k].gain, five.refused[k].gain);
    EXPECT_EQ(one.refused[k].why.what, five.refused[k].why.what);
  }
  EXPECT_FALSE(told.empty());
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_LE(told.back(), 1);
}

TEST(Compare, EndsWhereItsProgressThrows) {
  struct Stop {};
  CompareOptions options;
  options.threads = 3;
  options.progress = [](double fraction) {
    if (fraction > 0.2) throw Stop();
  };
  EXPECT_THROW(compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options), Stop);
}

TEST(Compare, ReportsProgressUpToTheEnd) {
  CompareOptions options;
  options.gains = {1e3, 1e4};
  double last = 0;
  options.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    last = fraction;
  };
  compare(shipped("four-bar"), diagram::BlockLibrary::shipped(), options);
  EXPECT_EQ(last, 1);
}

// At rest every amplifier stands where its own equation with the finite gain says (w = input_gain, m = 1/(w
// μ)):
//
//     L² + m L = d²,   c (L + m) = dx,   s (L + m) = dy,
//     cos γ (L + m) = L²/(2a) + (a² − b²)/(2a),   sin²γ + m sin γ = 1 − cos²γ
//
// so the static error of a patched dyad is known in closed form; the run must start there.
TEST(DyadBlock, RestsWhereItsFiniteGainPutsIt) {
  const char* const text = R"(
format = "oblique-diagram/1"
[run]
until = 1e-9
samples = 2
[blocks]
one = { type = "constant", value = 1 }
C   = { type = "dyad-rrr", px = "0.1*one", py = "0.2*one", qx = "0.7*one", qy = "-0.1*one", r1 = 0.5, r2 = 0.4, side = -1, reach = 0.8, gain = 200, bandwidth = "50 Hz", input_gain = 5 }
[outputs]
x = "C.x"
y = "C.y"
)";
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::Diagram diagram = diagram::parse_diagram(text, "dyad.toml");
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const oblique::solve::Run result =
      solve::run(network::Program(network::assemble(flat)), flat, solve::options_of(diagram.run));

  const double reach = 0.8, m = 1 / (5.0 * 200), a = 0.5 / reach, b = 0.4 / reach;
  const double dx = 0.6 / reach, dy = -0.3 / reach;
  const auto root = [](double half, double square) { return -half + std::sqrt(half * half + square); };
  const double length = root(m / 2, dx * dx + dy * dy);
  const double c = dx / (length + m), s = dy / (length + m);
  const double cosine = (length * length / (2 * a) + (a * a - b * b) / (2 * a)) / (length + m);
  const double sine = root(m / 2, 1 - cosine * cosine);
  // Newton's method ends at rounding, magnified by 1/(sin γ) at most.
  EXPECT_NEAR(result.trajectory.at(0, 1), 0.1 + 0.5 * (c * cosine + s * sine), 1e-13);
  EXPECT_NEAR(result.trajectory.at(0, 2), 0.2 + 0.5 * (s * cosine - c * sine), 1e-13);
}

// The coupler by its mark and its two joints, in whatever order they are given: the gradient servos of the
// joints err alike, to the tolerance of the run.
TEST(Compare, DoesNotDependOnWhichPointsGiveALink) {
  const auto error_of = [](const std::string& coupler) {
    CompareOptions options;
    options.methods = {patch::PatchMethod::gradient};
    options.gains = {1e3};
    return compare(mechanism::parse_mechanism("format = \"oblique-mechanism/1\"\n"
                                              "[frame]\nA = [0, 0]\nD = [4, 0]\n[bodies]\n"
                                              "AB = { points = [\"A\", \"B\"], length = 1 }\n" +
                                                  coupler +
                                                  "\nCD = { points = [\"C\", \"D\"], length = 3 }\n[drives]\n"
                                                  "crank = { turns = \"AB\", about = \"A\", speed = 1 }\n"
                                                  "[sketch]\nC = [3.5, 2.9]\n",
                                              "m.toml"),
                   diagram::BlockLibrary::shipped(), options)
        .runs.front()
        .max_error;
  };
  // M lies halfway along B → C and 1 to its left; from M to B along −(1.75, 1)/|MB|, C lies 2.0625/|MB|
  // behind and 3.5/|MB| to the left.
  const double error = error_of("BCM = { points = [\"B\", \"C\"], length = 3.5, marks = { M = [1.75, 1] } }");
  const double side = std::hypot(1.75, 1);
  std::ostringstream coupler;
  coupler.precision(17);
  coupler << R"(MBC = { points = ["M", "B"], length = )" << side << ", marks = { C = [" << -2.0625 / side
          << ", " << 3.5 / side << "] } }";
  EXPECT_NEAR(error_of(coupler.str()), error, 1e-3 * error);
}

}  // namespace
}  // namespace oblique::compare
