// SPDX-License-Identifier: MIT
#include <oblique/ensemble/engine/ensemble.h>

#include <cmath>
#include <stdexcept>

#include <gtest/gtest.h>

#include <oblique/network/assembly/parameter_numbers.h>

#include "../support/compiled.h"

namespace oblique::ensemble {
namespace {

constexpr const char* kDecay = R"(
x = { type = "integrator", in = ["-1*x"], initial = 1 }
)";
constexpr const char* kOutputs = R"(
[outputs]
x = "x"
)";

struct Decays {
  testing::Compiled compiled{kDecay, kOutputs};
  std::vector<std::uint32_t> varied;
  EnsembleOptions options;

  Decays() {
    const network::ParameterNumbers numbers(compiled.flat);
    varied = {network::find_parameter(compiled.flat, numbers, "x.in[1]")->number,
              network::find_parameter(compiled.flat, numbers, "x.initial")->number};
    options.run.samples = 11;
  }
};

// Machine k decays at the rate k from the height 1/k.
void rate_and_height(std::uint64_t number, std::span<double> values) {
  values[0] = -static_cast<double>(number);
  values[1] = 1 / static_cast<double>(number);
}

TEST(Ensemble, EachMachineHasItsOwnValues) {
  for (const int threads : {1, 2}) {
    for (const bool lanes : {false, true}) {
      Decays decays;
      decays.options.threads = threads;
      decays.options.lanes = lanes;
      const Ensemble ensemble(decays.compiled.flat, decays.varied, decays.options);
      std::vector<double> ends(41), first(41);
      const EnsembleCount count = ensemble.run(1, 40, rate_and_height, [&](const MachineRun& run) {
        ASSERT_EQ(run.rows.size(), 11 * ensemble.columns()) << run.failure;
        first[run.number] = run.rows[1];
        ends[run.number] = run.rows[run.rows.size() - 1];
      });
      EXPECT_EQ(count.in_lanes + count.by_cvodes, 40u);
      EXPECT_EQ(count.failed, 0u);
      EXPECT_EQ(count.in_lanes, lanes ? 40u : 0u);
      for (std::size_t k = 1; k <= 40; ++k) {
        const double rate = static_cast<double>(k);
        EXPECT_EQ(first[k], 1 / rate);
        // the run's tolerance, 1e-8, of its own height; an absolute part of 1e-10
        EXPECT_NEAR(ends[k], std::exp(-rate) / rate, 2e-8 / rate + 1e-10) << k;
      }
    }
  }
}

TEST(Ensemble, AMachineThatFailsIsToldOfAndTheOthersGoOn) {
  Decays decays;
  const Ensemble ensemble(decays.compiled.flat, decays.varied, decays.options);
  std::vector<std::uint64_t> failed;
  const EnsembleCount count = ensemble.run(
      0, 10, [](std::uint64_t number, std::span<double> values) { values[0] = number == 7 ? 1e300 : -1; },
      [&](const MachineRun& run) {
        EXPECT_EQ(run.rows.empty(), !run.failure.empty());
        if (!run.failure.empty()) failed.push_back(run.number);
      });
  EXPECT_EQ(failed, std::vector<std::uint64_t>{7});
  EXPECT_EQ(count.failed, 1u);
}

TEST(Ensemble, WhatIsThrownInAThreadEndsAll) {
  for (const int threads : {1, 2}) {
    Decays decays;
    decays.options.threads = threads;
    const Ensemble ensemble(decays.compiled.flat, decays.varied, decays.options);
    std::uint64_t most = 0;
    EXPECT_THROW(ensemble.run(
                     1, 1'000'000'000, rate_and_height, [](const MachineRun&) {},
                     [&](std::uint64_t done) {
                       most = done;
                       if (done > 30) throw std::runtime_error("asked");
                     }),
                 std::runtime_error);
    EXPECT_LT(most, 1000u);
  }
}

}  // namespace
}  // namespace oblique::ensemble
