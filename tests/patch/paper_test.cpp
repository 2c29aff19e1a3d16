// SPDX-License-Identifier: MIT
// The diagram of 003_69ea068b7b221c3d.txt, and the splits of a triad.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/motion.h>
#include <oblique/mechanism/read_mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

Mechanism shipped(const std::string& name) {
  return read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name + ".toml");
}

PatchOptions paper(double slower = 1000) {
  PatchOptions options;
  options.method = PatchMethod::paper;
  options.slower = slower;
  return options;
}

std::string message(const Mechanism& mechanism, const PatchOptions& options) {
  try {
    patch(mechanism, options);
  } catch (const PatchError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

// ψ, γ and α of the four-bar OABO′, ε and β of O′BDE: as the source defines them, from the exact motion.
TEST(Paper, HasTheAnglesOfTheSource) {
  const Mechanism mechanism = shipped("class-iii");
  const Diagram diagram = patch(mechanism, paper());
  const BlockLibrary library = BlockLibrary::shipped();
  const FlatDiagram flat = flatten(diagram, library);
  const Program program(assemble(flat));
  const auto result = run(program, flat, options_of(diagram.run));
  const Trajectory& table = result.trajectory;
  std::vector<double> times;
  for (std::size_t row = 0; row < table.rows(); ++row) times.push_back(table.at(row, 0));
  const Motion exact = solve_motion(mechanism, times);
  const auto point = [&](const char* name) {
    return static_cast<std::size_t>(std::find_if(mechanism.points.begin(), mechanism.points.end(),
                                                 [&](const Point& p) { return p.name == name; }) -
                                    mechanism.points.begin());
  };
  for (std::size_t row = 0; row < table.rows(); row += 10) {
    const auto at = [&](const char* name) { return exact.configurations[row].points[point(name)].position; };
    const auto direction = [&](const char* from, const char* to) {
      const Eigen::Vector2d way = at(to) - at(from);
      return std::atan2(way.y(), way.x());
    };
    // 1/μ over the shortest length that a direction is taken from, 0.2 machine units, magnified a few times
    constexpr double kStatic = 3e-5;
    const auto expect_angle = [&](const std::string& name, double angle) {
      EXPECT_NEAR(table.at(row, table.find("cos " + name).value()), std::cos(angle), kStatic) << name << row;
      EXPECT_NEAR(table.at(row, table.find("sin " + name).value()), std::sin(angle), kStatic) << name << row;
    };
    expect_angle("phi", direction("O", "A"));
    const double psi = -direction("O1", "A"), alpha = direction("A", "B");
    expect_angle("psi", psi);
    expect_angle("alpha", alpha);
    expect_angle("gamma", std::numbers::pi - psi - alpha);  // α = 180° − (γ + ψ)
    expect_angle("epsilon", direction("B", "D"));
    expect_angle("beta", direction("E", "D"));
  }
}

TEST(Paper, IsTwoEqualCircuitsAndALoop) {
  const Diagram diagram = patch(shipped("class-iii"), paper());
  std::vector<std::string> circuits;
  for (const BlockInstance& block : diagram.blocks) {
    if (block.type == "four-bar-circuit") circuits.push_back(block.name);
  }
  EXPECT_THAT(circuits, ElementsAre("circuit_ABO1", "circuit_O1BDE"));
  EXPECT_THAT(write_diagram(diagram), HasSubstr("split AB, O1C, DE"));  // the source's
  EXPECT_THAT(write_diagram(diagram), HasSubstr("# ε + ξ, the direction of BC: ξ = -35.1548°"));
  EXPECT_THAT(write_diagram(diagram), HasSubstr("# the outer loop, 1000 times slower"));
}

TEST(Paper, RefusesOtherGroups) {
  EXPECT_THAT(message(shipped("six-bar"), paper()),
              HasSubstr("is not of the source's kind; expected cranks and triads on three links"));
}

TEST(Split, IsTakenAsNamed) {
  for (const PatchMethod method : {PatchMethod::triangles, PatchMethod::paper}) {
    PatchOptions options;
    options.method = method;
    options.split = {"DE", "AB", "O1C"};
    EXPECT_THAT(write_diagram(patch(shipped("class-iii"), options)), HasSubstr("split DE, AB, O1C"))
        << method_name(method);
  }
}

TEST(Split, IsRefusedWhereNoTriadHasItsLeads) {
  PatchOptions options;
  options.split = {"AB", "OA", "DE"};
  EXPECT_THAT(message(shipped("class-iii"), options),
              HasSubstr("--split AB,OA,DE: no triad has these leads; expected the three leads of a triad in "
                        "any order: AB,"));
  EXPECT_THAT(message(shipped("four-bar"), options),
              HasSubstr("expected a triad on three links, which this mechanism has not"));
}

TEST(Split, WorthTheMostIsWhatIsChosen) {
  const auto splits = useful_splits(shipped("class-iii"));
  ASSERT_FALSE(splits.empty());
  PatchOptions options;
  options.split = splits.front();
  std::string named = write_diagram(patch(shipped("class-iii"), options));
  const std::string
      asked = "This split was asked for.",
      best = "Of the six splits this one keeps\n# farthest from flat triangles and from a loop without gain.";
  named.replace(named.find(asked), asked.size(), best);
  EXPECT_EQ(named, write_diagram(patch(shipped("class-iii"))));
}

// The same mechanism with DE a little longer: in some splits a triangle goes flat on the way.
TEST(Split, IsRefusedWhereItFlips) {
  Mechanism mechanism = shipped("class-iii");
  std::vector<std::string> flipping;
  const std::vector<std::vector<std::string>> all{{"AB", "O1C", "DE"}, {"AB", "DE", "O1C"},
                                                  {"DE", "AB", "O1C"}, {"DE", "O1C", "AB"},
                                                  {"O1C", "AB", "DE"}, {"O1C", "DE", "AB"}};
  for (const auto& split : all) {
    PatchOptions options;
    options.split = split;
    const std::string text = message(mechanism, options);
    if (text != "nothing was thrown") flipping.push_back(text);
  }
  EXPECT_EQ(flipping.size() + useful_splits(mechanism).size(), all.size());
}

}  // namespace
}  // namespace oblique
