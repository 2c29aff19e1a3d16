// SPDX-License-Identifier: MIT
#include <oblique/patch/triad_split.h>

#include <algorithm>
#include <array>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/patch/patch.h>
#include <oblique/text/document.h>
#include <oblique/text/file.h>

namespace oblique::patch {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Not;

const std::string kPath = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/class-iii.toml";

/// The shipped triad without what is expected of it, after these changes of its text.
mechanism::Mechanism class_three(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::string text = text::read_file(kPath);
  text.resize(text.find("[expect]"));
  for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
  return mechanism::parse_mechanism(text, "changed.toml");
}

// With a longer O1C a split flips (Split.IsRefusedWhereATriangleTurnsOver), and is worth nothing.
TEST(TriadSplit, ThatIsWorthMoreComesFirst) {
  const mechanism::Mechanism longer = class_three({{"length = 1.945", "length = 2.1"}});
  const mechanism::Structure structure = mechanism::decompose(longer);
  std::vector<double> times;
  for (int degree = 0; degree <= 360; ++degree) times.push_back(degree * std::numbers::pi / 180);
  const auto splits = splits_of(structure.groups.at(1), mechanism::solve_motion(longer, times));
  ASSERT_EQ(splits.size(), 6U);
  for (std::size_t i = 0; i < splits.size(); ++i) {
    const bool flips = splits[i].flip != TriadSplit::Flip::none;
    EXPECT_EQ(splits[i].worth(), flips ? 0 : std::min(splits[i].flattest, splits[i].least_gain)) << i;
    EXPECT_GE(splits[std::max<std::size_t>(i, 1) - 1].worth(), splits[i].worth()) << i;
  }
  EXPECT_GT(splits.front().worth(), 0);
  EXPECT_EQ(splits.back().worth(), 0);
}

// A motion that ends in its own mirror image turns every triangle over: all splits are worth nothing, and
// stand in the order of the legs, so that the same file gives the same list.
TEST(TriadSplit, KeepsTheOrderOfTheLegsWhereNoneIsWorthMore) {
  const mechanism::Mechanism triad = class_three({});
  const mechanism::Structure structure = mechanism::decompose(triad);
  mechanism::Motion motion = mechanism::solve_motion(triad, std::vector<double>{0, 0});
  for (mechanism::PointState& point : motion.configurations[1].points) point.position.y() *= -1;
  std::vector<std::array<std::size_t, 3>> orders;
  for (const TriadSplit& split : splits_of(structure.groups.at(1), motion)) {
    EXPECT_EQ(split.worth(), 0);
    orders.push_back({split.tracked, split.closing, split.third});
  }
  using Order = std::array<std::size_t, 3>;
  EXPECT_THAT(orders, ElementsAre(Order{0, 1, 2}, Order{0, 2, 1}, Order{1, 0, 2}, Order{1, 2, 0},
                                  Order{2, 0, 1}, Order{2, 1, 0}));
}

// A second triad of the same links beside the first, on the same crank: a split named by its legs would be
// that of one.
TEST(TriadSplit, IsOfUseForOneTriadAlone) {
  EXPECT_THAT(useful_splits(class_three({})), Not(IsEmpty()));
  const mechanism::Mechanism two = class_three({{"[drives]", R"(AB2  = { points = ["A", "B2"], length = 1.07 }
BDC2 = { points = ["B2", "D2"], length = 0.665, marks = { C2 = [0.825, -0.581] } }
DE2  = { points = ["D2", "E"], length = 0.757 }
O1C2 = { points = ["O1", "C2"], length = 1.945 }

[drives])"},
                                                {"[sketch]", R"([sketch]
B2 = [1.22, -0.54]
D2 = [1.17, 0.12]
C2 = [1.74, 0.33])"}});
  ASSERT_EQ(mechanism::decompose(two).groups.size(), 3U);
  EXPECT_THAT(useful_splits(two), IsEmpty());
  EXPECT_THAT(useful_splits(mechanism::read_mechanism(std::string(OBLIQUE_SOURCE_DIR) +
                                                      "/diagrams/mechanisms/four-bar.toml")),
              IsEmpty());
}

/// What the setting of a block is.
double setting(const diagram::Diagram& diagram, const std::string& block, const std::string& name) {
  for (const diagram::BlockInstance& instance : diagram.blocks) {
    if (instance.name != block) continue;
    for (const text::Entry& entry : instance.settings) {
      if (entry.key == name) return entry.value.number;
    }
  }
  throw std::out_of_range(block + "." + name);
}

// Both triangles begin where the exact mechanism does. Lengths over that of a leg know of no scale: A–O1 over
// AB of the first triangle, B–E over DE of the second.
TEST(TriadPatch, BeginsWhereTheMechanismDoes) {
  const mechanism::Mechanism triad = class_three({});
  PatchOptions options;
  options.split = {"AB", "O1C", "DE"};
  const diagram::Diagram diagram = patch(triad, options);
  const mechanism::Motion motion = mechanism::solve_motion(triad, std::vector<double>{0});
  const auto at = [&](const char* name) {
    return motion.configurations[0].points[*triad.find_point(name)].position;
  };
  struct Triangle {
    const char *block, *leg;
    double length;
    Eigen::Vector2d from, to, apex;
  };
  for (const Triangle& of : {Triangle{"B", "r1", 1.07, at("A"), at("O1"), at("B")},
                             Triangle{"D", "r2", 0.757, at("B"), at("E"), at("D")}}) {
    const Eigen::Vector2d base = of.to - of.from, side = of.apex - of.from;
    const auto is = [&](const char* name, double expected) {
      // A file's numbers have 15 digits.
      EXPECT_NEAR(setting(diagram, of.block, name), expected, 1e-14) << of.block << "." << name;
    };
    EXPECT_NEAR(setting(diagram, of.block, "start_length") * setting(diagram, of.block, "reach") /
                    setting(diagram, of.block, of.leg),
                base.norm() / of.length, 1e-14);
    is("start_cos", base.x() / base.norm());
    is("start_sin", base.y() / base.norm());
    is("start_angle_cos", base.dot(side) / (base.norm() * side.norm()));
    is("start_angle_sin", std::abs(base.x() * side.y() - base.y() * side.x()) / (base.norm() * side.norm()));
  }
}

}  // namespace
}  // namespace oblique::patch
