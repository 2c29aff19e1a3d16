// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <limits>
#include <ostream>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include "../support/compiled.h"

namespace oblique::network {
namespace {

using testing::Compiled;
using Vector = std::vector<double>;

/// A diagram whose states are integrators "x", "y", "z" in this order, and what dx/dt must be, with its loops
/// solved by hand.
struct Case {
  std::string name;
  std::string blocks;
  std::function<Vector(double x, double y, double z)> derivatives;
  std::vector<std::size_t> loops;          ///< number of unknowns of each
  std::vector<std::pair<int, int>> zeros;  ///< (row, column) that must not be in the pattern
  double rounding = 1e-13;                 ///< of dx/dt, relative to 1 + |dx/dt|

  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }
};

/// Where C of a dyad is, from the distances of the feet of its height: no angles.
std::pair<double, double> apex(double px, double py, double qx, double qy, double r1, double r2) {
  const double dx = qx - px, dy = qy - py, length = std::hypot(dx, dy);
  const double foot = (length * length + r1 * r1 - r2 * r2) / (2 * length);
  const double height = std::sqrt(r1 * r1 - foot * foot);
  return {px + (foot * dx - height * dy) / length, py + (foot * dy + height * dx) / length};
}

const std::vector<Case> kCases{
    {"PlainOde",  // van der Pol, and a state that nothing reads
     R"(xx   = { type = "multiplier", in = ["x", "x"] }
        one  = { type = "constant" }
        damp = { type = "summer", in = ["one", "-xx"] }
        dy   = { type = "multiplier", in = ["damp", "y"] }
        sine = { type = "sine", in = "x" }
        x = { type = "integrator", in = ["y"] }
        y = { type = "integrator", in = ["dy", "-x"] }
        z = { type = "integrator", in = ["2*sine"], rate = 3 })",
     [](double x, double y, double) {
       return Vector{y, (1 - x * x) * y - x, 6 * std::sin(x)};
     },
     {},
     {{0, 2}, {1, 2}, {2, 1}}},

