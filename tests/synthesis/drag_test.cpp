// SPDX-License-Identifier: MIT
// A dragged point, held by the distances in the file that it comes out with.
#include <oblique/synthesis/drag.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/file.h>

#include "four_bar.h"

namespace oblique::synthesis {
namespace {

using Eigen::Vector2d;
using test::FourBar;
using ::testing::HasSubstr;

/// A mechanism at a moment of its motion [s], and what becomes of a point that is dragged by so much.
struct Case {
  std::string text;
  mechanism::Mechanism mechanism;
  mechanism::Motion motion;

  Case(std::string file, double time)
      : text(std::move(file)),
        mechanism(mechanism::parse_mechanism(text, "m.toml")),
        motion(mechanism::solve_motion(mechanism, std::vector<double>{time})) {}

  const mechanism::Configuration& here() const { return motion.configurations.front(); }
  Vector2d place(const std::string& name) const {
    return here().points[mechanism.find_point(name).value()].position;
  }
  DraggedMechanism dragged(const std::string& name, const Vector2d& way) const {
    const double drive = motion.drives.front().empty() ? 0 : motion.drives.front().front().value;
    return drag(text, mechanism, {mechanism.find_point(name).value(), place(name) + way, drive, here()});
  }
};

/// A text with each of its numbers, and of its quoted texts that have one, as one sign.
std::string without_numbers(const std::string& text) {
  static const std::regex number(R"([-+0-9.]+(e[-+0-9]+)?)");
  std::string out;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream parts(line);
    bool quoted = false;
    for (std::string part; std::getline(parts, part, '"'); quoted = !quoted) {
      const bool has_number =
          std::any_of(part.begin(), part.end(), [](char c) { return c >= '0' && c <= '9'; });
      out += quoted && has_number ? "#" : std::regex_replace(part, number, "#");
    }
    out += '\n';
  }
  return out;
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const text::Error& error) {
    return error.what();
  }
  return {};
}

// Crank 80, coupler 140, rocker 150, frame 200 [mm]; numbers are rounded to 0.01 mm.
TEST(Drag, GivesALinkTheLengthsThatReachTheNewPlaceOfAJoint) {
  const Case before(FourBar{}.text(), 0.01);
  const Vector2d way(-12, 20);
  const DraggedMechanism after = before.dragged("C", way);
  const Vector2d b = before.place("B"), c = before.place("C") + way;
  const double coupler = (c - b).norm(), rocker = (c - Vector2d(200, 0)).norm();
  ASSERT_EQ(after.numbers.size(), 4U);  // and the mark F, in two coordinates along another coupler
  const auto number = [&](const std::string& name) {
    const auto found = std::find_if(after.numbers.begin(), after.numbers.end(),
                                    [&](const ChangedNumber& changed) { return changed.name == name; });
    return found == after.numbers.end() ? std::nan("") : found->after;
  };
  EXPECT_NEAR(number("BCF"), coupler, 0.0051);
  EXPECT_NEAR(number("CD"), rocker, 0.0051);
  // F stays where it is
  const Vector2d f = before.place("F") - b, along = (c - b) / coupler;
  EXPECT_NEAR(number("BCF.F.x"), along.dot(f), 0.0051);
  EXPECT_NEAR(number("BCF.F.y"), along.x() * f.y() - along.y() * f.x(), 0.0051);
  EXPECT_EQ(without_numbers(after.text), without_numbers(before.text));
  EXPECT_THAT(after.text, HasSubstr("# the crank"));
  EXPECT_LT((after.place - c).norm(), 0.02);
  // and the file that comes out stands there at that angle of its crank
  const Case again(after.text, 0.01);
  EXPECT_LT((again.place("C") - c).norm(), 0.02);
  EXPECT_LT((again.place("F") - before.place("F")).norm(), 0.02);
  EXPECT_EQ(after.drive, before.motion.drives.front().front().value);
}

TEST(Drag, TurnsACrankWithItsPin) {
  const Case before(FourBar{}.text(), 0.01);
  const Vector2d to(30, 50);
  const DraggedMechanism after = before.dragged("B", to - before.place("B"));
  ASSERT_EQ(after.numbers.size(), 1U);
  EXPECT_EQ(after.numbers.front().name, "AB");
  EXPECT_NEAR(after.numbers.front().after, to.norm(), 0.0051);
  EXPECT_NEAR(after.drive, std::atan2(50, 30), 1e-12);  // the crank starts at 0
  EXPECT_LT((after.place - to).norm(), 0.01);
}

