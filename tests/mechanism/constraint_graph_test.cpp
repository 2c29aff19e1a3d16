// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/constraint_graph.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "mechanism_text.h"

namespace oblique::mechanism {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

const std::string kFourBar = R"([frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
)";
const std::string kCrank = R"([drives]
crank = { turns = "AB", about = "A", speed = 1 }
)";

/// The names of links and points, of the frame too, that these vertices are.
std::vector<std::string> names(const Mechanism& mechanism, const ConstraintGraph& graph,
                               const std::vector<std::size_t>& vertices) {
  std::vector<std::string> found;
  for (const std::size_t v : vertices)
    found.push_back(graph.is_body(v) ? mechanism.bodies[v].name : mechanism.points[graph.point_of(v)].name);
  return found;
}

// The crank and its pin, then the dyad with its joint. A and D are of the frame, and depend on nothing.
TEST(ConstraintGraph, TakesApartWhatMovesAndNothingOfTheFrame) {
  const Mechanism four = mechanism(kFourBar + kCrank);
  const ConstraintGraph graph(four);
  EXPECT_EQ(graph.freedom(), 0);
  EXPECT_THAT(graph.redundant(), IsEmpty());
  EXPECT_THAT(graph.movable(), IsEmpty());
  std::vector<std::vector<std::string>> components;
  for (const auto& component : graph.components()) components.push_back(names(four, graph, component));
  EXPECT_THAT(components,
              ElementsAre(ElementsAre("AB"), ElementsAre("B"), UnorderedElementsAre("BC", "CD", "C")));
}

TEST(ConstraintGraph, MovesAsAWholeWithoutItsDrive) {
  const Mechanism four = mechanism(kFourBar);
  const ConstraintGraph graph(four);
  EXPECT_EQ(graph.freedom(), 1);
  EXPECT_THAT(names(four, graph, graph.movable()), UnorderedElementsAre("AB", "BC", "CD", "B", "C"));
}

// A second drive is too much, and competes with everything that moves.
TEST(ConstraintGraph, KnowsWhoCompetesForWhatIsTooMuch) {
  const Mechanism four =
      mechanism(kFourBar + kCrank + "rocker = { turns = \"CD\", about = \"D\", speed = 1 }\n");
  const ConstraintGraph graph(four);
  ASSERT_EQ(graph.redundant().size(), 1U);
  EXPECT_THAT(names(four, graph, graph.competitors(graph.redundant()[0])),
              UnorderedElementsAre("AB", "BC", "CD", "B", "C"));
}

}  // namespace
}  // namespace oblique::mechanism