    // x ─▶(s)──┬─▶ dx/dt
    //      ▲   ▼
    //      └─(−p/2)◀─ y         p = 0.8 s + y
    {"LinearLoop",
     R"(s = { type = "summer", in = ["x", "-0.5*p"] }
        p = { type = "summer", in = ["0.8*s", "y"] }
        x = { type = "integrator", in = ["s"] }
        y = { type = "integrator", in = ["-p", "3*z"] }
        z = { type = "integrator", in = ["x"] })",
     [](double x, double y, double z) {
       const double s = (x - 0.5 * y) / 1.4;
       return Vector{s, -(0.8 * s + y) + 3 * z, x};
     },
     {1},
     {{0, 2}, {2, 1}}},

    {"SummerOnItself",
     R"(s = { type = "summer", in = ["x", "0.75*s"] }
        x = { type = "integrator", in = ["s"] })",
     [](double x, double, double) { return Vector{4 * x}; },
     {1},
     {}},

    {"LinearLoopOfVaryingGain",
     R"(s  = { type = "summer", in = ["x", "ys"] }
        ys = { type = "multiplier", in = ["y", "s"] }
        x = { type = "integrator", in = ["s"] }
        y = { type = "integrator", in = ["-y"] })",
     [](double x, double y, double) {
       return Vector{x / (1 - y), -y};
     },
     {1},
     {{1, 0}}},

    {"TwoCoupledSummers",
     R"(a = { type = "summer", in = ["0.5*a", "0.2*b", "x"] }
        b = { type = "summer", in = ["0.3*a", "-0.4*b", "y"] }
        x = { type = "integrator", in = ["a"] }
        y = { type = "integrator", in = ["b", "z"] }
        z = { type = "integrator", in = ["-z"] })",
     [](double x, double y, double z) {  // 0.5 a − 0.2 b = x, −0.3 a + 1.4 b = y, determinant 0.64
       return Vector{(1.4 * x + 0.2 * y) / 0.64, (0.3 * x + 0.5 * y) / 0.64 + z, -z};
     },
     {2},
     {{0, 2}, {2, 0}, {2, 1}}},

    // Ideal amplifiers whose residuals depend on the next one's output: dg/dz is a cyclic permutation, which
    // only a
    // pivoting LU solves, and only with its permutation the right way round.
    {"ThreeAmplifiersCrosswise",
     R"(a = { type = "servo-amplifier", in = ["2*b", "-x"], gain = inf }
        b = { type = "servo-amplifier", in = ["3*c", "-y"], gain = inf }
        c = { type = "servo-amplifier", in = ["a", "0.5*b", "-z"], gain = inf }
        x = { type = "integrator", in = ["a"] }
        y = { type = "integrator", in = ["b"] }
        z = { type = "integrator", in = ["c"] })",
     [](double x, double y, double z) {
       return Vector{z - x / 4, x / 2, y / 3};
     },
     {3},
     {}},

    {"SquareRoot",
     R"(r  = { type = "square-root", in = "x", gain = inf, bandwidth = inf }
        ry = { type = "multiplier", in = ["r", "y"] }
        x = { type = "integrator", in = ["-r"] }
        y = { type = "integrator", in = ["ry"] })",
     [](double x, double y, double) {
       return Vector{-std::sqrt(x), std::sqrt(x) * y};
     },
     {1},
     {{0, 1}}},

    {"DividerOfFiniteGain",
     R"(q = { type = "divider", numerator = "x", denominator = "y", gain = 10, bandwidth = inf }
        x = { type = "integrator", in = ["q"] }
        y = { type = "integrator", in = ["z"] }
        z = { type = "integrator", in = ["-q"] })",
     [](double x, double y, double z) {
       return Vector{10 * x / (1 + 10 * y), z, -10 * x / (1 + 10 * y)};
     },
     {1},
     {}},

    // x + y ─▶ √ ─▶ r ─▶ ÷ ─▶ q,  s = z/(1 + r/2) by a summer fed back through a multiplier, and q = s/r.
    {"LoopsThatDependOnEarlierLoops",
     R"(q  = { type = "divider", numerator = "s", denominator = "r", gain = inf, bandwidth = inf }
        s  = { type = "summer", in = ["z", "-0.5*rs"] }
        rs = { type = "multiplier", in = ["r", "s"] }
        r  = { type = "square-root", in = "u", gain = inf, bandwidth = inf }
        u  = { type = "summer", in = ["x", "y"] }
        x = { type = "integrator", in = ["q"] }
        y = { type = "integrator", in = ["s", "r"] }
        z = { type = "integrator", in = ["x"] })",
     [](double x, double y, double z) {
       const double r = std::sqrt(x + y), s = z / (1 + r / 2);
       return Vector{s / r, s + r, x};
     },
     {1, 1, 1},
     {{2, 1}}},

    {"DyadOfIdealAmplifiers",
     R"(c  = { type = "dyad-rrr", px = "x", py = "y", qx = "q", qy = "z", r1 = 0.9, r2 = 0.7, gain = inf, bandwidth = inf }
        q  = { type = "constant", value = 1.2 }
        x = { type = "integrator", in = ["c.x"] }
        y = { type = "integrator", in = ["c.y"] }
        z = { type = "integrator", in = ["-c.x", "c.y"] })",
     [](double x, double y, double z) {
       const auto [cx, cy] = apex(x, y, 1.2, z, 0.9, 0.7);
       return Vector{cx, cy, cy - cx};
     },
     {1, 1, 1, 1, 1},
     {},
     1e-12},  // the height loses a digit where the triangle is flat

    {"LoopThatOnlyOutputsNeed",
     R"(s = { type = "summer", in = ["x", "-0.5*p"] }
        p = { type = "multiplier", in = ["s", "y"] }
        x = { type = "integrator", in = ["y"] }
        y = { type = "integrator", in = ["-x"] })",
     [](double x, double y, double) {
       return Vector{y, -x};
     },
     {1},
     {}},
};

class JacobianTest : public ::testing::TestWithParam<Case> {
 protected:
  Compiled made{GetParam().blocks};
  const Program& program = made.program;

  Vector oracle(const Vector& x) const {
    return GetParam().derivatives(x[0], x.size() > 1 ? x[1] : 0, x.size() > 2 ? x[2] : 0);
  }

  /// Somewhere that all loops have solutions: the roots are real, the triangles close, no gain is 1.
  Vector random_point() const {
    Vector x(program.n_states());
    for (double& value : x) value = *rc::gen::inRange(150, 600) / 1000.0;
    return x;
  }
};

TEST_P(JacobianTest, HasTheLoopsThatTheDrawingHas) {
  std::vector<std::size_t> sizes;
  for (const Loop& loop : program.loops()) sizes.push_back(loop.unknowns.size());
  EXPECT_EQ(sizes, GetParam().loops);
}

