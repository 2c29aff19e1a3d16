// SPDX-License-Identifier: MIT
// The analytic Jacobian of every shipped primitive block against central differences, with its switches in
// random positions, since each goes on smoothly past its switching surface.
#include <cmath>
#include <map>
#include <random>

#include <gtest/gtest.h>

#include <oblique/network/program/program.h>
#include "../support/compiled.h"

namespace oblique::test {
namespace {

using testing::Compiled;
using testing::shipped_blocks;

/// Parameters that switch on what is off by default; several blocks have several such ways.
const std::multimap<std::string, std::string> kImperfect{
    {"integrator",
     "gain = 50, offset = 0.01, drift = 0.02, leakage = 0.3, noise = 0.1, tolerance = 0.02, "
     "capacitor_tolerance = 0.01"},
    {"integrator", "limit = 0.3, leakage = 0.5, noise = 0.1"},
    {"integrator", "bandwidth = 3, gain = 50, limit = 0.3, noise = 0.1, leakage = 0.2"},
    {"summer", "gain = 20, offset = 0.1, drift = 0.2, noise = 0.3, tolerance = 0.05"},
    {"summer", "bandwidth = 2, gain = 20, noise = 0.3"},
    {"inverter", "gain = 20, offset = 0.1, drift = 0.2, noise = 0.3, tolerance = 0.05"},
    {"inverter", "bandwidth = 2, gain = 20, noise = 0.3"},
    {"multiplier", "error = 0.05, offset = 0.1"},
    {"multiplier", "error = 0.05, bandwidth = 2"},
    {"potentiometer", "setting = 0.4, turns = 30, tolerance = 0.1, load = 0.2"},
    {"servo-amplifier", "gain = 5, limit = 0.4, capacitor = 0.02, offset = 0.1, drift = 0.1, noise = 0.1"},
    {"servo-amplifier", "gain = inf, capacitor = 0.5, limit = 0.4, noise = 0.1"},
    {"servo-amplifier", "gain = 5, bandwidth = inf, limit = 0.4, noise = 0.1"},
    {"transfer-lag", "time_constant = 0.5, gain = 2, limit = 0.4"},
    {"servo-multiplier", "time_constant = 0.1, velocity_limit = 0.5, dead_zone = 0.1"},
    {"servo-multiplier", "velocity_limit = 0.5, dead_zone = 0.1"},
    {"servo-resolver", "time_constant = 0.1, velocity_limit = 0.5, dead_zone = 0.1"},
    {"servo-resolver", "velocity_limit = 0.5, dead_zone = 0.1"},
    {"comparator", "hysteresis = 0.1"},
    {"relay", "delay = 0.1"},
    {"track-and-store", "acquisition_time = 0.2"},
    {"diode", "drop = 0.2, breakdown = 0.4"},
    {"junction-diode", "saturation = 0.1, thermal = 0.5"},
    {"junction-diode", "saturation = 0.1, thermal = 0.5, resistance = 2"},
    {"diode-segment", "side = -1, slope = -2"},
    {"diode-amplifier", "low = -0.3, high = 0.2, resistance = 0.1, gain = 50, limit = 0.5"},
    {"diode-amplifier", "low = -0.3, high = 0.2, resistance = 0.1, feedback = 0, limit = 0.5"},
    {"logarithmic-amplifier", "saturation = 0.1, thermal = 0.5, limit = 0.7"},
    {"logarithmic-amplifier", "saturation = 0.1, thermal = 0.5, pair = 1, limit = 0.7"},
    {"delay-line", "straight = 1, stages = 3"},
};

/// The block "b" with each input wired to a state and each output into another.
std::string wired(const diagram::BlockDefinition& block, const std::string& parameters) {
  std::string states, inputs, outputs;
  int number = 0;
  for (const diagram::InputPort& input : block.inputs) {
    const std::string state = "s" + std::to_string(number++);
    states += state + " = { type = \"integrator\", in = [\"-0.3*" + state + "\"] }\n";
    inputs +=
        input.name + (input.sum ? " = [\"1.5*" + state + "\", \"-0.5*s0\"], " : " = \"" + state + "\", ");
  }
  for (const diagram::OutputPort& output : block.outputs) {
    const std::string signal = block.outputs.size() > 1 ? "b." + output.name : "b";
    outputs += "o" + std::to_string(number++) + " = { type = \"integrator\", in = [\"" + signal + "\"] }\n";
  }
  return states + "b = { " + inputs + parameters + "type = \"" + block.name + "\" }\n" + outputs;
}

class Differences {
 public:
  Differences(const std::string& name, const std::string& blocks)
      : name_(name), made_(blocks), program_(made_.program), workspace_(program_), n_(program_.n_states()) {}

