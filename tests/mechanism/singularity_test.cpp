// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/singularity.h>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace oblique::mechanism {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// φ at (s, τ), and the sum of the magnitudes of its terms, which bounds what rounding adds.
struct Value {
  double sum = 0, magnitude = 0;
};
Value phi(const Singularity& at, double s, double tau) {
  Value value;
  for (const double term :
       {at.sigma * s, at.drive * tau, at.ss * s * s / 2, at.st * s * tau, at.tt * tau * tau / 2}) {
    value.sum += term;
    value.magnitude += std::abs(term);
  }
  return value;
}

/// ∂φ/∂s.
double slope(const Singularity& at, double s, double tau) {
  return at.sigma + at.ss * s + at.st * tau;
}

Singularity random_one(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(-1, 1), positive(0.1, 1);
  Singularity made;
  made.sigma = positive(random);
  made.drive = any(random);
  made.ss = any(random);
  made.st = any(random);
  made.tt = any(random);
  return made;
}

// The branch is the curve φ = 0 through (0, 0), where ∂φ/∂s = σ > 0; it turns back in τ where ∂φ/∂s = 0
// first.
TEST(Singularity, FollowsItsBranchAsFarAsTheFold) {
  std::mt19937_64 random(5);
  int folds = 0, endless = 0;
  for (int i = 0; i < 1000; ++i) {
    const Singularity at = random_one(random);
    for (const double direction : {1.0, -1.0}) {
      const auto fold = at.fold(direction);
      ++(fold ? folds : endless);
      constexpr double kFarWithoutFold = 10;
      const double end = fold ? *fold : direction * kFarWithoutFold;
      ASSERT_GT(end * direction, 0);
      for (const double part : {0.01, 0.3, 0.6, 0.9, 0.99}) {
        const double tau = part * end, s = at.branch(tau);
        const Value value = phi(at, s, tau);
        // Roundings, of which two cancellations (in P near the fold, in the denominator) make some thousands.
        EXPECT_LE(std::abs(value.sum), 1e4 * kEpsilon * value.magnitude) << i << " " << tau;
        EXPECT_GT(slope(at, s, tau), 0) << i << " " << tau;
      }
      // (∂φ/∂s)² is linear in τ at the fold: rounding of 1e-13 of τ leaves its root.
      if (!fold) continue;
      EXPECT_NEAR(slope(at, at.branch(*fold), *fold), 0, 1e-5 * (1 + std::abs(*fold))) << i;
    }
  }
  EXPECT_GT(folds, 100);
  EXPECT_GT(endless, 100);
}

// φ = ½ (s − s₀ + p (τ − τ₀)) (s − s₀ + q (τ − τ₀)) has two lines that cross at (s₀, τ₀) and go apart by |p −
// q| s in a second.
TEST(Singularity, FindsWhereTwoModesCross) {
  constexpr double s0 = -0.2, t0 = 0.3, p = 0.4, q = -1.1;
  Singularity at;
  at.ss = 1;
  at.st = (p + q) / 2;
  at.tt = p * q;
  at.sigma = -s0 - at.st * t0;
  at.drive = -at.tt * t0 - at.st * s0;
  // Without its constant, which a pose has not, the curve misses the crossing by that much.
  const double constant = (s0 * s0 + 2 * at.st * s0 * t0 + at.tt * t0 * t0) / 2;
  at.rounding = std::abs(constant) * (1 + 1e-9);
  const auto crossing = at.crossing();
  ASSERT_TRUE(crossing);
  EXPECT_NEAR(crossing->time, t0, 1e-15);  // some roundings of numbers of the order of 1
  EXPECT_NEAR(crossing->along, s0, 1e-15);
  EXPECT_NEAR(crossing->apart, p - q, 1e-15);
  at.rounding = std::abs(constant) * (1 - 1e-9);
  EXPECT_FALSE(at.crossing());
}

}  // namespace
}  // namespace oblique::mechanism
