// SPDX-License-Identifier: MIT
// The diagram of the source (AVM class III), and the splits of a triad.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/patch.h>
#include <oblique/patch/triad_split.h>
#include <oblique/solve/run.h>
#include <oblique/text/file.h>

#include "../support/shipped.h"

namespace oblique::patch {
namespace {

using test::shipped;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

PatchOptions paper(double slower = 1000) {
  PatchOptions options;
  options.method = PatchMethod::paper;
  options.slower = slower;
  return options;
}

std::string message(const mechanism::Mechanism& mechanism, const PatchOptions& options) {
  try {
    patch(mechanism, options);
  } catch (const PatchError& error) {
    return error.what();
  }
  return "nothing was thrown";
}

// ψ, γ and α of the four-bar OABO′, ε and β of O′BDE: as the source defines them, from the exact motion.
TEST(Paper, HasTheAnglesOfTheSource) {
  const mechanism::Mechanism mechanism = shipped("class-iii");
  const diagram::Diagram diagram = patch(mechanism, paper());
  const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  const auto result = solve::run(program, flat, solve::options_of(diagram.run));
  const solve::Trajectory& table = result.trajectory;
  std::vector<double> times;
  for (std::size_t row = 0; row < table.rows(); ++row) times.push_back(table.at(row, 0));
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, times);
  const auto point = [&](const char* name) {
    return static_cast<std::size_t>(std::find_if(mechanism.points.begin(), mechanism.points.end(),
                                                 [&](const mechanism::Point& p) { return p.name == name; }) -
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
  const diagram::Diagram diagram = patch(shipped("class-iii"), paper());
  std::vector<std::string> circuits;
  for (const diagram::BlockInstance& block : diagram.blocks) {
    if (block.type == "four-bar-circuit") circuits.push_back(block.name);
  }
  EXPECT_THAT(circuits, ElementsAre("circuit_ABO1", "circuit_O1BDE"));
  EXPECT_THAT(diagram::write_diagram(diagram), HasSubstr("split AB, O1C, DE"));  // the source's
  EXPECT_THAT(diagram::write_diagram(diagram), HasSubstr("# ε + ξ, the direction of BC: ξ = -35.1548°"));
  EXPECT_THAT(diagram::write_diagram(diagram), HasSubstr("# the outer loop, 1000 times slower"));
}

TEST(Paper, RefusesOtherGroups) {
  EXPECT_THAT(
      message(shipped("six-bar"), paper()),
      HasSubstr("is of a kind that the source does not have; expected cranks and triads on three links"));
}

TEST(Split, IsTakenAsNamed) {
  for (const PatchMethod method : {PatchMethod::triangles, PatchMethod::paper}) {
    PatchOptions options;
    options.method = method;
    options.split = {"DE", "AB", "O1C"};
    EXPECT_THAT(diagram::write_diagram(patch(shipped("class-iii"), options)), HasSubstr("split DE, AB, O1C"))
        << method_name(method);
  }
}

TEST(Split, IsRefusedWhereNoTriadHasItsLegs) {
  PatchOptions options;
  options.split = {"AB", "OA", "DE"};
  EXPECT_THAT(message(shipped("class-iii"), options),
              HasSubstr("split AB,OA,DE: no triad has these legs; expected the three legs of a triad in "
                        "any order: AB,"));
  EXPECT_THAT(message(shipped("four-bar"), options),
              HasSubstr("expected a triad on three links, which this mechanism does not have"));
}

TEST(Split, WorthTheMostIsWhatIsChosen) {
  const auto splits = useful_splits(shipped("class-iii"));
  ASSERT_FALSE(splits.empty());
  PatchOptions options;
  options.split = splits.front();
  std::string named = diagram::write_diagram(patch(shipped("class-iii"), options));
  const std::string asked = "This split was asked for.",
                    best =
                        "Of the six splits this one keeps\n# farthest from collinear triangles and from a "
                        "loop without gain.";
  named.replace(named.find(asked), asked.size(), best);
  EXPECT_EQ(named, diagram::write_diagram(patch(shipped("class-iii"))));
}

// The same mechanism with a longer O1C, in which B–D–E passes through a straight line.
mechanism::Mechanism with_longer_leg() {
  const std::string path = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/class-iii.toml";
  std::string text = text::read_file(path);
  const std::string length = "length = 1.945";
  text.replace(text.find(length), length.size(), "length = 2.1");
  text.resize(text.find("[expect]"));
  return mechanism::parse_mechanism(text, "longer.toml");
}

// Twice the area of the triangle B–D–E of the exact motion.
double twice_area(const mechanism::Mechanism& mechanism, double time) {
  const mechanism::Motion exact = mechanism::solve_motion(mechanism, std::vector<double>{0, time});
  const auto at = [&](const char* name) {
    return exact.configurations[1].points[*mechanism.find_point(name)].position;
  };
  const Eigen::Vector2d bd = at("D") - at("B"), be = at("E") - at("B");
  return bd.x() * be.y() - bd.y() * be.x();
}

TEST(Split, IsRefusedWhereATriangleTurnsOver) {
  const mechanism::Mechanism mechanism = with_longer_leg();
  PatchOptions options;
  options.split = {"AB", "O1C", "DE"};
  const std::string text = message(mechanism, options);
  const std::string what =
      "with the split AB, O1C, DE of the triad AB-BDC-DE-O1C, the second triangle becomes collinear and "
      "turns over at t = ";
  ASSERT_THAT(text, HasSubstr(what));
  EXPECT_THAT(
      text,
      HasSubstr(
          "expected triangles that never become collinear and a loop that keeps its sign\n  remedy: split "));
  const double time = std::stod(text.substr(text.find(what) + what.size()));
  const double degree =
      std::numbers::pi / 180;  // the crank's speed is 1 rad/s; ranges are taken half a degree apart
  EXPECT_LT(twice_area(mechanism, time - degree) * twice_area(mechanism, time + degree), 0);
  options.force = true;
  EXPECT_EQ(message(mechanism, options), "nothing was thrown");
}

// A split that is of use is one that is not refused.
TEST(Split, IsOfUseWhereItIsNotRefused) {
  const mechanism::Mechanism mechanism = with_longer_leg();
  const std::vector<std::vector<std::string>> all{{"AB", "O1C", "DE"}, {"AB", "DE", "O1C"},
                                                  {"DE", "AB", "O1C"}, {"DE", "O1C", "AB"},
                                                  {"O1C", "AB", "DE"}, {"O1C", "DE", "AB"}};
  const std::vector<std::vector<std::string>> useful = useful_splits(mechanism);
  for (const auto& split : all) {
    PatchOptions options;
    options.split = split;
    const bool patched = message(mechanism, options) == "nothing was thrown";
    EXPECT_EQ(patched, std::find(useful.begin(), useful.end(), split) != useful.end()) << split.front();
  }
}

// A drive may be called like one of the source's angles.
TEST(Paper, NamesNoTwoOutputsAlike) {
  mechanism::Mechanism mechanism = shipped("class-iii");
  mechanism.drives.front().name = "psi";
  const diagram::Diagram diagram = patch(mechanism, paper());
  EXPECT_NO_THROW(diagram::parse_diagram(diagram::write_diagram(diagram), "psi.toml"));
}

}  // namespace
}  // namespace oblique::patch
