// SPDX-License-Identifier: MIT
// A mechanism is the same one in micrometres and in kilometres: its motion, its patch and their errors are.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/compare/compare.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

namespace oblique::compare {
namespace {

const std::filesystem::path kCatalogue = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms";

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const auto& entry : std::filesystem::directory_iterator(kCatalogue)) {
    if (entry.path().extension() == ".toml") all.push_back(entry.path().stem().string());
  }
  std::sort(all.begin(), all.end());
  return all;
}

/// With all lengths `factor` times as many.
mechanism::Mechanism scaled(mechanism::Mechanism mechanism, double factor) {
  for (mechanism::Point& point : mechanism.points) point.position *= factor;
  for (mechanism::SketchPoint& mark : mechanism.sketch) mark.position *= factor;
  for (mechanism::Body& body : mechanism.bodies) {
    for (mechanism::BodyPoint& point : body.points) point.local *= factor;
    body.width *= factor;
  }
  for (mechanism::Slide& slide : mechanism.slides) slide.offset *= factor;
  for (mechanism::Drive& drive : mechanism.drives) {
    if (!drive.slide) continue;
    drive.start *= factor;
    drive.speed *= factor;
    drive.law_scale *= factor;
  }
  mechanism.expectations.clear();
  return mechanism;
}

struct Unit {
  const char* name;
  double per_metre;
};
constexpr Unit kUnits[] = {{"um", 1e6}, {"mm", 1e3}, {"m", 1}, {"km", 1e-3}};

/// In a unit, from a catalogue that has its lengths in millimetres or metres.
mechanism::Mechanism in_unit(const mechanism::Mechanism& mechanism, const Unit& unit) {
  const double from = mechanism.length_unit == "mm" ? 1e3 : 1;
  mechanism::Mechanism result = scaled(mechanism, unit.per_metre / from);
  result.length_unit = unit.name;
  return result;
}

class Units : public ::testing::TestWithParam<std::string> {
 protected:
  mechanism::Mechanism read() const { return mechanism::read_mechanism(kCatalogue / (GetParam() + ".toml")); }
};
INSTANTIATE_TEST_SUITE_P(Catalogue, Units, ::testing::ValuesIn(names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(Units, ChangeNothingInTheMotion) {
  const mechanism::Mechanism original = read();
  ASSERT_TRUE(original.length_unit == "mm" || original.length_unit == "m") << original.length_unit;
  const mechanism::Motion motion = mechanism::solve_motion(in_unit(original, kUnits[2]), 181);
  for (const Unit& unit : kUnits) {
    const mechanism::Motion same = mechanism::solve_motion(in_unit(original, unit), 181);
    ASSERT_EQ(same.events.size(), motion.events.size()) << unit.name;
    for (std::size_t i = 0; i < motion.events.size(); ++i) {
      EXPECT_EQ(same.events[i].kind, motion.events[i].kind);
      // limits are told to 1e-10 rad; the drives of the catalogue turn in a second or faster
      EXPECT_NEAR(same.events[i].time, motion.events[i].time, 1e-9) << unit.name;
    }
    for (std::size_t row = 0; row < motion.times.size(); ++row) {
      const mechanism::Configuration& here = motion.configurations[row];
      const mechanism::Configuration& there = same.configurations[row];
      ASSERT_EQ(there.status, here.status) << unit.name << " row " << row;
      if (here.status != mechanism::Status::ok) continue;
      for (std::size_t p = 0; p < here.points.size(); ++p) {
        // roundings of lengths below 10 m, many times enlarged beside a dead centre
        EXPECT_LT((there.points[p].position / unit.per_metre - here.points[p].position).norm(), 1e-9)
            << unit.name << " row " << row;
      }
    }
  }
}

/// What `compare` says of a mechanism at gain 100, over its size; nothing where it is not patched.
std::optional<Comparison> compared(const mechanism::Mechanism& mechanism) {
  CompareOptions options;
  options.methods = {patch::PatchMethod::gradient};
  options.gains = {100};
  options.positions = 91;
  try {
    return compare(mechanism, diagram::BlockLibrary::shipped(), options);
  } catch (const text::Error&) {
    return std::nullopt;
  }
}

/// What one run overloads clearly the other overloads too; a signal that grazes the margin of 1e-6 is decided
/// by roundings.
void expect_overloads_of(const ComparedRun& one, const ComparedRun& other) {
  for (const Overload& overload : one.overloads) {
    if (std::abs(overload.peak.value) < 1 + 10 * kOverloadMargin) continue;
    EXPECT_TRUE(std::any_of(other.overloads.begin(), other.overloads.end(), [&](const Overload& twin) {
      return twin.signal == overload.signal;
    })) << overload.signal;
  }
}

TEST_P(Units, ChangeNothingInTheComparison) {
  const mechanism::Mechanism original = read();
  const auto comparison = compared(in_unit(original, kUnits[0]));
  for (const Unit& unit : std::span(kUnits).subspan(1)) {
    const auto same = compared(in_unit(original, unit));
    ASSERT_EQ(same.has_value(), comparison.has_value()) << unit.name;
    if (!comparison) continue;
    const ComparedRun& run = comparison->runs.front();
    const ComparedRun& again = same->runs.front();
    EXPECT_EQ(again.bandwidth, run.bandwidth) << unit.name;
    EXPECT_EQ(again.stable, run.stable) << unit.name;
    expect_overloads_of(run, again);
    expect_overloads_of(again, run);
    // the runs have a tolerance of 1e-10 a step, and take some thousands of them
    const double error = run.max_error / comparison->size;
    EXPECT_NEAR(again.max_error / same->size, error, 1e-3 * error + 1e-7) << unit.name;
  }
}

}  // namespace
}  // namespace oblique::compare
