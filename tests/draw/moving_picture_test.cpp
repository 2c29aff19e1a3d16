// SPDX-License-Identifier: MIT
// Animations frame by frame: what they show, that all of it fits, and that names stay clear of what moves.
#include <oblique/draw/animation/animation.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/draw/animation/animated_page.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>

#include "reading.h"

namespace oblique::test {
namespace {

using Eigen::Vector2d;
using Extent = Eigen::AlignedBox<double, 2>;

constexpr int kMovingFrames = 48;

std::string folder() {
  return std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms";
}

std::vector<std::string> names_of_shipped() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder()))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

/// A motion there and back, which every mechanism has.
draw::LinkageAnimation moving_of(const mechanism::Mechanism& mechanism) {
  mechanism::MotionOptions options;
  options.positions = kMovingFrames / 2 + 1;
  options.at_limit = mechanism::AtLimit::stop;
  draw::LinkageAnimation animation;
  animation.frames = mechanism::solve_motion(mechanism, options).configurations;
  std::erase_if(animation.frames,
                [](const mechanism::Configuration& here) { return here.status == mechanism::Status::open; });
  for (std::size_t k = animation.frames.size() - 1; k-- > 0;) animation.frames.push_back(animation.frames[k]);
  animation.scene.motion = animation.frames;
  animation.scene.shown = animation.frames.front();
  animation.scene.traces = draw::points_to_trace(mechanism);
  for (std::size_t k = 0; k < animation.frames.size(); ++k)
    animation.captions.push_back("frame " + std::to_string(k));
  return animation;
}

class Moving : public ::testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Mechanisms, Moving, ::testing::ValuesIn(names_of_shipped()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

TEST_P(Moving, EverythingLiesWithinThePictureAtAllTimes) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/" + GetParam() + ".toml");
  const draw::LinkageAnimation animation = moving_of(mechanism);
  const draw::AnimationFrames frames(mechanism, animation);
  for (std::size_t k = 0; k < animation.frames.size(); ++k) {
    const draw::Picture picture = frames.picture(k);
    const Extent paper(Vector2d(0, 0), Vector2d(picture.width, picture.height));
    const Reading reading(picture.marks);
    for (const draw::Mark& mark : picture.marks)
      ASSERT_TRUE(paper.contains(draw::extent_of(mark))) << mark.id << k;
    EXPECT_EQ(std::get<draw::Label>(find_mark(picture, "caption")->shape).text, animation.captions[k]);
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      const draw::Mark* const pin = find_mark(picture, "pin-" + mechanism.points[p].name);
      if (pin == nullptr) continue;
      const Vector2d at = std::get<draw::Disc>(pin->shape).centre;
      ASSERT_LT((at - reading.pixel(animation.frames[k].points[p].position)).norm(), 0.01) << pin->id << k;
    }
  }
}

// Links sweep over every place around a pin, so names have to give way; where three links and two guides meet
// there is now and then no place. No name lies on another, and of 100 names 99 are clear.
TEST_P(Moving, NamesStayClear) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/" + GetParam() + ".toml");
  const draw::LinkageAnimation animation = moving_of(mechanism);
  const draw::AnimationFrames frames(mechanism, animation);
  std::size_t covered = 0, all = 0;
  for (std::size_t k = 0; k < animation.frames.size(); ++k) {
    const draw::Picture picture = frames.picture(k);
    std::vector<const draw::Mark*> names, things;
    for (const draw::Mark& mark : picture.marks) {
      if (mark.id.starts_with("name-")) names.push_back(&mark);
      if (mark.id.starts_with("pin-") || mark.id.starts_with("body-") || mark.id.starts_with("slide-"))
        things.push_back(&mark);
    }
    for (std::size_t n = 0; n < names.size(); ++n) {
      const Extent extent = draw::extent_of(*names[n]);
      for (std::size_t j = 0; j < n; ++j) {
        EXPECT_TRUE(extent.intersection(draw::extent_of(*names[j])).isEmpty())
            << names[n]->id << " on " << names[j]->id << " in frame " << k;
      }
      covered +=
          static_cast<std::size_t>(std::any_of(things.begin(), things.end(), [&](const draw::Mark* thing) {
            return extent.intersects(draw::extent_of(*thing)) && line_meets(*thing, extent);
          }));
      ++all;
    }
  }
  RecordProperty("covered", static_cast<int>(covered));
  EXPECT_LE(static_cast<double>(covered), 0.01 * static_cast<double>(all)) << "of " << all;
}

