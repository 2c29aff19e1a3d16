// SPDX-License-Identifier: MIT
#include <oblique/commission/on_machine.h>

#include <gtest/gtest.h>

#include <oblique/machine/realise.h>

#include "../support/shipped.h"

namespace oblique::commission {
namespace {

/// The four-bar on THE ANALOG THING, whose multipliers lag by 1 MHz: with them a loop of gain μ and bandwidth
/// B has a damping that falls with √(μB), and with where the linkage stands. At μ = 15000 the bandwidths come
/// one after the other past the least that is well damped, 0.3: at the start with 10 Hz, and where the
/// linkage stands worst, a sixth below, with 5 Hz.
class FourBarOnMachine : public ::testing::Test {
 protected:
  FourBarOnMachine() { options_.gain = 15000; }

  /// Made as the library's user would, with this bandwidth.
  diagram::Diagram realised(double bandwidth) const {
    patch::PatchOptions options = options_;
    options.bandwidth = bandwidth;
    return machine::realise(patch::patch(mechanism_, options), library_, machine_).diagram;
  }

  const mechanism::Mechanism mechanism_ = test::shipped("four-bar");
  const diagram::BlockLibrary library_ = diagram::BlockLibrary::shipped();
  const diagram::MachineProfile& machine_ = *diagram::find_machine("the-analog-thing");
  patch::PatchOptions options_;
};

TEST_F(FourBarOnMachine, IsJudgedAlongTheWholeMotionWhereItsStartIsFine) {
  EXPECT_FALSE(judge_start(realised(20), library_).well_damped());
  EXPECT_TRUE(judge_start(realised(10), library_).well_damped());
  EXPECT_FALSE(judge(realised(10), library_).well_damped());
  EXPECT_TRUE(judge(realised(5), library_).well_damped());

  const MachinePatch made =
      put_on_machine(mechanism_, library_, machine_, judged_patch(mechanism_, library_, options_));
  EXPECT_EQ(made.options.bandwidth, 5);
  ASSERT_TRUE(made.usual);
  EXPECT_EQ(made.usual->bandwidth, 20);
  EXPECT_TRUE(made.realised.blocks == realised(5).blocks);
  // What is told of it is that of its worst moment.
  EXPECT_EQ(made.judgement.damping, judge(made.realised, library_).damping);
  EXPECT_LT(made.judgement.damping, judge_start(made.realised, library_).damping);
}

// Of a bandwidth that is asked for nothing is chosen: the patch is good, though it swings.
TEST_F(FourBarOnMachine, KeepsTheBandwidthThatIsAskedFor) {
  options_.bandwidth = 10;
  const MachinePatch made =
      put_on_machine(mechanism_, library_, machine_, judged_patch(mechanism_, library_, options_));
  EXPECT_EQ(made.options.bandwidth, 10);
  EXPECT_FALSE(made.usual);
  EXPECT_TRUE(made.judgement.good());
  EXPECT_FALSE(made.judgement.well_damped());
}

// Evans' linkage, of a crank OA = 0.8 and a coupler AB = 1.1 whose end B slides along y = 1.2. On a machine
// the crank starts by wires, and before it is there the height of B over A is 1.2, more than the coupler is
// long.
TEST(PatchOnMachine, StartsAtADriveThatStartsByWires) {
  const mechanism::Mechanism evans = mechanism::parse_mechanism(R"toml(format = "oblique-mechanism/1"
[units]
length = "m"
[frame]
O = [0, 0]
G = [0, 1.2]
H = [3, 1.2]
[bodies]
OA = { points = ["O", "A"], length = 0.8 }
AB = { points = ["A", "B"], length = 1.1 }
[slides]
b = { point = "B", along = ["G", "H"] }
[drives]
crank = { turns = "OA", about = "O", speed = "0.4 rad/s", start = "0.6 rad" }
[sketch]
B = [1.5, 1.2]
[motion]
until = "1.5 s"
)toml",
                                                                "evans.toml");
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  for (const char* const machine : {"tr-10", "model-1"}) {
    const MachinePatch made =
        put_on_machine(evans, library, *diagram::find_machine(machine), judged_patch(evans, library, {}));
    EXPECT_TRUE(made.judgement.well_damped()) << machine << ": " << made.judgement.no_rest;
  }
}

}  // namespace
}  // namespace oblique::commission
