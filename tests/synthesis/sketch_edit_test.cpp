// SPDX-License-Identifier: MIT
#include <oblique/synthesis/sketch_edit.h>

#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

namespace oblique::synthesis {
namespace {

constexpr const char* kHead = R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BCF = { points = ["B", "C"], length = 3, marks = { F = [1, 1] } }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)";

std::string edited(const std::string& rest,
                   const std::vector<std::pair<std::string, Eigen::Vector2d>>& points, NewPoints new_points) {
  const std::string text = kHead + rest;
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "m.toml");
  std::vector<mechanism::SketchPoint> sketch;
  for (const auto& [name, at] : points) sketch.push_back({mechanism.find_point(name).value(), at});
  const std::string result = with_sketch(text, mechanism, sketch, new_points);
  EXPECT_TRUE(result.starts_with(kHead));
  const mechanism::Mechanism again = mechanism::parse_mechanism(result, "m.toml");  // it is a file still
  EXPECT_LE(again.sketch.size(), mechanism.sketch.size() + points.size());
  return result.substr(std::string(kHead).size());
}

TEST(SketchEdit, ReplacesWhatIsThereAndLeavesTheRest) {
  EXPECT_EQ(edited("[sketch]   # rough\nF = [2, 1]\nC = [ 3, 2.5 ] # there\n",
                   {{"C", {1.25, -3}}, {"B", {0, 1}}}, NewPoints::leave_out),
            "[sketch]   # rough\nF = [2, 1]\nC = [ 1.25, -3 ] # there\n");
}

TEST(SketchEdit, AddsPointsAtTheEndOfTheSketch) {
  EXPECT_EQ(edited("[sketch]\nC = [3, 2]  # there\n[motion]\nuntil = 2\n", {{"F", {1, 2}}, {"C", {5, 6}}},
                   NewPoints::add),
            "[sketch]\nC = [5, 6]  # there\nF = [1, 2]\n[motion]\nuntil = 2\n");
}

TEST(SketchEdit, AddsPointsWithinBraces) {
  EXPECT_EQ(edited("", {{"C", {1, 2}}}, NewPoints::add), "\n[sketch]\nC = [1, 2]\n");
  const std::string braces = "title = \"t\"\nsketch = { C = [1, 2] }\n";
  const std::string text = "format = \"oblique-mechanism/1\"\n" + braces + std::string(kHead).substr(31);
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "m.toml");
  const std::string result =
      with_sketch(text, mechanism, {{mechanism.find_point("F").value(), {7, 8}}}, NewPoints::add);
  EXPECT_NE(result.find("sketch = { C = [1, 2], F = [7, 8] }\n"), std::string::npos) << result;
}

TEST(SketchEdit, FillsAnEmptySketchAndMakesOneWhereThereIsNone) {
  EXPECT_EQ(edited("[sketch]  # nothing yet\n[motion]\nuntil = 2\n", {{"C", {1, 2}}}, NewPoints::add),
            "[sketch]  # nothing yet\nC = [1, 2]\n[motion]\nuntil = 2\n");
  EXPECT_EQ(edited("[motion]\nuntil = 2", {{"C", {1, 2}}}, NewPoints::add),
            "[motion]\nuntil = 2\n\n[sketch]\nC = [1, 2]\n");
}

TEST(SketchEdit, ChangesKeysWithDots) {
  const std::string head = "format = \"oblique-mechanism/1\"\n";
  const std::string text = head + "sketch.C = [1, 2]\n" + std::string(kHead).substr(head.size());
  const mechanism::Mechanism mechanism = mechanism::parse_mechanism(text, "m.toml");
  const std::string result =
      with_sketch(text, mechanism,
                  {{mechanism.find_point("F").value(), {7, 8}}, {mechanism.find_point("C").value(), {3, 4}}},
                  NewPoints::add);
  EXPECT_TRUE(result.starts_with(head + "sketch.C = [3, 4]\nsketch.F = [7, 8]\n[frame]\n")) << result;
}

TEST(SketchEdit, EndsLinesAsTheFileDoes) {
  EXPECT_EQ(edited("[sketch]\r\nC = [3, 2]\r\n", {{"F", {1, 2}}}, NewPoints::add),
            "[sketch]\r\nC = [3, 2]\r\nF = [1, 2]\r\n");
}

}  // namespace
}  // namespace oblique::synthesis
