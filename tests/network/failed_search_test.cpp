// SPDX-License-Identifier: MIT
#include <oblique/network/program/failed_search.h>

#include <vector>

#include <gtest/gtest.h>

namespace oblique::network {
namespace {

/// z² + p on slots: z on 0, p on 1, z² on 2, the residual on 3.
struct Parabola {
  Parabola() {
    code.unknown_slots = {0};
    code.residual_slots = {3};
  }
  LoopCode code;
  std::vector<Instruction> body{{Instruction::Code::multiply, 0, 0, 0, 2},
                                {Instruction::Code::add, 2, 1, 0, 3}};
};

// What began at z = 0.5 with p = 1 ended at 0.25: the same again is known, with another p, start or state of
// the search it is not; and what the body computes does not count.
TEST(FailedSearch, IsRepeatedWhereAllThatItReadIsTheSame) {
  const Parabola loop;
  FailedSearch search;
  std::vector<double> ended{0.25, 1, 7, 8};
  Eigen::VectorXd begun(1);
  begun << 0.5;
  std::vector<double> slots{0.5, 1, -3, -4};
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 2));
  search.note(loop.code, loop.body, ended.data(), begun, 2);
  EXPECT_TRUE(search.repeats(loop.code, slots.data(), 2));
  EXPECT_EQ(slots, (std::vector<double>{0.25, 1, -3, -4}));
  slots[0] = 0.5;
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 3));
  slots[1] = 1.5;
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 2));
  slots = {0.4, 1, -3, -4};
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 2));
  EXPECT_EQ(slots[0], 0.4);
  slots[0] = 0.5;
  search.forget();
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 2));
}

// What a table holds is not among the slots that are compared.
TEST(FailedSearch, IsNotKnownOfALoopWithTables) {
  Parabola loop;
  loop.body[1] = {Instruction::Code::table_value, 2, 1, 0, 3};
  FailedSearch search;
  std::vector<double> slots{0.5, 1, 0, 0};
  Eigen::VectorXd begun(1);
  begun << 0.5;
  search.note(loop.code, loop.body, slots.data(), begun, 0);
  EXPECT_FALSE(search.repeats(loop.code, slots.data(), 0));
}

}  // namespace
}  // namespace oblique::network