  void compare() {
    for (int round = 0; round < 20; ++round) {
      workspace_.reset();
      workspace_.reset_discrete_states();
      for (const network::Switch& s : program_.switches())
        workspace_.set_discrete_state(s.discrete_state, at_random(0, 1) < 0.5 ? 0 : 1);
      std::vector<double> x(n_);
      for (double& value : x) value = at_random(0.1, 0.9);  // where roots and logarithms have values
      compare_at(at_random(0.1, 2), x);
    }
  }

 private:
  double at_random(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(generator_);
  }

  std::vector<double> derivatives(double t, const std::vector<double>& x) {
    std::vector<double> values(n_);
    EXPECT_TRUE(program_.derivatives(t, x.data(), values.data(), workspace_)) << name_;
    return values;
  }

  void compare_at(double t, const std::vector<double>& x) {
    const network::SparsePattern& pattern = program_.jacobian_pattern();
    std::vector<double> values(pattern.entries());
    ASSERT_TRUE(program_.jacobian(t, x.data(), values.data(), workspace_)) << name_;
    for (std::size_t column = 0; column < n_; ++column) {
      std::vector<double> found(n_, 0.0);
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        found[static_cast<std::size_t>(pattern.rows[entry])] = values[entry];
      }
      constexpr double kStep = 1e-5;
      std::vector<double> left = x, right = x;
      left[column] -= kStep;
      right[column] += kStep;
      const std::vector<double> below = derivatives(t, left), above = derivatives(t, right);
      for (std::size_t row = 0; row < n_; ++row) {
        const double derivative = (above[row] - below[row]) / (2 * kStep);
        // Truncation h² f‴/6 with f‴ up to 1e3, and rounding of the values over h.
        const double size = 1 + std::abs(derivative) + std::abs(above[row]) * 1e-3;
        EXPECT_NEAR(found[row], derivative, 1e-7 * size)
            << name_ << ": d " << program_.states()[row].name << "/d " << program_.states()[column].name;
      }
    }
  }

  std::string name_;
  Compiled made_;
  const network::Program& program_;
  network::Workspace workspace_;
  std::size_t n_;
  std::mt19937_64 generator_{20240501};
};

TEST(BlockJacobian, AgreesWithDifferencesForEveryShippedBlock) {
  for (const std::string& name : shipped_blocks().names()) {
    const diagram::BlockDefinition& block = *shipped_blocks().find(name);
    if (!block.is_composite()) Differences(name, wired(block, "")).compare();
  }
}

TEST(BlockJacobian, AgreesWithDifferencesWithImperfections) {
  for (const auto& [name, parameters] : kImperfect) {
    const diagram::BlockDefinition& block = *shipped_blocks().find(name);
    Differences(name + " " + parameters, wired(block, parameters + ", ")).compare();
  }
}

/// The servo amplifier as an algebraic loop needs one: in = b² − s.
TEST(BlockJacobian, AgreesWithDifferencesOnAnAlgebraicLoop) {
  for (const char* const parameters :
       {"gain = inf", "gain = 30, bandwidth = inf", "gain = inf, noise = 0.01"}) {
    Differences(parameters, std::string(R"(s = { type = "integrator", in = ["-s"] }
square = { type = "multiplier", in = ["b", "b"] }
b = { type = "servo-amplifier", in = ["square", "-s"], initial = 1, )") +
                                parameters + " }\nx = { type = \"integrator\", in = [\"b\"] }\n")
        .compare();
  }
}

}  // namespace
}  // namespace oblique::test
