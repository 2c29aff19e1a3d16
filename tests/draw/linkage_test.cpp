// SPDX-License-Identifier: MIT
// Pictures of mechanisms, measured: what a reader would read off at the axes is what the exact motion says.
#include <oblique/draw/linkage/linkage.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/picture/label_placer.h>
#include <oblique/draw/picture/rounded_hull.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/follower.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>

#include "../support/shipped.h"
#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using test::shipped;
using Extent = Eigen::AlignedBox<double, 2>;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

draw::LinkageScene scene_at(const mechanism::Mechanism& mechanism, double time) {
  draw::LinkageScene scene;
  const mechanism::Structure structure = mechanism::decompose(mechanism);
  mechanism::Follower follower(mechanism, structure);
  scene.shown = follower.advance(time);
  scene.motion = mechanism.drives.empty() ? std::vector<mechanism::Configuration>{scene.shown}
                                          : mechanism::solve_motion(mechanism, 121).configurations;
  scene.traces = draw::points_to_trace(mechanism);
  scene.caption = "crank = 0°";
  return scene;
}

std::vector<std::string> names_of_traces(const std::string& name) {
  const mechanism::Mechanism mechanism = shipped(name);
  std::vector<std::string> names;
  for (const std::size_t point : draw::points_to_trace(mechanism))
    names.push_back(mechanism.points[point].name);
  return names;
}

class Shipped : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Mechanisms, Shipped, ::testing::ValuesIn(shipped_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Numbers at the axes are read as they stand; their labels lie at their ticks to rounding.
TEST_P(Shipped, PinsLieWhereTheMotionSays) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  for (const double time : {0.0, 0.02}) {
    const draw::LinkageScene scene = scene_at(mechanism, time);
    if (scene.shown.status == mechanism::Status::open) continue;
    const draw::Picture picture = draw::draw_linkage(mechanism, scene);
    const Reading reading(picture.marks);
    std::size_t found = 0;
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      const draw::Mark* const pin = find_mark(picture, "pin-" + mechanism.points[p].name);
      if (pin == nullptr) continue;
      ++found;
      const Vector2d at = std::get<draw::Disc>(pin->shape).centre;
      EXPECT_LT((at - reading.pixel(scene.shown.points[p].position)).norm(), 0.01)
          << mechanism.points[p].name;
    }
    EXPECT_GE(found, 2U);
  }
}

TEST_P(Shipped, EverythingLiesWithinThePicture) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  const draw::Picture picture = draw::draw_linkage(mechanism, scene_at(mechanism, 0));
  const Extent paper(Vector2d(0, 0), Vector2d(picture.width, picture.height));
  for (const draw::Mark& mark : picture.marks) {
    const Extent extent = draw::extent_of(mark);
    EXPECT_TRUE(paper.contains(extent))
        << mark.id << " " << extent.min().transpose() << " to " << extent.max().transpose();
  }
}

TEST_P(Shipped, NamesLieOnNothing) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  const draw::Picture picture = draw::draw_linkage(mechanism, scene_at(mechanism, 0));
  std::vector<const draw::Mark*> names, things;
  for (const draw::Mark& mark : picture.marks) {
    if (mark.id.starts_with("name-")) names.push_back(&mark);
    if (mark.id.starts_with("pin-") || mark.id.starts_with("body-") || mark.id.starts_with("slide-"))
      things.push_back(&mark);
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    const Extent extent = draw::extent_of(*names[k]);
    for (std::size_t j = 0; j < k; ++j)
      EXPECT_TRUE(extent.intersection(draw::extent_of(*names[j])).isEmpty()) << names[k]->id << names[j]->id;
    for (const draw::Mark* const thing : things)
      EXPECT_FALSE(line_meets(*thing, extent)) << names[k]->id << " on " << thing->id;
  }
}

/// The area between the points of a link [px²]; 0 for a bar.
double area_of(const mechanism::Mechanism& mechanism, const mechanism::Body& body,
               const draw::Picture& picture) {
  const auto pin = [&](std::size_t k) {
    return std::get<draw::Disc>(
               find_mark(picture, "pin-" + mechanism.points[body.points[k].point].name)->shape)
        .centre;
  };
  double greatest = 0;
  for (std::size_t k = 2; k < body.points.size(); ++k) {
    const Vector2d a = pin(1) - pin(0), b = pin(k) - pin(0);
    greatest = std::max(greatest, std::abs(a.x() * b.y() - a.y() * b.x()) / 2);
  }
  return greatest;
}

