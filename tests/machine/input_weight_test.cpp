// SPDX-License-Identifier: MIT
#include <oblique/machine/input_weight.h>

#include <vector>

#include <gtest/gtest.h>

namespace oblique::machine {
namespace {

const std::vector<double> kGains{1, 10};

void expect_split(double weight, int inputs, double gain, double setting) {
  const InputWeight split = split_weight(weight, kGains);
  EXPECT_EQ(split.inputs, inputs) << weight;
  EXPECT_EQ(split.gain, gain) << weight;
  EXPECT_DOUBLE_EQ(split.setting, setting) << weight;
  EXPECT_DOUBLE_EQ(split.inputs * split.gain * split.setting, weight);
}

TEST(InputWeight, IsAPotentiometerBeforeTheLeastGainThatSuffices) {
  expect_split(1, 1, 1, 1);
  expect_split(10, 1, 10, 1);
  expect_split(0.25, 1, 1, 0.25);
  expect_split(2.5, 1, 10, 0.25);
}

TEST(InputWeight, PutsInputsInParallelBeyondTheGreatestGain) {
  expect_split(20, 2, 10, 1);
  expect_split(25, 3, 10, 25.0 / 30);
  expect_split(101, 11, 10, 101.0 / 110);
}

TEST(InputWeight, TakesRoundingForNoWeight) {
  const InputWeight split = split_weight(3 * (1.0 / 3) * (10 + 1e-14), kGains);
  EXPECT_EQ(split.inputs, 1);
  EXPECT_EQ(split.setting, 1);
}

TEST(InputWeight, IsTheGainItselfWhereAnyCanBeHad) {
  const InputWeight split = split_weight(3.7, {});
  EXPECT_EQ(split.inputs, 1);
  EXPECT_EQ(split.gain, 3.7);
  EXPECT_EQ(split.setting, 1);
}

TEST(ChooseRate, TakesTheLeastTimeFactorAtWhichOneInputSuffices) {
  const std::vector<double> rates{10, 1000};
  EXPECT_EQ(choose_rate(1, 1, rates, kGains), 10);
  EXPECT_EQ(choose_rate(100, 1, rates, kGains), 10);
  EXPECT_EQ(choose_rate(100.1, 1, rates, kGains), 1000);
  EXPECT_EQ(choose_rate(6.3e7, 6.3e7, rates, kGains), 6.3e7);  // none: the component list will say so
  EXPECT_EQ(choose_rate(5, 2, {}, kGains), 2);                 // any can be had
  EXPECT_DOUBLE_EQ(choose_rate(157, 1, {}, kGains), 100);
  EXPECT_DOUBLE_EQ(choose_rate(700, 1, {}, kGains), 100);
  EXPECT_DOUBLE_EQ(choose_rate(1000 * (1 + 1e-15), 1, {}, kGains), 100);  // rounding asks for no more
  EXPECT_DOUBLE_EQ(choose_rate(1001, 1, {}, kGains), 1000);
  EXPECT_EQ(choose_rate(201, 20000, {}, kGains), 20000);
  EXPECT_DOUBLE_EQ(choose_rate(199, 20000, {}, kGains), 100);  // settings of a hundredth
  EXPECT_DOUBLE_EQ(choose_rate(1e-4, 20000, {}, kGains), 1);
  EXPECT_EQ(choose_rate(1e-4, 1, {}, kGains), 1);
}

}  // namespace
}  // namespace oblique::machine
