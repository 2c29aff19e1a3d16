// SPDX-License-Identifier: MIT
#include <oblique/compare/branch.h>

#include <numbers>

#include <gtest/gtest.h>

#include <oblique/compare/patched_run.h>
#include <oblique/mechanism/model/read_mechanism.h>

#include "four_bar.h"

namespace oblique::compare {
namespace {

constexpr std::size_t kRows = 36;

/// A run of the four-bar, as a hand would write it: B on its circle, and C and M wherever a row has them.
class Branch : public ::testing::Test {
 protected:
  Branch() {
    for (std::size_t row = 0; row < kRows; ++row)
      times_.push_back(2 * std::numbers::pi * static_cast<double>(row) / kRows);
    exact_ = mechanism::solve_motion(four_bar_, times_);
    for (const diagram::FlatOutput& output : patched_.flat.outputs) columns_.push_back({output.name});
  }

  /// The place of C in the mode in which it lies to the left of B → D, or to the right.
  static Eigen::Vector2d joint(double angle, int side) {
    const Eigen::Vector2d b = testing::crank_end(angle), c = testing::rocker_end(angle);
    if (side > 0) return c;
    const Eigen::Vector2d along = (testing::kPivot - b).normalized();
    return b + 2 * along.dot(c - b) * along - (c - b);
  }

  /// Adds a row in which C is `off` [m] to the right of a mode's place.
  void add_row(int side, double off) {
    const double angle = times_[run_.rows()];
    const Eigen::Vector2d b = testing::crank_end(angle);
    const Eigen::Vector2d c = joint(angle, side) + Eigen::Vector2d(off, 0);
    const Eigen::Vector2d along = (c - b).normalized();
    const Eigen::Vector2d m = b + 1.75 * along + Eigen::Vector2d(-along.y(), along.x());
    std::vector<double> row(columns_.size(), 0);
    row[0] = angle;
    for (const PointOutputs& of : point_outputs(four_bar_, patched_.flat)) {
      const std::string& name = four_bar_.points[of.point].name;
      const Eigen::Vector2d& place = name == "B" ? b : name == "C" ? c : m;
      row[1 + of.x] = place.x();
      row[1 + of.y] = place.y();
    }
    run_.add_row(row);
  }

  std::optional<std::size_t> row_off() const {
    const Distances found = distances(four_bar_, patched_.flat, run_, exact_);
    return row_off_branch(four_bar_, mechanism::decompose(four_bar_), patched_.flat, run_, exact_,
                          found.along);
  }

  const mechanism::Mechanism four_bar_ =
      mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml");
  const diagram::BlockLibrary library_ = diagram::BlockLibrary::shipped();
  const PatchedMechanism patched_{patch_named(four_bar_, {}), library_};
  std::vector<double> times_;
  mechanism::Motion exact_;
  std::vector<solve::Trajectory::Column> columns_{{"t"}};
  solve::Trajectory run_{};

  void SetUp() override { run_ = solve::Trajectory(columns_); }
};

TEST_F(Branch, IsKeptByARunThatErrs) {
  for (std::size_t row = 0; row < kRows; ++row)
    add_row(1, row % 2 == 0 ? 0.3 : 0);  // more than a twentieth of 4 m
  EXPECT_FALSE(row_off());
}

TEST_F(Branch, IsLeftWhereTheOtherAssemblyModeIsNearer) {
  for (std::size_t row = 0; row < kRows; ++row) add_row(row < 20 ? 1 : -1, row % 2 == 0 ? 0.3 : 0);
  EXPECT_EQ(row_off(), 20U);
}

TEST_F(Branch, IsLeftFromTheStart) {
  for (std::size_t row = 0; row < kRows; ++row) add_row(-1, 0);
  EXPECT_EQ(row_off(), 0U);
}

}  // namespace
}  // namespace oblique::compare