TEST_P(JacobianTest, PatternIsSortedAndStoresTheDiagonalAndNoMore) {
  const SparsePattern& pattern = program.jacobian_pattern();
  ASSERT_EQ(pattern.size(), program.n_states());
  for (std::size_t column = 0; column < pattern.size(); ++column) {
    const Vector rows(pattern.rows.begin() + pattern.column_starts[column],
                      pattern.rows.begin() + pattern.column_starts[column + 1]);
    EXPECT_EQ(std::adjacent_find(rows.begin(), rows.end(), std::greater_equal<>()), rows.end());
    EXPECT_EQ(std::count(rows.begin(), rows.end(), static_cast<double>(column)), 1);
    for (const auto& [row, zero_column] : GetParam().zeros) {
      if (static_cast<std::size_t>(zero_column) == column) {
        EXPECT_EQ(std::count(rows.begin(), rows.end(), static_cast<double>(row)), 0) << row << ", " << column;
      }
    }
  }
}

TEST_P(JacobianTest, DerivativesAreTheClosedForm) {
  EXPECT_TRUE(rc::check([&] {
    const Vector x = random_point(), expected = oracle(x);
    Workspace workspace(program);
    Vector derivatives(x.size());
    RC_ASSERT(program.derivatives(0, x.data(), derivatives.data(), workspace));
    for (std::size_t i = 0; i < x.size(); ++i) {
      RC_ASSERT(std::abs(derivatives[i] - expected[i]) <= GetParam().rounding * (1 + std::abs(expected[i])));
    }
  }));
}

TEST_P(JacobianTest, AgreesWithDifferencesOfTheClosedForm) {
  EXPECT_TRUE(rc::check([&] {
    const Vector x = random_point();
    const SparsePattern& pattern = program.jacobian_pattern();
    Workspace workspace(program);
    Vector values(pattern.entries());
    RC_ASSERT(program.jacobian(0, x.data(), values.data(), workspace));
    for (std::size_t column = 0; column < x.size(); ++column) {
      Vector found(x.size(), 0.0);
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        found[static_cast<std::size_t>(pattern.rows[static_cast<std::size_t>(k)])] =
            values[static_cast<std::size_t>(k)];
      }
      constexpr double kStep = 1e-5;
      Vector left = x, right = x;
      left[column] -= kStep;
      right[column] += kStep;
      const Vector below = oracle(left), above = oracle(right);
      for (std::size_t row = 0; row < x.size(); ++row) {
        const double derivative = (above[row] - below[row]) / (2 * kStep);
        // Truncation h² f‴/6 with f‴ up to 1e3 (the root at 0.15) and rounding 1e-16/h.
        RC_ASSERT(std::abs(found[row] - derivative) <= 1e-7 * (1 + std::abs(derivative)));
      }
    }
  }));
}

INSTANTIATE_TEST_SUITE_P(Diagrams, JacobianTest, ::testing::ValuesIn(kCases),
                         [](const auto& tested) { return tested.param.name; });

// 1/(1 + e^x) has the slope zero where e^x is no number any more, and x/(1 + e^x) too; below it is what
// calculus says. What has no value at all keeps none.
TEST(Jacobian, HasNumbersWhereTheDerivativesHave) {
  const diagram::BlockLibrary library = testing::shipped_blocks_and("falling", R"toml([inputs]
in = { doc = "in" }
[outputs]
out = { doc = "out" }
[equations]
out = "in/(1 + exp(in))"
)toml");
  const Compiled made(R"toml(u = { type = "falling", in = "x" }
x = { type = "integrator", in = ["u", "-3*x"] }
)toml",
                      "", library);
  Workspace workspace(made.program);
  const auto slope_at = [&](double x) {
    double value = 0;
    EXPECT_TRUE(made.program.jacobian(0, &x, &value, workspace));
    return value;
  };
  const double e = std::exp(2.0);
  EXPECT_NEAR(slope_at(2), 1 / (1 + e) - 2 * e / ((1 + e) * (1 + e)) - 3, 1e-14);  // rounding
  EXPECT_NEAR(slope_at(800), -3, 1e-5);  // a difference over 8e-5 of values of 2400, known to rounding
  EXPECT_FALSE(std::isfinite(slope_at(-std::numeric_limits<double>::infinity())));
}

}  // namespace
}  // namespace oblique::network
