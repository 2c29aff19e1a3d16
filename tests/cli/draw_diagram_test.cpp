// SPDX-License-Identifier: MIT
// `oblique draw` on block diagrams: what it writes, and what it refuses.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

const std::string kDiagrams = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/";

class DrawDiagram : public ::testing::Test {
 protected:
  DrawDiagram() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~DrawDiagram() override { std::filesystem::remove_all(folder_); }

  Outcome run(const std::string& command) const { return run_command(command, folder_.string()); }

  std::string text_of(const std::string& name) const {
    std::ifstream stream(folder_ / name);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  void expect_refusal(const std::string& command, const std::string& message) const {
    const Outcome outcome = run(command + " -o x.svg");
    EXPECT_EQ(outcome.status, 2);
    EXPECT_THAT(outcome.err, HasSubstr(message));
    EXPECT_FALSE(std::filesystem::exists(folder_ / "x.svg"));
  }

  std::filesystem::path folder_;
};

TEST_F(DrawDiagram, WritesTheSameSvgEveryTime) {
  const std::string command = "oblique draw " + kDiagrams + "lessons/triangle-side.toml -o ";
  ASSERT_EQ(run(command + "a.svg").status, 0);
  ASSERT_EQ(run(command + "b.svg").status, 0);
  const std::string svg = text_of("a.svg");
  EXPECT_THAT(svg, HasSubstr("id=\"block-c\""));
  EXPECT_THAT(svg, HasSubstr("id=\"net-c.out\""));
  EXPECT_EQ(svg, text_of("b.svg"));
}

TEST_F(DrawDiagram, OpensCompositesAndChangesSymbols) {
  const std::string command = "oblique draw " + kDiagrams + "atlas/class-three-mechanism.toml -o ";
  ASSERT_EQ(run(command + "folded.svg").status, 0);
  ASSERT_EQ(run(command + "open.svg --depth 1").status, 0);
  ASSERT_EQ(run(command + "din.svg --depth 1 --symbols din").status, 0);
  EXPECT_LT(text_of("folded.svg").size(), text_of("open.svg").size());
  EXPECT_NE(text_of("open.svg"), text_of("din.svg"));
}

TEST_F(DrawDiagram, RefusesWhatIsWrong) {
  const std::string diagram = "oblique draw " + kDiagrams + "lessons/circle.toml ";
  const std::string mechanism = "oblique draw " + kDiagrams + "mechanisms/four-bar.toml ";
  expect_refusal(diagram + "--symbols dinn", "--symbols dinn; expected classic or din");
  expect_refusal(diagram + "--symbols dinn", "did you mean 'din'?");
  expect_refusal(diagram + "--at 1", "--at is for mechanisms, and this is a diagram");
  expect_refusal(diagram + "--positions 3", "--positions is for mechanisms, and this is a diagram");
  expect_refusal(diagram + "--trace B", "--trace is for mechanisms, and this is a diagram");
  expect_refusal(diagram + "--plots B", "--plots is for mechanisms, and this is a diagram");
  expect_refusal(mechanism + "--symbols din", "--symbols is for diagrams, and this is a mechanism");
  expect_refusal(mechanism + "--depth 1", "--depth is for diagrams, and this is a mechanism");
  std::ofstream(folder_ / "block.toml") << "format = \"oblique-block/1\"\n";
  expect_refusal("oblique draw block.toml", "this is neither a diagram nor a mechanism");
  std::ofstream(folder_ / "wires.toml")
      << "format = \"oblique-diagram/1\"\n[blocks]\na = { type = \"summer\", in = [\"bb\"] }\n";
  expect_refusal("oblique draw wires.toml", "there is no signal 'bb'");
}

/// Where the shapes of blocks begin in an SVG, by their ids.
std::map<std::string, std::string> shapes_in(const std::string& svg) {
  std::map<std::string, std::string> shapes;
  const std::regex block("<[a-z]+ [^>]*id=\"(block-[^\"]+)\"[^>]*>");
  for (std::sregex_iterator at(svg.begin(), svg.end(), block), end; at != end; ++at)
    shapes[(*at)[1]] = at->str();
  return shapes;
}

// The printed table, put into the file, gives the same picture of the blocks; a number changed in it moves
// one.
TEST_F(DrawDiagram, PrintsItsLayoutForTheFile) {
  const std::string diagram = kDiagrams + "lessons/triangle-side.toml";
  const Outcome printed = run("oblique draw " + diagram + " --layout");
  ASSERT_EQ(printed.status, 0);
  EXPECT_TRUE(printed.out.starts_with("[layout]\nphi  = [")) << printed.out;
  EXPECT_EQ(printed.err, "");
  std::ifstream shipped(diagram);
  const std::string text{std::istreambuf_iterator<char>(shipped), {}};
  std::ofstream(folder_ / "placed.toml") << text << "\n" << printed.out;
  ASSERT_EQ(run("oblique draw " + diagram + " -o free.svg").status, 0);
  ASSERT_EQ(run("oblique draw placed.toml -o placed.svg").status, 0);
  EXPECT_EQ(shapes_in(text_of("free.svg")), shapes_in(text_of("placed.svg")));
  EXPECT_EQ(run("oblique draw placed.toml --layout").out, printed.out);
  std::ofstream(folder_ / "moved.toml") << text << "\n[layout]\nb2 = [4, 4]\na2 = [4, 14]\n";
  ASSERT_EQ(run("oblique draw moved.toml -o moved.svg").status, 0);
  EXPECT_NE(shapes_in(text_of("free.svg")), shapes_in(text_of("moved.svg")));
}

TEST_F(DrawDiagram, RefusesLayoutsThatDoNotFit) {
  const std::string head =
      "format = \"oblique-diagram/1\"\n[blocks]\na = { type = \"sine-source\" }\nb = { type = \"sine\", in = "
      "\"a\" }\n";
  std::ofstream(folder_ / "close.toml") << head << "[layout]\na = [3, 3]\nb = [4, 3]\n";
  expect_refusal("oblique draw close.toml",
                 "close.toml:7:1: 'b' overlaps 'a' or is too close to it in [layout]");
  std::ofstream(folder_ / "unknown.toml") << head << "[layout]\nbb = [3, 3]\n";
  expect_refusal("oblique draw unknown.toml", "unknown.toml:6:1: [layout] gives a place to 'bb'");
  const Outcome mechanism = run("oblique draw " + kDiagrams + "mechanisms/four-bar.toml --layout");
  EXPECT_EQ(mechanism.status, 2);
  EXPECT_THAT(mechanism.err, HasSubstr("--layout is for diagrams, and this is a mechanism"));
  EXPECT_EQ(run("oblique draw close.toml --layout -o x.svg").status, 2);
  EXPECT_EQ(run("oblique draw close.toml --layout --depth 1").status, 2);
}

}  // namespace
}  // namespace oblique::test
