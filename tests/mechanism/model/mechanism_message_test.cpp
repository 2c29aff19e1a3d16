// SPDX-License-Identifier: MIT
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/mechanism/model/read_mechanism.h>

#include "four_bar_file.h"

namespace oblique::mechanism {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

struct BadFile {
  std::string name;
  std::string line;  ///< of kFourBar
  std::string replacement;
  std::vector<std::string> says;
};

void PrintTo(const BadFile& bad, std::ostream* out) {
  *out << bad.name;
}

class MechanismReaderMessage : public ::testing::TestWithParam<BadFile> {};

TEST_P(MechanismReaderMessage, NamesPlaceFaultAndRemedy) {
  const std::string text = message(with(GetParam().line, GetParam().replacement));
  for (const std::string& part : GetParam().says) EXPECT_THAT(text, HasSubstr(part));
}

const std::string kBC = R"(BC = { points = ["B", "C"], length = 3.5, marks = { M = [1.75, 1] } })";
const std::string kCD = R"(CD = { points = ["C", "D"], length = 3 })";

INSTANTIATE_TEST_SUITE_P(
    Files, MechanismReaderMessage,
    ::testing::Values(
        BadFile{"Format",
                "oblique-mechanism/1",
                "oblique-diagram/1",
                {"bad.toml:1:10:", "the format is 'oblique-diagram/1'"}},
        BadFile{"UnknownTable",
                "[sketch]",
                "[sketsh]",
                {"bad.toml:13:", "unknown key 'sketsh'", "did you mean 'sketch'?"}},
        BadFile{"UnknownKey",
                kCD,
                R"(CD = { points = ["C", "D"], lenght = 3 })",
                {"bad.toml:10:29:", "unknown key 'lenght' in body 'CD'", "did you mean 'length'?",
                 "has no 'length'"}},
        BadFile{"LengthUnit",
                R"(length = "m")",
                R"(length = "cmm")",
                {"bad.toml:3:", "'cmm' is no unit of length", "did you mean 'cm'?"}},
        BadFile{"UnitOfTime", R"(length = "m")", R"(length = "s")", {"'s' is no unit of length"}},
        BadFile{"ZeroLength",
                kCD,
                R"(CD = { points = ["C", "D"], length = 0 })",
                {"bad.toml:10:38:", "'length' of body 'CD' is 0; expected a length above 0"}},
        BadFile{"NegativeLength",
                kCD,
                R"(CD = { points = ["C", "D"], length = -3 })",
                {"'length' of body 'CD' is -3"}},
        BadFile{"InfiniteLength",
                kCD,
                R"(CD = { points = ["C", "D"], length = "inf" })",
                {"bad.toml:10:", "'length' of body 'CD' is inf"}},
        BadFile{"WrongUnit",
                kCD,
                R"(CD = { points = ["C", "D"], length = "3 rad" })",
                {"bad.toml:10:", "'rad' is the wrong unit here"}},
        BadFile{"NoTable", kCD, "CD = 3", {"bad.toml:10:", "body 'CD' is a number", "a table"}},
        BadFile{"NoPoints", kCD, "CD = { length = 3 }", {"body 'CD' has no 'points'"}},
        BadFile{"OnePoint",
                kCD,
                R"(CD = { points = ["D"], length = 3 })",
                {"body 'CD' has 1 points; expected two or three"}},
        BadFile{"FourPoints",
                kCD,
                R"(CD = { points = ["C", "D", "E", "F"], length = 3 })",
                {"has 4 points", "marks"}},
        BadFile{"PointTwice",
                kCD,
                R"(CD = { points = ["C", "C"], length = 3 })",
                {"body 'CD' names point 'C' twice"}},
        BadFile{"MarkTwice",
                kCD,
                R"(CD = { points = ["C", "D"], length = 3, marks = { D = [1, 1] } })",
                {"names point 'D' twice"}},
        BadFile{"MarkOnPoint",
                kCD,
                R"(CD = { points = ["C", "D"], length = 3, marks = { E = [3, 0] } })",
                {"points 'D' and 'E' of body 'CD' lie in the same place"}},
        BadFile{"MarkNotAPair",
                kCD,
                R"(CD = { points = ["C", "D"], length = 3, marks = { E = [3] } })",
                {"mark 'E' of body 'CD' is not a pair of numbers"}},
        BadFile{"PointName",
                kCD,
                R"(CD = { points = ["C", "4D"], length = 3 })",
                {"'4D' is no name for a point"}},
        BadFile{"BodyName",
                kCD,
                R"("C-D" = { points = ["C", "D"], length = 3 })",
                {"'C-D' is no name for a body"}},
        BadFile{"SidesOfABar",
                kCD,
                R"(CD = { points = ["C", "D"], sides = [3, 4, 5] })",
                {"'sides' and 'turn' are for three"}},
        BadFile{"LengthOfATriangle",
                kCD,
                R"(CD = { points = ["C", "D", "E"], length = 3 })",
                {"has three points and a 'length'", "has three points and no 'sides'",
                 "has three points and no 'turn'"}},
        BadFile{"TriangleInequality",
                kCD,
                R"(CD = { points = ["C", "D", "E"], sides = [1, 2, 4], turn = "left" })",
                {"bad.toml:10:", "sides 1, 2 and 4 of body 'CD' make no triangle", "|C D|, |D E|, |E C|"}},
        BadFile{"TwoSides",
                kCD,
                R"(CD = { points = ["C", "D", "E"], sides = [1, 2], turn = "left" })",
                {"are not three lengths"}},
        BadFile{"NegativeSide",
                kCD,
                R"(CD = { points = ["C", "D", "E"], sides = [3, -4, 5], turn = "left" })",
                {"side 2 of body 'CD' is -4; expected a length above 0"}},
        BadFile{"Turn",
                kCD,
                R"(CD = { points = ["C", "D", "E"], sides = [3, 4, 5], turn = "up" })",
                {R"('turn' of body 'CD' is "up"; expected "left" or "right")"}},
        BadFile{"TwoFramePoints",
                kCD,
                R"(CD = { points = ["A", "D"], length = 3 })",
                {"body 'CD' is held by two points of the frame, 'A' and 'D', and cannot move"}},
        BadFile{"SharedPoints",
                kCD,
                R"(CD = { points = ["C", "B"], length = 3 })",
                {"bodies 'BC' and 'CD' share the points 'C' and 'B'"}},
        BadFile{"BodyAndPoint",
                kCD,
                R"(C = { points = ["C", "D"], length = 3 })",
                {"'C' is the name of a body and of a point"}},
        BadFile{"DriveAndPoint",
                kCrank,
                R"(B = { turns = "AB", about = "A", speed = 1 })",
                {"'B' is the name of a drive and of a point"}},
        BadFile{"DriveCalledT",
                kCrank,
                R"(t = { turns = "AB", about = "A", speed = 1 })",
                {"a drive cannot be called 't'"}},
        BadFile{"FramePoint",
                "D = [4, 0]",
                "D = 4",
                {"bad.toml:6:", "frame point 'D' is not a pair of numbers; expected [x, y]"}},
        BadFile{"InfinitePoint", "D = [4, 0]", R"(D = ["inf", 0])", {"frame point 'D' is infinite"}},
        BadFile{"DrivenBody",
                kCrank,
                R"(crank = { turns = "ABB", about = "A", speed = 1 })",
                {"bad.toml:12:", "drive 'crank' turns 'ABB', which is no body", "did you mean 'AB'?"}},
        BadFile{"DrivePoint",
                kCrank,
                R"(crank = { turns = "AB", about = "D", speed = 1 })",
                {"turns about 'D', which is no point of body 'AB'", "known: A, B"}},
        BadFile{"SpeedZero",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = 0 })",
                {"drive 'crank' has speed zero and never turns"}},
        BadFile{"SpeedUnit",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = "3 1/s" })",
                {"'1/s' is the wrong unit here"}},
        BadFile{
            "NoSpeed", kCrank, R"(crank = { turns = "AB", about = "A" })", {"drive 'crank' has no 'speed'"}},
        BadFile{"InfiniteStart",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = 1, start = "inf" })",
                {"starts at inf"}},
        BadFile{"DrivenTwice",
                kCrank,
                kCrank + "\n" + R"(other = { turns = "AB", about = "A", speed = 1 })",
                {"bad.toml:13:", "body 'AB' is turned by drive 'crank' already"}},
        BadFile{"SlideWithoutPoint",
                "[sketch]",
                R"([slides]
s = { along = ["B", "C"] }
[sketch])",
                {R"(slide 's' has no 'point')"}},
        BadFile{"SlideOfNoPoint",
                "[sketch]",
                R"([slides]
s = { point = "d", along = ["B", "C"] }
[sketch])",
                {R"(slide 's' moves 'd', which is no point)"}},
        BadFile{"SlideWithoutLine",
                "[sketch]",
                R"([slides]
s = { point = "D" }
[sketch])",
                {R"(slide 's' has no line of two points)"}},
        BadFile{"SlideAlongNoPoint",
                "[sketch]",
                R"([slides]
s = { point = "D", along = ["B", "X"] }
[sketch])",
                {R"(slide 's' slides along 'X', which is no point)"}},
        BadFile{"SlideAlongNoBody",
                "[sketch]",
                R"([slides]
s = { point = "D", along = ["A", "C"] }
[sketch])",
                {R"(no body has both 'A' and 'C', so they give no line)"}},
        BadFile{"SlideOnItsOwnBody",
                "[sketch]",
                R"([slides]
s = { point = "C", along = ["B", "C"] }
[sketch])",
                {R"('C' is a point of 'BC', which carries the line, and cannot slide on it)"}},
        BadFile{"SlideInTheFrame",
                "[sketch]",
                R"([slides]
s = { point = "A", along = ["A", "D"] }
[sketch])",
                {R"('A' and the line are both fixed in the frame)"}},
        BadFile{"SlideOfTwoBodies",
                "[sketch]",
                R"([slides]
s = { point = "C", along = ["A", "D"], angle = 0 }
[sketch])",
                {R"(slide 's' has an angle, and not one body alone has the point 'C')"}},
        BadFile{"SlideOfNoBody",
                "[sketch]",
                R"([slides]
s = { point = "C", along = ["A", "D"], angle = 0, of = "AB" }
[sketch])",
                {R"(slide 's' guides 'AB', which is no body with the point 'C')"}},
        BadFile{"SlideWithoutAngle",
                "[sketch]",
                R"([slides]
s = { point = "C", along = ["A", "D"], of = "BC" }
[sketch])",
                {R"(slide 's' names a body and no 'angle')"}},
        BadFile{"DriveOfNoSlide",
                kCrank,
                R"(crank = { slides = "s", speed = "20 mm/s" })",
                {R"(drive 'crank' moves 's', which is no slide)"}},
        BadFile{"LawOfAnotherName",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = "1 + sin(time*w) rad/s" })",
                {R"(there is no 'w' in the speed of a drive)"}},
        BadFile{"LawWithAKink",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = "1 + abs(time) rad/s" })",
                {R"(the speed of a drive may have no kinks or jumps)"}},
        BadFile{"LawWithoutValueAtTheStart",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = "1/time rad/s" })",
                {R"(drive 'crank' has speed inf at t = 0)"}},
        BadFile{"LawInAnotherUnit",
                kCrank,
                R"(crank = { turns = "AB", about = "A", speed = "1 + time mm/s" })",
                {R"('mm/s' is the wrong unit here)"}},
        BadFile{
            "MotionWithoutEnd", "[sketch]", "[motion]\nuntil = 0\n[sketch]", {"'until' of [motion] is 0"}},
        BadFile{"MotionAtNoLimit",
                "[sketch]",
                "[motion]\nat_limit = \"bounce\"\n[sketch]",
                {R"(expected "open", "stop" or "reverse")"}},
        BadFile{"ExpectWithoutMoment",
                "[sketch]",
                "[expect]\n\"C.x\" = { value = 1, within = 1 }\n[sketch]",
                {"[expect] cannot read 'C.x'"}},
        BadFile{"ExpectAtNoMoment",
                "[sketch]",
                "[expect]\n\"C.x at 3 mm\" = { value = 1, within = 1 }\n[sketch]",
                {"[expect] cannot read '3 mm' of 'C.x at 3 mm'"}},
        BadFile{"NegativeMass",
                kBC,
                R"(BC = { points = ["B", "C"], length = 3, mass = -1 })",
                {"'mass' of body 'BC' is -1"}},
        BadFile{"SketchedPoint",
                "C = [3.5, 2.9]",
                "c1 = [3.5, 2.9]\nBB = [0, 0]",
                {"bad.toml:14:", "[sketch] places 'c1', which is no point"}}),
    [](const auto& test) { return test.param.name; });

TEST(MechanismReader, ReportsAllFindingsInOneGo) {
  std::string text = with(kCD, R"(CD = { points = ["C", "D"], length = -3 })");
  text.replace(text.find(kBC), kBC.size(), R"(BC = { points = ["B", "C"], lenght = 3 })");
  text.replace(text.find("about = \"A\""), 11, "about = \"X\"");
  try {
    parse_mechanism(text, "bad.toml");
    FAIL();
  } catch (const MechanismError& error) {
    // an unknown key and a missing one in BC, a length, a point
    ASSERT_EQ(error.diagnostics().size(), 4U) << error.what();
    EXPECT_EQ(error.diagnostics()[0].place.position.line, 9);
    EXPECT_EQ(error.diagnostics()[3].place.position.line, 12);
  }
}

TEST(MechanismReader, NeedsFrameAndBodies) {
  EXPECT_THAT(message("format = \"oblique-mechanism/1\"\n"),
              AllOf(HasSubstr("no point fixed in the frame"), HasSubstr("the mechanism has no bodies")));
}

}  // namespace
}  // namespace oblique::mechanism