TEST_P(Shipped, HatchingLiesOverPlates) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  const draw::Picture picture = draw::draw_linkage(mechanism, scene_at(mechanism, 0));
  const auto place = [&](const draw::Mark& mark) { return &mark - picture.marks.data(); };
  std::ptrdiff_t lowest = static_cast<std::ptrdiff_t>(picture.marks.size());
  std::size_t supports = 0;
  for (const draw::Mark& mark : picture.marks) {
    if (!mark.id.starts_with("ground-") && !mark.id.starts_with("guide-")) continue;
    lowest = std::min(lowest, place(mark));
    ++supports;
  }
  EXPECT_GE(supports, 1U);
  for (const mechanism::Body& body : mechanism.bodies) {
    const draw::Mark* const inside = find_mark(picture, "inside-" + body.name);
    ASSERT_NE(inside, nullptr) << body.name;
    EXPECT_NE(inside->fill, draw::Ink::none);
    constexpr double kSeen = 0.1;  // [px²]
    EXPECT_LT(place(*inside), place(*find_mark(picture, "body-" + body.name)));
    if (area_of(mechanism, body, picture) <= kSeen) continue;
    EXPECT_LT(place(*inside), lowest) << body.name;
  }
}

TEST_P(Shipped, NamesThatStrayAreLedToTheirPins) {
  const mechanism::Mechanism mechanism = shipped(GetParam());
  const draw::Picture picture = draw::draw_linkage(mechanism, scene_at(mechanism, 0));
  for (const draw::Mark& name : picture.marks) {
    if (!name.id.starts_with("name-")) continue;
    const std::string point = name.id.substr(5);
    const draw::Mark* const leader = find_mark(picture, "leader-" + point);
    const draw::Mark* const pin = find_mark(picture, "pin-" + point);
    const Vector2d centre = std::get<draw::Disc>(pin->shape).centre;
    const Extent extent = draw::extent_of(name);
    EXPECT_EQ(leader != nullptr, extent.exteriorDistance(centre) > draw::kFarthestBeside) << point;
    if (leader == nullptr) continue;
    const auto& ends = std::get<draw::Outline>(leader->shape).segments;
    ASSERT_EQ(ends.size(), 2U);
    EXPECT_LT((ends[0].to - centre).norm(), 1e-9) << point;
    EXPECT_LT(extent.exteriorDistance(ends[1].to), 1e-9) << point;
    EXPECT_NEAR((ends[1].to - centre).norm(), extent.exteriorDistance(centre), 1e-9) << point;
    EXPECT_LT(leader->pen.width, 1) << point;
    EXPECT_LT(leader, pin) << point;  // it comes out from under the pin
    for (const mechanism::Body& body : mechanism.bodies)
      EXPECT_GT(leader, find_mark(picture, "body-" + body.name)) << point;
    for (const draw::Mark& other : picture.marks) {
      if (!other.id.starts_with("name-") || &other == &name) continue;
      EXPECT_FALSE(line_meets(*leader, draw::extent_of(other))) << point << " over " << other.id;
    }
  }
}

// Jansen's bearing O2 lies under two plates, among six links.
TEST(Linkage, AJointAmongManyLinksIsStillTold) {
  const mechanism::Mechanism mechanism = shipped("jansen");
  const draw::Picture picture = draw::draw_linkage(mechanism, scene_at(mechanism, 0));
  EXPECT_NE(find_mark(picture, "leader-O2"), nullptr);
  EXPECT_EQ(find_mark(picture, "leader-P5"), nullptr);
}

// The paths of the crank's pin and of the bar's end, the crank at 79°: the closed form of the source.
TEST(Linkage, ThreeBarPathsAreThoseOfItsFormulas) {
  const mechanism::Mechanism mechanism = shipped("three-bar");
  draw::LinkageScene scene = scene_at(mechanism, 79.0 / 360);
  scene.traces = {*mechanism.find_point("B"), *mechanism.find_point("P")};
  const draw::Picture picture = draw::draw_linkage(mechanism, scene);
  const Reading reading(picture.marks);
  const auto& of_b = std::get<draw::Outline>(find_mark(picture, "path-B")->shape).segments;
  const auto& of_p = std::get<draw::Outline>(find_mark(picture, "path-P")->shape).segments;
  ASSERT_EQ(of_b.size(), 121U);
  ASSERT_EQ(of_p.size(), 121U);
  for (std::size_t k = 0; k < 121; ++k) {
    const double crank = 2 * M_PI * static_cast<double>(k) / 120;
    const Vector2d b(100 * std::cos(crank), 100 * std::sin(crank));
    const double bar = std::atan2(-b.y(), 150 - b.x());
    const Vector2d p = b + 300 * Vector2d(std::cos(bar), std::sin(bar));
    EXPECT_LT((of_b[k].to - reading.pixel(b)).norm(), 0.01);
    EXPECT_LT((of_p[k].to - reading.pixel(p)).norm(), 0.01);
  }
}

