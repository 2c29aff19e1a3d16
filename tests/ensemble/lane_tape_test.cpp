// SPDX-License-Identifier: MIT
#include <oblique/ensemble/lanes/lane_tape.h>

#include <random>

#include <gtest/gtest.h>

#include <oblique/ensemble/lanes/lane_array.h>
#include <oblique/ensemble/lanes/lane_kernels.h>

namespace oblique::ensemble {
namespace {

using network::Instruction;
using Code = Instruction::Code;

constexpr std::uint32_t kGiven = 6;

// Instructions in a row, each of two or three results before it.
std::vector<Instruction> random_tape(std::uint32_t length, std::uint32_t first_result, std::mt19937& random) {
  const Code codes[] = {Code::add,  Code::subtract, Code::multiply, Code::sin,         Code::cos,
                        Code::atan, Code::negate,   Code::hypot,    Code::multiply_add};
  std::vector<Instruction> tape;
  for (std::uint32_t k = 0; k < length; ++k) {
    const std::uint32_t known = first_result + k;
    tape.push_back({codes[random() % std::size(codes)], static_cast<std::uint32_t>(random() % known),
                    static_cast<std::uint32_t>(random() % known),
                    static_cast<std::uint32_t>(random() % known), first_result + k});
  }
  return tape;
}

// What the tapes of lanes give is what the instructions give one after the other, in every lane; with shared
// slots, too. (Sine and cosine of the kernels are other than those of the library by 2 units in the last
// place, which later operations enlarge: a loose bound, for a result of another operand is off by its own
// size.)
TEST(LaneTape, GivesTheResultsOfItsInstructions) {
  std::mt19937 random(11);
  for (int trial = 0; trial < 200; ++trial) {
    const std::uint32_t length = 1 + static_cast<std::uint32_t>(random() % 60);
    const auto first = random_tape(length, kGiven, random),
               second = random_tape(length, kGiven + length, random);
    const std::uint32_t n_slots = kGiven + 2 * length;
    const auto as_it_is = [](std::uint32_t slot) { return slot; };
    LaneTape one(first, as_it_is), two(second, as_it_is);
    const std::vector<std::uint32_t> kept{kGiven, n_slots - 1, n_slots - 1 - length / 2};
    LaneTape* const tapes[] = {&one, &two};
    const std::vector<std::uint32_t> slot_of = LaneTape::share_slots(tapes, kept, n_slots);
    for (std::uint32_t k = 0; k < kGiven; ++k) EXPECT_EQ(slot_of[k], k);

    const LaneKernels& kernels = *lane_kernels(8);
    LaneArray lanes(n_slots * 8);
    std::vector<std::vector<double>> slots(8, std::vector<double>(n_slots));
    std::uniform_real_distribution<double> number(-1, 1);
    for (std::size_t k = 0; k < kGiven; ++k) {
      for (std::size_t l = 0; l < 8; ++l) lanes[k * 8 + l] = slots[l][k] = number(random);
    }
    kernels.run(one.code(), lanes.data());
    kernels.run(two.code(), lanes.data());
    for (std::size_t l = 0; l < 8; ++l) {
      network::run_tape(first, slots[l].data());
      network::run_tape(second, slots[l].data());
      for (const std::uint32_t slot : kept) {
        const double truth = slots[l][slot], ours = lanes[slot_of[slot] * 8 + l];
        if (!(std::abs(truth) < 1e6)) continue;
        EXPECT_NEAR(ours, truth, 1e-6 * (1 + std::abs(truth))) << trial;
      }
    }
  }
}

TEST(LaneTape, StandsInRowsOfOneKind) {
  // Sixteen independent products and sums, by turns: two rows.
  std::vector<Instruction> instructions;
  for (std::uint32_t k = 0; k < 16; ++k)
    instructions.push_back({k % 2 == 0 ? Code::multiply : Code::add, 0, 1, 0, 2 + k});
  EXPECT_EQ(LaneTape(instructions, [](std::uint32_t slot) { return slot; }).code().n_ranges, 2U);
}

TEST(LaneTape, NeedsNoMoreSlotsThanLiveAtATime) {
  // A chain: each result is read by the next alone.
  std::vector<Instruction> chain;
  for (std::uint32_t k = 0; k < 50; ++k) chain.push_back({Code::add, k, k, 0, k + 1});
  LaneTape tape(chain, [](std::uint32_t slot) { return slot; });
  LaneTape* const tapes[] = {&tape};
  const std::uint32_t kept[] = {50};
  const auto slot_of = LaneTape::share_slots(tapes, kept, 51);
  EXPECT_LE(*std::max_element(slot_of.begin(), slot_of.end()), 2U);
}

TEST(LaneTape, TablesAreNotForLanes) {
  const Instruction table{Code::table_value, 0, 1, 0, 2}, sum{Code::add, 0, 1, 0, 2};
  EXPECT_TRUE(lanes_can_run({&sum, 1}));
  EXPECT_FALSE(lanes_can_run({&table, 1}));
}

}  // namespace
}  // namespace oblique::ensemble