// The way from one place to the other is turned the short way, whatever the number of turns before.
TEST(Drag, CountsTheTurnsOfACrank) {
  const Case before(FourBar{}.text(), 0.01 + 3 * 2 * std::numbers::pi / 100);
  const DraggedMechanism after = before.dragged("B", Vector2d(30, 50) - before.place("B"));
  EXPECT_NEAR(after.drive, std::atan2(50, 30) + 6 * std::numbers::pi, 1e-9);
}

TEST(Drag, MovesAPivotOfTheFrame) {
  const Case before(FourBar{}.text(), 0.01);
  const DraggedMechanism after = before.dragged("D", {10, -15});
  const Case again(after.text, 0.01);
  EXPECT_LT((again.place("D") - Vector2d(210, -15)).norm(), 0.01);
  EXPECT_LT((again.place("C") - before.place("C")).norm(), 0.02);  // the rocker took the length
}

// The crank keeps its length and its angle, and goes along.
TEST(Drag, TakesTheCrankAlongWithItsPivot) {
  const Case before(FourBar{}.text(), 0.01);
  const DraggedMechanism after = before.dragged("A", {-7, 3});
  ASSERT_EQ(after.numbers.size(), 2U);
  const Case again(after.text, 0.01);
  EXPECT_LT((again.place("B") - before.place("B") - Vector2d(-7, 3)).norm(), 0.02);
}

TEST(Drag, ChangesAMarkAlone) {
  const Case before(FourBar{}.text(), 0.01);
  const DraggedMechanism after = before.dragged("F", {4, 5});
  ASSERT_EQ(after.numbers.size(), 2U);
  const Case again(after.text, 0.01);
  EXPECT_LT((again.place("F") - before.place("F") - Vector2d(4, 5)).norm(), 0.02);
  EXPECT_LT((again.place("C") - before.place("C")).norm(), 1e-9);
}

constexpr const char* kGuided = R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
G = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3 }
[slides]
s = { point = "C", along = ["A", "G"], offset = 0.25 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3, 0]
)";

// It goes to the foot of where it is wanted: y stays 0.25.
TEST(Drag, KeepsASliderOnItsGuide) {
  const Case before(kGuided, 0.5);
  const DraggedMechanism after = before.dragged("C", {0.4, 0.3});
  EXPECT_NEAR(after.place.x(), before.place("C").x() + 0.4, 2e-4);
  EXPECT_NEAR(after.place.y(), 0.25, 1e-12);
  ASSERT_EQ(after.numbers.size(), 1U);
  EXPECT_NEAR(after.numbers.front().after,
              (Vector2d(before.place("C").x() + 0.4, 0.25) - before.place("B")).norm(), 5.1e-5);
}

constexpr const char* kTriangle = R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BCF = { points = ["B", "C", "F"], sides = [3, 2, 2.5], turn = "left" }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3, 3]
)";

TEST(Drag, ChangesTheSidesOfATriangle) {
  const Case before(kTriangle, 0.5);
  const DraggedMechanism after = before.dragged("F", {0.1, 0.2});
  const Case again(after.text, 0.5);
  EXPECT_LT((again.place("F") - before.place("F") - Vector2d(0.1, 0.2)).norm(), 3e-4);
  EXPECT_LT((again.place("C") - before.place("C")).norm(), 1e-9);
  ASSERT_EQ(after.numbers.size(), 2U);
  EXPECT_EQ(after.numbers[0].name, "BCF.sides.2");  // C–F
  EXPECT_NEAR(after.numbers[0].before, 2, 1e-12);
  EXPECT_NEAR(after.numbers[0].after, (before.place("F") + Vector2d(0.1, 0.2) - before.place("C")).norm(),
              1e-4);
  EXPECT_EQ(after.numbers[1].name, "BCF.sides.3");  // B–F
  EXPECT_NEAR(after.numbers[1].before, 2.5, 1e-12);
  const Vector2d over = before.place("C") - before.place("F") + Vector2d(0.3, -1);
  EXPECT_EQ(message_of([&] { before.dragged("F", over); }),
            "m.toml: 'F' cannot be dragged there: the triangle of body 'BCF' would turn over\n"
            "  remedy: change its 'turn' in the file first");
}

