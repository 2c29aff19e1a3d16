// SPDX-License-Identifier: MIT
#include <oblique/mechanism/solver/pose_search.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/structure/structure.h>

#include "../mechanism_text.h"

namespace oblique::mechanism {
namespace {

using Eigen::Vector2d;

/// B is carried beside x = 100 by a block on two pins, 12 from their line (20·15/25), on the right or turned
/// by 180° on the left, and an arm in the direction φ has its slot on the pin O. So there are two poses: B
/// stands at (100 ± 12)·(1, tan φ) from O. All of it stands at `where`; Z, far away, has nothing to do with
/// it.
class CarriedArm {
 public:
  explicit CarriedArm(const Vector2d& where)
      : where_(where), whole_(mechanism(text(where))), group_(find_groups(whole_).groups.at(0)) {}

  GroupPoses poses(double angle, const GroupPose* hint = nullptr) {
    GroupSystem system(whole_, group_.equations);
    const std::vector<DriveState> drives{{angle, 1, 0}};
    return search_poses(system, drives, frame_configuration(whole_), hint);
  }
  /// From O.
  Vector2d place_of_base(const GroupPose& pose) const {
    const auto arm = std::find(group_.equations.platforms.begin(), group_.equations.platforms.end(),
                               whole_.find_body("arm").value());
    return pose.platforms.at(static_cast<std::size_t>(arm - group_.equations.platforms.begin())).position -
           where_;
  }

 private:
  static std::string text(const Vector2d& where) {
    return fmt::format(R"([frame]
Z = [1e8, -1e8]
O = [{0}, {1}]
F = [{2}, {1}]
E = [{2}, {3}]
[bodies]
arm = {{ points = ["B", "T"], length = 150 }}
block = {{ points = ["B", "L"], length = 20, marks = {{ K = [0, 15] }} }}
[slides]
slot = {{ point = "O", along = ["B", "T"] }}
upper = {{ point = "L", along = ["F", "E"] }}
lower = {{ point = "K", along = ["F", "E"] }}
[drives]
crank = {{ turns = "arm", about = "B", speed = 1 }}
)",
                       where.x(), where.y(), where.x() + 100, where.y() + 100);
  }

  Vector2d where_;
  Mechanism whole_;
  Group group_;
};

// Newton's method goes no farther than half the size (150) in each of 60 steps: from a box that is not about
// the pin it would not come there.
TEST(PoseSearch, FindsEveryPoseOnceWhereverTheGroupStands) {
  for (const Vector2d& where : {Vector2d(0, 0), Vector2d(2e5, -3e5), Vector2d(-4e5, 1e5)}) {
    CarriedArm group(where);
    for (const double angle : {0.0, 0.6, -1.1}) {
      const GroupPoses found = group.poses(angle);
      EXPECT_FALSE(found.complete);
      ASSERT_EQ(found.poses.size(), 2U) << angle << " at " << where.x();
      Vector2d left = group.place_of_base(found.poses[0]), right = group.place_of_base(found.poses[1]);
      if (left.x() > right.x()) std::swap(left, right);
      // roundings of the place, 6e-11, a few times
      const Vector2d along(1, std::tan(angle));
      EXPECT_LT((left - 88 * along).norm(), 1e-9) << angle;
      EXPECT_LT((right - 112 * along).norm(), 1e-9) << angle;
    }
  }
}

TEST(PoseSearch, BeginsWithTheHintAndIsTheSameEachTime) {
  CarriedArm group({0, 0});
  const GroupPoses blind = group.poses(0.6);
  ASSERT_EQ(blind.poses.size(), 2U);
  for (const GroupPose& pose : blind.poses) {
    GroupPose hint = pose;
    for (GroupPose::Platform& platform : hint.platforms) platform.position += Vector2d(0.5, -0.5);
    const GroupPoses found = group.poses(0.6, &hint);
    ASSERT_EQ(found.poses.size(), 2U);
    EXPECT_LT((group.place_of_base(found.poses[0]) - group.place_of_base(pose)).norm(), 1e-9);
  }
  const GroupPoses again = group.poses(0.6);
  for (std::size_t i = 0; i < again.poses.size(); ++i)
    EXPECT_EQ(again.poses[i].platforms[0].position, blind.poses[i].platforms[0].position);
}

}  // namespace
}  // namespace oblique::mechanism