TEST(Linkage, TracesWhatIsWorthIt) {
  EXPECT_THAT(names_of_traces("jansen"), ElementsAre("P5", "Q5"));
  EXPECT_THAT(names_of_traces("three-bar"), ElementsAre("P"));
  EXPECT_THAT(names_of_traces("six-bar"), ElementsAre("E", "F"));
  EXPECT_THAT(names_of_traces("scotch-yoke"), IsEmpty());
}

TEST(Linkage, OtherPositionsAreDrawnFainterTheFartherTheyAre) {
  const mechanism::Mechanism mechanism = shipped("jansen");
  draw::LinkageScene scene = scene_at(mechanism, 0);
  const std::size_t alone = draw::draw_linkage(mechanism, scene).marks.size();
  scene.others = mechanism::solve_motion(mechanism, 25).configurations;
  const draw::Picture picture = draw::draw_linkage(mechanism, scene);
  // A bar is one mark, a plate two; 13 links, of which the crank with its two pins and four others are
  // plates.
  EXPECT_EQ(picture.marks.size() - alone, 25U * (13 + 5));
  std::vector<double> bars;
  for (const draw::Mark& mark : picture.marks) {
    if (mark.fill == draw::Ink::blue && mark.opacity > 0.1) bars.push_back(mark.opacity);
  }
  EXPECT_EQ(bars.size(), 25U * 8);
  EXPECT_TRUE(std::is_sorted(bars.begin(), bars.end()));
}

TEST(RoundedHull, KeepsItsDistance) {
  const std::vector<Vector2d> corners{{0, 0}, {40, 0}, {10, 30}, {15, 10}};  // the last one lies inside
  const draw::Outline outline = draw::rounded_hull(corners, 5);
  ASSERT_FALSE(outline.segments.empty());
  for (const draw::Segment& segment : outline.segments) {
    if (segment.kind == draw::Segment::Kind::close) continue;
    double nearest = INFINITY;
    for (const Vector2d& corner : corners) nearest = std::min(nearest, (segment.to - corner).norm());
    EXPECT_NEAR(nearest, 5, 1e-9);
  }
  const Extent bar = draw::extent_of({draw::rounded_hull({{0, 0}, {20, 0}}, 3), {draw::Ink::none, 0}});
  EXPECT_NEAR(bar.min().x(), -3, 1e-9);
  EXPECT_NEAR(bar.max().x(), 23, 1e-9);
  EXPECT_NEAR(bar.sizes().y(), 6, 1e-9);
}

TEST(LabelPlacer, GivesEachOfManyAPlaceOfItsOwn) {
  draw::LabelPlacer placer(Extent(Vector2d(0, 0), Vector2d(200, 200)));
  std::vector<Extent> places;
  for (int k = 0; k < 8; ++k) {
    const Extent place = draw::extent_of(placer.place({100, 100}, "B", 13));
    EXPECT_TRUE(Extent(Vector2d(0, 0), Vector2d(200, 200)).contains(place));
    for (const Extent& other : places) EXPECT_TRUE(place.intersection(other).isEmpty());
    places.push_back(place);
  }
}

// All around the point is taken, up to 40 px from it; then a second name behind the first.
TEST(LabelPlacer, LeadsNamesThatStrayPastOthers) {
  draw::LabelPlacer placer(Extent(Vector2d(0, 0), Vector2d(400, 400)));
  placer.avoid(draw::disc_mark({200, 200}, 40, draw::Ink::faint), 50);
  std::vector<Extent> names;
  std::vector<draw::Mark> leaders;
  for (int k = 0; k < 4; ++k) {
    const Extent name = draw::extent_of(placer.place({200, 200}, "P12", 13));
    const auto end = draw::leader_end(name, {200, 200});
    ASSERT_TRUE(end);
    const draw::Mark leader = draw::leader_mark({200, 200}, *end, "P12");
    for (const Extent& other : names) EXPECT_FALSE(line_meets(leader, other)) << k;
    for (const draw::Mark& other : leaders) EXPECT_FALSE(line_meets(other, name)) << k;
    names.push_back(name);
    leaders.push_back(leader);
  }
}

TEST(LeaderEnd, IsTheNearestPlaceOfAFarName) {
  const Extent name(Vector2d(10, 20), Vector2d(40, 32));
  EXPECT_FALSE(draw::leader_end(name, {25, 26}));  // within
  EXPECT_FALSE(draw::leader_end(name, {40 + draw::kFarthestBeside, 25}));
  const auto right = draw::leader_end(name, {41 + draw::kFarthestBeside, 25});
  ASSERT_TRUE(right);
  EXPECT_EQ(*right, Vector2d(40, 25));
  const auto corner = draw::leader_end(name, {-10, 50});
  ASSERT_TRUE(corner);
  EXPECT_EQ(*corner, Vector2d(10, 32));
}

}  // namespace
}  // namespace oblique::test
