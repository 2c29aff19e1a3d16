// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_kernels.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/network/program/tape.h>

namespace oblique::ensemble {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

std::vector<const LaneKernels*> all_kernels() {
  std::vector<const LaneKernels*> all;
  for (const char* set : {"sse2", "avx2", "avx512"}) {
    for (const int width : {4, 8, 16}) {
      if (const LaneKernels* kernels = lane_kernels(width, set)) all.push_back(kernels);
    }
  }
  return all;
}

std::uint64_t bits(double x) {
  std::uint64_t whole = 0;
  std::memcpy(&whole, &x, sizeof whole);
  return whole;
}

// One operation on `x`, a number a lane, as often as needed.
std::vector<double> turned(const LaneKernels& kernels, LaneOp op, const std::vector<double>& x) {
  const auto width = static_cast<std::size_t>(kernels.width);
  const LaneStep step{0, 0, 0, 1};
  const LaneRange range{op, 0, 0, 1};
  LaneArray slots(2 * width);
  std::vector<double> results(x.size());
  for (std::size_t begin = 0; begin < x.size(); begin += width) {
    for (std::size_t l = 0; l < width; ++l) slots[l] = x[std::min(begin + l, x.size() - 1)];
    kernels.run({&range, 1, &step}, slots.data());
    for (std::size_t l = 0; l < width && begin + l < x.size(); ++l) results[begin + l] = slots[width + l];
  }
  return results;
}

double unit_in_the_last_place(double x) {
  return std::nextafter(std::abs(x), std::numeric_limits<double>::infinity()) - std::abs(x);
}

TEST(LaneKernels, AreThereForEveryWidth) {
  for (const int width : {4, 8, 16}) {
    ASSERT_NE(lane_kernels(width), nullptr);
    EXPECT_EQ(lane_kernels(width)->width, width);
    EXPECT_STREQ(lane_kernels(width, "sse2")->set, "sse2");
  }
  EXPECT_EQ(lane_kernels(5), nullptr);
  EXPECT_EQ(lane_kernels(8, "mmx"), nullptr);
}

// The library's sine is right to half a unit in the last place or so; the kernel's claim is three.
TEST(LaneKernels, SinesAndCosinesAreThoseOfTheLibraryToThreeUnits) {
  std::mt19937_64 random(7);
  std::vector<double> x{0, -0.0, 1e-300, 1e-8, std::numbers::pi, -std::numbers::pi / 2, 1e5, 99999.99};
  for (const double size : {1e-6, 1.0, 10.0, 1e3, 9.9e4}) {
    std::uniform_real_distribution<double> number(-size, size);
    for (int k = 0; k < 4000; ++k) x.push_back(number(random));
  }
  for (int k = -2000; k <= 2000; ++k) x.push_back(k * (std::numbers::pi / 2));  // where they nearly vanish
  for (const LaneKernels* kernels : all_kernels()) {
    const std::vector<double> sines = turned(*kernels, LaneOp::sin, x),
                              cosines = turned(*kernels, LaneOp::cos, x);
    for (std::size_t k = 0; k < x.size(); ++k) {
      EXPECT_NEAR(sines[k], std::sin(x[k]), 3 * unit_in_the_last_place(std::sin(x[k]))) << x[k];
      EXPECT_NEAR(cosines[k], std::cos(x[k]), 3 * unit_in_the_last_place(std::cos(x[k]))) << x[k];
    }
  }
}

TEST(LaneKernels, WhatIsFarIsLeftToTheLibraryLaneByLane) {
  const std::vector<double> x{1e6, 0.5, -1e300, 1e5, kNone, std::numeric_limits<double>::infinity(), 2, 3};
  for (const LaneKernels* kernels : all_kernels()) {
    const std::vector<double> sines = turned(*kernels, LaneOp::sin, x),
                              cosines = turned(*kernels, LaneOp::cos, x);
    for (const std::size_t k : {0U, 2U, 3U}) {
      EXPECT_EQ(sines[k], std::sin(x[k]));
      EXPECT_EQ(cosines[k], std::cos(x[k]));
    }
    for (const std::size_t k : {4U, 5U}) {
      EXPECT_TRUE(std::isnan(sines[k]));
      EXPECT_TRUE(std::isnan(cosines[k]));
    }
    // A lane beside has the numbers that it has alone.
    EXPECT_EQ(sines[1], turned(*kernels, LaneOp::sin, {0.5})[0]);
  }
}

TEST(LaneKernels, EachOperationIsRoundedByItself) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> number(-2, 2);
  const auto other = static_cast<std::uint32_t>(network::Instruction::Code::atan2);
  const LaneStep step{0, 1, 2, 3};
  for (const LaneKernels* kernels : all_kernels()) {
    const auto width = static_cast<std::size_t>(kernels->width);
    for (const LaneOp op : {LaneOp::add, LaneOp::subtract, LaneOp::multiply, LaneOp::divide, LaneOp::negate,
                            LaneOp::sqrt, LaneOp::multiply_add, LaneOp::multiply_subtract, LaneOp::other}) {
      const LaneRange range{op, other, 0, 1};
      LaneArray slots(4 * width);
      for (std::size_t k = 0; k < 3 * width; ++k) slots[k] = number(random);
      kernels->run({&range, 1, &step}, slots.data());
      for (std::size_t l = 0; l < width; ++l) {
        const double a = slots[l], b = slots[width + l], c = slots[2 * width + l];
        volatile double product = a * b;  // no fused operation
        const double truth = op == LaneOp::add                 ? a + b
                             : op == LaneOp::subtract          ? a - b
                             : op == LaneOp::multiply          ? a * b
                             : op == LaneOp::divide            ? a / b
                             : op == LaneOp::negate            ? -a
                             : op == LaneOp::sqrt              ? std::sqrt(a)
                             : op == LaneOp::multiply_add      ? product + c
                             : op == LaneOp::multiply_subtract ? c - product
                                                               : std::atan2(a, b);
        if (std::isnan(truth)) {
          EXPECT_TRUE(std::isnan(slots[3 * width + l]));
        } else {
          EXPECT_EQ(bits(slots[3 * width + l]), bits(truth)) << static_cast<int>(op);
        }
      }
    }
  }
}

