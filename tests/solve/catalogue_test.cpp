// SPDX-License-Identifier: MIT
// Smooth problems against truths of other programs (smooth_problems.py): how far the default run is off, and
// whether it knows.
#include <algorithm>
#include <cmath>
#include <tuple>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "../support/runs.h"

namespace oblique::solve {
namespace {

using testing::Compiled;

struct Equation {
  const char* state;
  const char* derivative;
  double start;
};

struct SmoothProblem {
  const char* name;
  double until;
  bool stiff;
  std::vector<Equation> equations;
  std::vector<std::string> shown;           ///< states whose truth is known
  std::vector<std::vector<double>> truths;  ///< of these, at evenly spaced times, the last at the end
};

const std::vector<SmoothProblem>& problems() {
  static const std::vector<SmoothProblem> all{
#include "smooth_problems.inc"
  };
  return all;
}

diagram::BlockLibrary library_with(const SmoothProblem& problem) {
  std::string outputs = "[outputs]\n", parameters = "[parameters]\n", start = "[start]\n",
              equations = "[equations]\n";
  for (const Equation& e : problem.equations) {
    outputs += fmt::format("{} = {{ doc = \"a state\" }}\n", e.state);
    parameters +=
        fmt::format("first_{} = {{ default = {}, unit = \"1\", doc = \"start\" }}\n", e.state, e.start);
    start += fmt::format("{0} = \"first_{0}\"\n", e.state);
    equations += fmt::format("\"der({})\" = \"{}\"\n", e.state, e.derivative);
  }
  return testing::shipped_blocks_and("problem", outputs + parameters + start + equations);
}

/// What a run of a problem was off by, relative to the size of each output, and what it said of that.
struct Found {
  double error = 0;
  std::vector<double> estimated;  ///< over the true error, of each output
};

Found solve(const SmoothProblem& problem, double tolerance, diagram::IntegrationMethod method) {
  const diagram::BlockLibrary library = library_with(problem);
  std::string outputs = "[outputs]\n";
  for (const std::string& state : problem.shown)
    outputs += fmt::format("{} = \"p{}\"\n", state, problem.equations.size() > 1 ? "." + state : "");
  const Compiled made("p = { type = \"problem\" }\n", outputs, library);
  RunOptions options;
  options.until = problem.until;
  options.tolerance = tolerance;
  options.method = method;
  options.samples = static_cast<int>(problem.truths.size()) + 1;
  options.trust = true;
  const oblique::solve::Run result = run(made.program, made.flat, options);
  EXPECT_TRUE(result.warnings.empty()) << text::to_string(result.warnings.front());
  Found found;
  for (std::size_t c = 0; c < problem.shown.size(); ++c) {
    double size = 0, error = 0;
    for (std::size_t k = 0; k < problem.truths.size(); ++k) {
      size = std::max(size, std::abs(problem.truths[k][c]));
      error = std::max(error, std::abs(result.trajectory.at(k + 1, c + 1) - problem.truths[k][c]));
    }
    found.error = std::max(found.error, error / size);
    // A closed form rounds to 1e-16 and has no more to say of an error near that.
    found.estimated.push_back(result.trust->outputs.at(c).largest / std::max(error, 1e-15 * size));
  }
  return found;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

class Catalogue : public ::testing::TestWithParam<std::tuple<double, diagram::IntegrationMethod>> {};
INSTANTIATE_TEST_SUITE_P(Tolerances, Catalogue,
                         ::testing::Combine(::testing::Values(1e-5, 1e-8, 1e-11),
                                            ::testing::Values(diagram::IntegrationMethod::automatic,
                                                              diagram::IntegrationMethod::rodas)));

TEST_P(Catalogue, IsRightToItsToleranceAndKnowsByHowMuch) {
  const auto [tolerance, method] = GetParam();
  std::vector<double> smooth, stiff, estimates;
  for (const SmoothProblem& problem : problems()) {
    const Found found = solve(problem, tolerance, method);
    (problem.stiff ? stiff : smooth).push_back(found.error / tolerance);
    // Of 36 problems the worst is 60 times the tolerance off at 1e-8: a pendulum that passes near its top. At
    // 1e-11 a thousand turns of a circle carry their rounding, 7e-9.
    EXPECT_LT(found.error, 200 * tolerance + 2e-8) << problem.name;
    for (const double estimated : found.estimated) {
      EXPECT_GT(estimated, 0.1) << problem.name;  // asked for; the least that was seen is 0.7
      estimates.push_back(estimated);
    }
  }
  // Asked for is 10. The solver's tolerance as it stands, not tightened, gives 15 and 120.
  EXPECT_LT(median(smooth), 1);
  EXPECT_LT(median(stiff), 10);
  // An estimate that is always too large tells nothing either; beside 1e-11 no run is much finer.
  EXPECT_LT(median(estimates), tolerance > 1e-10 ? 3 : 10);
}

// The error of an oscillator that is alone is that beside 1000 idle integrators and 30 other oscillators that
// are slower: by the largest weighted error none of them has a part in its steps. By the mean of all it was
// 1000 times as large. The closed form is the cosine; 1e-8 is the tolerance.
TEST(ErrorNorm, IsNotDilutedByOtherStates) {
  const std::string alone =
      "a = { type = \"integrator\", in = [\"b\"], initial = 1 }\nb = { type = \"integrator\", in = [\"-a\"] "
      "}\n";
  std::string beside = alone + "zero = { type = \"constant\", value = 0 }\n";
  for (int k = 0; k < 1000; ++k)
    beside += fmt::format("q{} = {{ type = \"integrator\", in = [\"zero\"], initial = 0.5 }}\n", k);
  for (int k = 0; k < 30; ++k) {
    beside +=
        fmt::format("c{0} = {{ type = \"integrator\", in = [\"d{0}\"], initial = 0.5, rate = 0.1 }}\n", k);
    beside += fmt::format("d{0} = {{ type = \"integrator\", in = [\"-c{0}\"], rate = 0.1 }}\n", k);
  }
  RunOptions options;
  options.until = 100;
  options.samples = 101;
  options.method = diagram::IntegrationMethod::adams;
  const auto run_with = [&](const std::string& blocks) {
    const Compiled made(blocks, "[outputs]\na = \"a\"\n");
    return run(made.program, made.flat, options);
  };
  const oblique::solve::Run one = run_with(alone), many = run_with(beside);
  EXPECT_NEAR(static_cast<double>(many.statistics.steps), static_cast<double>(one.statistics.steps),
              0.05 * static_cast<double>(one.statistics.steps));
  for (std::size_t row = 0; row < many.trajectory.rows(); ++row)
    EXPECT_NEAR(many.trajectory.at(row, 1), std::cos(many.trajectory.at(row, 0)), 1e-8);
}

}  // namespace
}  // namespace oblique::solve