TEST(Drag, SaysWhatItCannotDo) {
  const Case four_bar(FourBar{}.text(), 0.01);
  EXPECT_EQ(message_of([&] { four_bar.dragged("C", four_bar.place("B") - four_bar.place("C")); }),
            "m.toml: 'C' cannot be dragged there: body 'BCF' would have no length\n"
            "  remedy: drag it elsewhere");
  EXPECT_EQ(message_of([&] { four_bar.dragged("B", four_bar.place("A") - four_bar.place("B")); }),
            "m.toml: 'B' cannot be dragged there: body 'AB' would have no length\n"
            "  remedy: drag it elsewhere");
  const Case block(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
G = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3 }
CE = { points = ["C", "E"], length = 0.5 }
[slides]
s = { point = "C", along = ["A", "G"], angle = "90 deg", of = "CE" }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
[sketch]
C = [3, 0]
)",
                   0.5);
  EXPECT_EQ(message_of([&] {
              block.dragged("E", {0.1, 0.1});
            }),
            "m.toml: 'E' cannot be dragged: body 'CE' keeps an angle to the line of 's'\n"
            "  remedy: drag another point, or change the numbers of the file");
  const Case pushed(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
G = [1, 0]
[bodies]
AB = { points = ["A", "B"], length = 2 }
BC = { points = ["B", "C"], length = 2 }
[slides]
s = { point = "C", along = ["A", "G"] }
[drives]
push = { slides = "s", speed = 1, start = 2 }
[sketch]
B = [1, 2]
)",
                    0.5);
  EXPECT_EQ(message_of([&] {
              pushed.dragged("C", {0.1, 0});
            }),
            "m.toml: 'C' cannot be dragged to another length: a drive moves it along its line\n"
            "  remedy: lock the lengths, and the drive follows");
}

class Shipped : public ::testing::TestWithParam<std::string> {};

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry :
       std::filesystem::directory_iterator(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms"))
    names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}
INSTANTIATE_TEST_SUITE_P(Mechanisms, Shipped, ::testing::ValuesIn(shipped_names()), [](const auto& tested) {
  std::string name = tested.param;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// Each point by a hundredth of the size: it comes there, in a file that differs in numbers alone; or a
// message says why not.
TEST_P(Shipped, PointsComeToWhereTheyAreDragged) {
  const std::string text =
      text::read_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + GetParam() + ".toml");
  const Case before(text, 0);
  if (before.mechanism.drives.empty()) return;
  const double size = before.mechanism.largest_length();
  int moved = 0, refused = 0;
  for (const mechanism::Point& point : before.mechanism.points) {
    try {
      const DraggedMechanism after = before.dragged(point.name, Vector2d(0.008, 0.006) * size);
      ++moved;
      const std::size_t place = before.mechanism.find_point(point.name).value();
      if (!after.there.points.empty()) {
        EXPECT_EQ(after.there.points[place].position, after.place) << point.name;
      }
      EXPECT_EQ(after.there.points.empty(), before.mechanism.drives.empty()) << point.name;
      EXPECT_EQ(without_numbers(after.text), without_numbers(text)) << point.name;
      const double drive = after.drive - before.mechanism.drives.front().start;
      const bool crank = std::abs(drive) > 1e-12;
      if (crank || before.mechanism.drives.size() > 1) continue;
      const Case again(after.text, 0);
      EXPECT_LT((again.place(point.name) - after.place).norm(), 1e-3 * size) << point.name;
    } catch (const text::Error& error) {
      ++refused;
      EXPECT_THAT(error.what(), ::testing::AnyOf(HasSubstr("dragged"), HasSubstr("cannot be assembled"),
                                                 HasSubstr("depend"), HasSubstr("fitted")))
          << point.name;
    }
  }
  EXPECT_GT(moved, 0);
  RecordProperty("refused", refused);
}

}  // namespace
}  // namespace oblique::synthesis