// A leader line comes out from under the pin while the name strays, and is hidden there while it does not.
TEST_P(Moving, NamesThatStrayAreLedToTheirPins) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/" + GetParam() + ".toml");
  const draw::LinkageAnimation animation = moving_of(mechanism);
  const draw::AnimationFrames frames(mechanism, animation);
  for (std::size_t k = 0; k < animation.frames.size(); ++k) {
    const draw::Picture picture = frames.picture(k);
    for (const draw::Mark& name : picture.marks) {
      if (!name.id.starts_with("name-")) continue;
      const std::string point = name.id.substr(5);
      const draw::Mark* const leader = find_mark(picture, "leader-" + point);
      const draw::Mark* const pin = find_mark(picture, "pin-" + point);
      const Vector2d centre = std::get<draw::Disc>(pin->shape).centre;
      const Extent extent = draw::extent_of(name);
      const double away = extent.exteriorDistance(centre);
      constexpr double kFarthestBeside = 25;  // [px]
      ASSERT_TRUE(leader != nullptr || away <= kFarthestBeside) << name.id << k;
      if (leader == nullptr) continue;
      EXPECT_LT(leader, pin);
      const auto& ends = std::get<draw::Outline>(leader->shape).segments;
      ASSERT_EQ(ends.size(), 2U);
      EXPECT_LT((ends[0].to - centre).norm(), 1e-9) << name.id << k;
      EXPECT_NEAR((ends[1].to - centre).norm(), away > kFarthestBeside ? away : 0, 1e-9) << name.id << k;
    }
  }
}

/// The four-bar linkage with an analog one that is off by 0.1 in x, and by 0.2 in y at the coupler's mark.
draw::LinkageAnimation with_analog(const mechanism::Mechanism& mechanism) {
  draw::LinkageAnimation animation = moving_of(mechanism);
  const auto shifted = [&](const mechanism::Configuration& here) {
    std::vector<Vector2d> places;
    for (std::size_t p = 0; p < mechanism.points.size(); ++p) {
      places.push_back(here.points[p].position);
      if (!mechanism.points[p].fixed)
        places.back() += Vector2d(0.1, mechanism.points[p].name == "M" ? 0.2 : 0);
    }
    return places;
  };
  draw::AnalogOverlay overlay;
  for (const mechanism::Configuration& here : animation.scene.motion) overlay.motion.push_back(shifted(here));
  overlay.shown = shifted(animation.scene.shown);
  overlay.legend = "analog, error ×7";
  overlay.caption = "largest error 0.03 m";
  animation.scene.analog = overlay;
  animation.analog_frames = overlay.motion;
  return animation;
}

std::vector<Vector2d> corners_of(const draw::Mark& mark) {
  std::vector<Vector2d> corners;
  for (const draw::Segment& segment : std::get<draw::Outline>(mark.shape).segments) {
    if (segment.kind != draw::Segment::Kind::close) corners.push_back(segment.to);
  }
  return corners;
}

