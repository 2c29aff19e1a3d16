// SPDX-License-Identifier: MIT
#include <oblique/solve/trajectory.h>

#include <array>

#include <gtest/gtest.h>

namespace oblique::solve {
namespace {

TEST(Trajectory, IsATableByRowAndColumn) {
  Trajectory table({{"t", "s"}, {"x", "m"}});
  EXPECT_EQ(table.rows(), 0U);
  table.add_row(std::array{0.0, 1.5});
  table.add_row(std::array{0.5, -2.0});
  EXPECT_EQ(table.rows(), 2U);
  EXPECT_EQ(table.at(1, 1), -2);
  EXPECT_EQ(table.row(1)[0], 0.5);
  EXPECT_EQ(table.row(0).size(), 2U);
  EXPECT_EQ(table.find("x"), 1U);
  EXPECT_EQ(table.find("y"), std::nullopt);
  EXPECT_EQ(table.values().size(), 4U);
  EXPECT_EQ(table.values()[2], 0.5);
}

TEST(Trajectory, IsEmptyWithoutColumns) {
  EXPECT_EQ(Trajectory().rows(), 0U);
  EXPECT_EQ(Trajectory().find("t"), std::nullopt);
}

}  // namespace
}  // namespace oblique::solve