TEST(LaneKernels, TheNormIsTheWorstVariableOfEachLane) {
  for (const LaneKernels* kernels : all_kernels()) {
    const auto width = static_cast<std::size_t>(kernels->width);
    LaneArray error(3 * width), before(3 * width), after(3 * width), out(width);
    const double absolute[] = {1, 2, 1};
    for (std::size_t l = 0; l < width; ++l) {
      error[l] = 0.5;
      error[width + l] = -3.0 * static_cast<double>(l + 1);
      before[width + l] = 10;
      after[width + l] = -20;
      error[2 * width + l] = l == 1 ? kNone : 0;
      after[2 * width + l] = l == 2 ? std::numeric_limits<double>::infinity() : 0;
    }
    kernels->norm(3, error.data(), before.data(), after.data(), absolute, 0.1, out.data());
    EXPECT_EQ(out[0], 0.75);  // 3/(2 + 0.1·20)
    EXPECT_TRUE(std::isnan(out[1]));
    EXPECT_TRUE(std::isnan(out[2]));
    EXPECT_EQ(out[3], 3.0);
  }
}

TEST(LaneKernels, TheWayBetweenTwoEndsAndItsSlope) {
  const LaneKernels& kernels = *lane_kernels(4);
  LaneArray theta(4), before(4), after(4), c1(4), c2(4), c3(4), out(4), slope(4);
  const double at[] = {0, 0.25, 0.5, 1};
  for (std::size_t l = 0; l < 4; ++l) {
    theta[l] = at[l];
    before[l] = 2;
    after[l] = 3;
    c1[l] = 0.5, c2[l] = -1, c3[l] = 4;
  }
  kernels.between(1, theta.data(), before.data(), after.data(), c1.data(), c2.data(), c3.data(), out.data(),
                  slope.data());
  const auto polynomial = [](double t) { return (1 - t) * 2 + t * (3 + (1 - t) * (0.5 + t * (-1 + 4 * t))); };
  constexpr double h = 1e-4;
  for (std::size_t l = 0; l < 4; ++l) {
    EXPECT_DOUBLE_EQ(out[l], polynomial(at[l]));
    // a central difference, whose error is h² times a third derivative of some tens
    EXPECT_NEAR(slope[l], (polynomial(at[l] + h) - polynomial(at[l] - h)) / (2 * h), 1e-6);
  }
}

}  // namespace
}  // namespace oblique::ensemble
