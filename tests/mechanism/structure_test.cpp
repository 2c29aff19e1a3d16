// SPDX-License-Identifier: MIT
#include <oblique/mechanism/structure/structure.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>

#include "mechanism_text.h"

namespace oblique::mechanism {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

Mechanism shipped(const std::string& name) {
  return read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name);
}

std::vector<std::string> names(const Structure& structure) {
  std::vector<std::string> all;
  for (const Group& group : structure.groups) all.push_back(group.name);
  return all;
}

/// Kind and text of what `find_groups` says.
std::pair<MechanismError::Kind, std::string> refusal(const std::string& body) {
  try {
    find_groups(mechanism(body));
  } catch (const MechanismError& error) {
    return {error.kind(), error.what()};
  }
  return {MechanismError::Kind::file, "not refused"};
}

// A four-bar ABCD with marks K and E on its coupler and rocker, a dyad E–G–H behind the rocker and another
// C–F–K on the four-bar: eight bars with the frame. The links stand in the file in the reverse of the order
// of motion.
const std::string kEightBar = R"([frame]
A = [0, 0]
D = [4, 0]
H = [12, 0]
[bodies]
GH  = { points = ["G", "H"], length = 4 }
EG  = { points = ["E", "G"], length = 4 }
FC  = { points = ["F", "C"], length = 3 }
FK  = { points = ["F", "K"], length = 5 }
BC  = { points = ["B", "C"], length = 3.5, marks = { K = [1, 1] } }
CD  = { points = ["C", "D"], length = 3, marks = { E = [-1, 2] } }
AB  = { points = ["A", "B"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)";

TEST(Mobility, CountsRevoluteJointsOfSeveralBodiesAndTheFrame) {
  EXPECT_EQ(mobility(shipped("four-bar.toml")), 1);
  EXPECT_EQ(mobility(shipped("six-bar.toml")), 1);
  EXPECT_EQ(mobility(shipped("jansen.toml")),
            1);  // 13 links, 19 revolute joints: O2 is four of them, P6 and Q6 two each
  EXPECT_EQ(
      mobility(mechanism("[frame]\nA = [0, 0]\n[bodies]\nAB = { points = [\"A\", \"B\"], length = 1 }")), 1);
  EXPECT_EQ(
      mobility(mechanism("[frame]\nA = [0, 0]\n[bodies]\nBC = { points = [\"B\", \"C\"], length = 1 }")), 3);
}

TEST(Structure, TakesAFourBarApart) {
  const Mechanism four_bar = shipped("four-bar.toml");
  const Structure structure = decompose(four_bar);
  EXPECT_THAT(names(structure), ElementsAre("AB", "BCM-CD"));
  EXPECT_EQ(structure.groups[0].form.kind, GroupKind::crank);
  EXPECT_EQ(structure.groups[0].assur_class, 1);
  EXPECT_EQ(four_bar.points[pivot_of(structure.groups[0])].name, "A");
  EXPECT_EQ(structure.groups[1].assur_class, 2);
  EXPECT_EQ(structure.groups[1].order, 2);
  const Dyad dyad = structure.groups[1].form.dyad.value();
  EXPECT_EQ(four_bar.points[dyad.p].name, "B");
  EXPECT_EQ(four_bar.points[dyad.q].name, "D");
  EXPECT_EQ(four_bar.points[dyad.c].name, "C");
  EXPECT_EQ(dyad.r1, 3.5);
  EXPECT_EQ(dyad.r2, 3);
  EXPECT_EQ(structure.groups[1].side, 1);
  EXPECT_THAT(structure.groups[1].bodies, ElementsAre(1U, 2U));
}

// By the pairs of each group, as its drawing in the file shows them.
TEST(GroupForm, SaysHowEachGroupIsPlaced) {
  struct Case {
    const char* file;
    GroupKind kind;
    Placing placing;
    std::size_t circles;
  };
  for (const auto& [file, kind, placing, circles] :
       {Case{"four-bar.toml", GroupKind::rrr, Placing::triangle, 2},
        Case{"slider-crank.toml", GroupKind::rrp, Placing::crossing, 1},
        Case{"whitworth.toml", GroupKind::rpr, Placing::about_pivot, 0},
        Case{"oldham.toml", GroupKind::rpp, Placing::crossing, 0},
        Case{"class-iii.toml", GroupKind::triad, Placing::platform, 3},
        Case{"class-iii-guided.toml", GroupKind::triad, Placing::platform, 1},
        Case{"class-iv.toml", GroupKind::general, Placing::iteration, 0}}) {
    SCOPED_TRACE(file);
    const Structure structure = find_groups(shipped(file));
    EXPECT_EQ(structure.groups.at(0).form.placing, Placing::rotation);
    const GroupForm& form = structure.groups.at(1).form;
    EXPECT_EQ(form.kind, kind);
    EXPECT_EQ(form.placing, placing);
    EXPECT_EQ(form.circles, circles);
    EXPECT_EQ(form.is_triad_on_links(), circles == 3);
    EXPECT_EQ(form.dyad.has_value(), placing == Placing::triangle);
  }
}

TEST(Structure, TakesAnEightBarApartWhateverTheOrderOfItsBodies) {
  EXPECT_THAT(names(find_groups(mechanism(kEightBar))), ElementsAre("AB", "BC-CD", "GH-EG", "FC-FK"));
}

TEST(Structure, TakesBothLegsOfJansenApart) {
  EXPECT_THAT(names(decompose(shipped("jansen.toml"))),
              ElementsAre("crank", "rod_j-upper", "rod_k-rod_c", "rod_f-lower", "rod_j2-upper2",
                          "rod_k2-rod_c2", "rod_f2-lower2"));
}

TEST(Structure, ChainsDrives) {
  const Structure robot = decompose(mechanism(R"([frame]
A = [0, 0]
[bodies]
hand = { points = ["C", "B"], length = 1 }
arm  = { points = ["A", "B"], length = 2 }
[drives]
wrist    = { turns = "hand", about = "B", speed = 2 }
shoulder = { turns = "arm", about = "A", speed = 1 }
)"));
  EXPECT_THAT(names(robot), ElementsAre("arm", "hand"));
  EXPECT_THAT(robot.groups[1].drives, ElementsAre(0U));
}

TEST(Structure, IsRefusedWhenUnderDriven) {
  const auto [kind, text] = refusal(R"([frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "c"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)");
  EXPECT_EQ(kind, MechanismError::Kind::mobility);
  EXPECT_THAT(
      text,
      AllOf(
          HasSubstr(
              "test.toml:10:1: the mechanism has mobility 3 (3·3 bodies − 2·3 revolute joints) but 1 drive"),
          HasSubstr("under-driven: add drives"), HasSubstr("no joint at c, C")));
}

TEST(Structure, IsRefusedWhenOverDriven) {
  const auto [kind, text] = refusal(R"([frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank  = { turns = "AB", about = "A", speed = 1 }
rocker = { turns = "CD", about = "D", speed = 1 }
)");
  EXPECT_EQ(kind, MechanismError::Kind::mobility);
  EXPECT_THAT(text, AllOf(HasSubstr("mobility 1"), HasSubstr("but 2 drives"), HasSubstr("over-driven")));
}

TEST(Structure, IsRefusedWhenOneBodyIsTooMuchAndAnotherIsFree) {
  const auto [kind, text] = refusal(R"([frame]
A = [0, 0]
D = [4, 0]
G = [2, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { M = [1, 1] } }
CD = { points = ["C", "D"], length = 3 }
GM = { points = ["G", "M"], length = 1 }
CX = { points = ["C", "X"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)");
  EXPECT_EQ(kind, MechanismError::Kind::mobility);
  EXPECT_THAT(
      text,
      AllOf(
          HasSubstr("test.toml:10:1: body 'GM' is over-constrained"),
          HasSubstr("its revolute joint at 'M' is superfluous, since bodies 'AB', 'BC', 'CD' fix it already"),
          HasSubstr("test.toml:11:1: body 'CX' can move freely (mobility 1 after the drives)")));
}

// The four-bar stands still without K, which has 3 freedoms and 6 conditions: three too many, of two revolute
// joints.
TEST(Structure, TellsOfARevoluteJointThatIsTooMuchOnce) {
  const auto [kind, text] = refusal(R"([frame]
A = [0, 0]
D = [4, 0]
G = [2, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { M = [1, 1] } }
CD = { points = ["C", "D"], length = 3, marks = { N = [1, 1] } }
K  = { points = ["G", "M"], length = 1, marks = { N = [1, 1] } }
FX = { points = ["F", "X"], length = 1 }
[drives]
crank = { turns = "AB", about = "A", speed = 1 }
)");
  EXPECT_EQ(kind, MechanismError::Kind::mobility);
  for (const std::string revolute :
       {"its revolute joint at 'M' is superfluous", "its revolute joint at 'N' is superfluous"}) {
    EXPECT_NE(text.find(revolute), std::string::npos) << text;
    EXPECT_EQ(text.find(revolute), text.rfind(revolute)) << text;
  }
}

// The drive pushes the bar's end A across: what is left of it follows in closed form.
TEST(Structure, KnowsADrivenSlider) {
  const Structure trammel = find_groups(shipped("elliptical-trammel-by-slide.toml"));
  EXPECT_EQ(trammel.groups.at(0).form.kind, GroupKind::slider);
  EXPECT_EQ(trammel.groups.at(1).form.kind, GroupKind::rrp);
}

// Two blocks pinned to each other at P, one in a slot of the crank and one in a slot of the frame; the yoke
// has a slot of its own.
TEST(Structure, TellsAPinInTwoSlotsFromAYoke) {
  const Structure pin = find_groups(mechanism(R"([frame]
A = [0, 0]
D = [0, 3]
E = [9, 3]
[bodies]
AB = { points = ["A", "B"], length = 5 }
S = { points = ["P", "K"], length = 1 }
T = { points = ["P", "L"], length = 1 }
[slides]
ray  = { point = "K", along = ["A", "B"], of = "S", angle = "0 deg" }
line = { point = "L", along = ["D", "E"], of = "T", angle = "0 deg" }
[drives]
crank = { turns = "AB", about = "A", speed = 1, start = "45 deg" }
)"));
  ASSERT_EQ(pin.groups.size(), 2U);
  EXPECT_EQ(pin.groups[1].form.kind, GroupKind::prp);
  const Structure yoke = find_groups(shipped("scotch-yoke.toml"));
  EXPECT_EQ(yoke.groups.at(1).form.kind, GroupKind::rpp);
}

// Four links in a closed loop, of which one is pinned to the crank and one to the frame (Artobolevsky calls a
// group by the number of pairs in the loop of most pairs, where no link has more).
TEST(Structure, KnowsAGroupOfClassIV) {
  const Structure structure = decompose(shipped("class-iv.toml"));
  ASSERT_THAT(names(structure), ElementsAre("HG", "ABE-BC-EF-CFG"));
  EXPECT_EQ(structure.groups[1].assur_class, 4);
  EXPECT_EQ(structure.groups[1].order, 2);
  EXPECT_EQ(structure.groups[1].side, 0);  // it may have more than two modes
}

// The ternary link BCD on three legs, one of them from the crank OA (method: AVM class III).
TEST(Structure, KnowsATriad) {
  const Structure triad = find_groups(mechanism(R"([frame]
O = [0, 0]
P = [0, 1.2]
E = [1.46, 0.824]
[bodies]
OA  = { points = ["O", "A"], length = 0.3 }
AB  = { points = ["A", "B"], length = 1.07 }
BCD = { points = ["B", "D"], length = 0.665, marks = { C = [0.825, -0.581] } }
DE  = { points = ["D", "E"], length = 0.757 }
PC  = { points = ["P", "C"], length = 1.945 }
[drives]
crank = { turns = "OA", about = "O", speed = 1 }
)"));
  EXPECT_THAT(names(triad), ElementsAre("OA", "AB-BCD-DE-PC"));
  EXPECT_EQ(triad.groups[1].form.kind, GroupKind::triad);
  EXPECT_EQ(triad.groups[1].assur_class, 3);
  EXPECT_EQ(triad.groups[1].order, 3);
}

// The drive gives the direction of the coupler, whose place follows only with its neighbours.
TEST(Structure, KnowsADriveInsideAGroup) {
  const Structure structure = find_groups(mechanism(R"([frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5 }
CD = { points = ["C", "D"], length = 3 }
[drives]
push = { turns = "BC", about = "B", speed = 1 }
)"));
  EXPECT_THAT(names(structure), ElementsAre("AB-BC-CD"));
  EXPECT_EQ(structure.groups[0].form.kind, GroupKind::general);
  EXPECT_THAT(structure.groups[0].drives, ElementsAre(0U));
}

}  // namespace
}  // namespace oblique::mechanism