TEST(AnalogOverlay, GoesThroughThePointsOfItsBodies) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/four-bar.toml");
  const draw::LinkageAnimation animation = with_analog(mechanism);
  const draw::AnimationFrames frames(mechanism, animation);
  for (std::size_t k = 0; k < animation.frames.size(); k += 7) {
    const draw::Picture picture = frames.picture(k);
    const Reading reading(picture.marks);
    for (const mechanism::Body& body : mechanism.bodies) {
      const draw::Mark* const line = find_mark(picture, "analog-body-" + body.name);
      ASSERT_NE(line, nullptr) << body.name;
      const std::vector<Vector2d> corners = corners_of(*line);
      ASSERT_EQ(corners.size(), body.points.size());
      for (const mechanism::BodyPoint& point : body.points) {
        const Vector2d place = reading.pixel(animation.analog_frames[k][point.point]);
        const bool met = std::any_of(corners.begin(), corners.end(),
                                     [&](const Vector2d& corner) { return (corner - place).norm() < 0.01; });
        EXPECT_TRUE(met) << body.name << " " << mechanism.points[point.point].name;
      }
    }
    const draw::Mark* const pin = find_mark(picture, "analog-pin-M");
    const std::size_t m = *mechanism.find_point("M");
    EXPECT_LT((std::get<draw::Disc>(pin->shape).centre - reading.pixel(animation.analog_frames[k][m])).norm(),
              0.01);
    EXPECT_EQ(find_mark(picture, "analog-pin-A"), nullptr);  // the frame does not err
  }
}

TEST(AnalogOverlay, IsToldInTheLegend) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/four-bar.toml");
  const draw::Picture picture = draw::draw_linkage(mechanism, with_analog(mechanism).scene);
  std::vector<std::string> texts;
  for (const draw::Mark& mark : picture.marks) {
    if (const auto* const label = std::get_if<draw::Label>(&mark.shape)) texts.push_back(label->text);
  }
  for (const char* text : {"exact", "analog, error ×7", "largest error 0.03 m"})
    EXPECT_THAT(texts, ::testing::Contains(text));
  EXPECT_NE(find_mark(picture, "path-M")->pen.ink, find_mark(picture, "analog-path-M")->pen.ink);
}

// In the SVG its lines bend, in the page too: the numbers are those of the frames.
TEST(AnalogOverlay, BendsInBrowsers) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/four-bar.toml");
  const draw::LinkageAnimation animation = with_analog(mechanism);
  const std::string svg = draw::animated_svg(mechanism, animation, draw::Theme::light);
  const std::regex pattern(
      R"rx(<path id="analog-body-CD"[^>]*>\n<animate attributeName="d" [^>]*values="([^"]*)"/>)rx");
  std::smatch match;
  ASSERT_TRUE(std::regex_search(svg, match, pattern));
  std::istringstream outlines(match[1]);
  std::size_t frame = 0;
  // Without a caption the head has one line, with one it has one too: both pictures are the same.
  const draw::AnimationFrames frames(mechanism, animation);
  for (std::string d; std::getline(outlines, d, ';'); ++frame) {
    std::replace_if(
        d.begin(), d.end(), [](char c) { return c == 'M' || c == 'L' || c == 'Z'; }, ' ');
    std::istringstream numbers(d);
    for (const Vector2d& corner : corners_of(*find_mark(frames.picture(frame), "analog-body-CD"))) {
      double x = 0, y = 0;
      ASSERT_TRUE(numbers >> x >> y);
      EXPECT_LT((corner - Vector2d(x, y)).norm(), 0.0075);  // written to a hundredth
    }
  }
  EXPECT_EQ(frame, animation.frames.size());
  const std::string page = draw::animated_page(mechanism, animation, draw::Theme::light);
  EXPECT_THAT(page, ::testing::HasSubstr("<path data-moves=\"\" id=\"analog-body-CD\""));
  EXPECT_THAT(page, ::testing::HasSubstr("<path data-moves=\"closed\" id=\"analog-body-BC"));
}

TEST(Animation, IsAsWideAsAskedFor) {
  const mechanism::Mechanism mechanism = mechanism::read_mechanism(folder() + "/four-bar.toml");
  draw::LinkageAnimation animation = moving_of(mechanism);
  animation.width = 380;  // half of 760
  EXPECT_THAT(draw::animated_svg(mechanism, animation, draw::Theme::light),
              ::testing::HasSubstr("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"380\" "));
  EXPECT_THAT(draw::animated_page(mechanism, animation, draw::Theme::light),
              ::testing::HasSubstr("max-width: 380px"));
}

}  // namespace
}  // namespace oblique::test
