// SPDX-License-Identifier: MIT
#include <oblique/mechanism/model/read_mechanism.h>

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace oblique::mechanism {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

/// A good four-bar, one key a line, in which the tests replace a line.
const std::string kFourBar = R"(format = "oblique-mechanism/1"
[units]
length = "m"
[frame]
A = [0, 0]
D = [4, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
BC = { points = ["B", "C"], length = 3.5, marks = { M = [1.75, 1] } }
CD = { points = ["C", "D"], length = 3 }
[drives]
crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "0 deg" }
[sketch]
C = [3.5, 2.9]
)";

std::string with(const std::string& line, const std::string& replacement) {
  std::string text = kFourBar;
  const std::size_t at = text.find(line);
  EXPECT_NE(at, std::string::npos) << line;
  return text.replace(at, line.size(), replacement);
}

/// What the reader says about a text; empty where it reads it.
std::string message(const std::string& text) {
  try {
    parse_mechanism(text, "bad.toml");
    return {};
  } catch (const MechanismError& error) {
    EXPECT_EQ(error.kind(), MechanismError::Kind::file);
    return error.what();
  }
}

TEST(MechanismReader, ReadsPointsBodiesDrivesAndSketch) {
  const Mechanism mechanism = parse_mechanism(kFourBar, "four.toml");
  ASSERT_EQ(mechanism.points.size(), 5U);
  EXPECT_EQ(mechanism.points[1].name, "D");
  EXPECT_TRUE(mechanism.points[1].fixed);
  EXPECT_EQ(mechanism.points[1].position, Eigen::Vector2d(4, 0));
  EXPECT_FALSE(mechanism.points[mechanism.find_point("M").value()].fixed);
  ASSERT_EQ(mechanism.bodies.size(), 3U);
  const Body& coupler = mechanism.bodies[mechanism.find_body("BC").value()];
  EXPECT_EQ(coupler.find(mechanism.find_point("C").value())->local, Eigen::Vector2d(3.5, 0));
  EXPECT_EQ(coupler.find(mechanism.find_point("M").value())->local, Eigen::Vector2d(1.75, 1));
  EXPECT_EQ(coupler.place, (text::Place{"four.toml", {9, 1}}));
  ASSERT_EQ(mechanism.drives.size(), 1U);
  EXPECT_EQ(mechanism.drives[0].speed, 1);
  EXPECT_EQ(mechanism.drives[0].about, mechanism.find_point("A"));
  ASSERT_EQ(mechanism.sketch.size(), 1U);
  EXPECT_EQ(mechanism.sketch[0].position, Eigen::Vector2d(3.5, 2.9));
  EXPECT_EQ(mechanism.largest_length(), 3.5);
  EXPECT_FALSE(mechanism.find_point("X"));
}

TEST(MechanismReader, ConvertsQuantitiesToTheUnitOfTheFile) {
  std::string text = with("length = \"m\"", "length = \"mm\"");
  text.replace(text.find("length = 3.5"), 12, "length = \"3 cm\"");
  text.replace(text.find("[4, 0]"), 6, "[\"4 cm\", \"10*sqrt(4)\"]");
  text.replace(text.find("1 rad/s"), 7, "60 rpm");
  text.replace(text.find("0 deg"), 5, "90 deg");
  const Mechanism mechanism = parse_mechanism(text, "four.toml");
  EXPECT_EQ(mechanism.length_unit, "mm");
  // one or two roundings of the conversion factor
  EXPECT_DOUBLE_EQ(mechanism.bodies[1].points[1].local.x(), 30);
  EXPECT_DOUBLE_EQ(mechanism.points[1].position.x(), 40);
  EXPECT_DOUBLE_EQ(mechanism.points[1].position.y(), 20);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].speed, 2 * std::numbers::pi);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].start, std::numbers::pi / 2);
}

TEST(MechanismReader, PutsTheThirdPointOfATriangleOnItsSide) {
  for (const bool left : {true, false}) {
    const Mechanism mechanism =
        parse_mechanism(with(R"(CD = { points = ["C", "D"], length = 3 })",
                             std::string(R"(CD = { points = ["C", "D", "E"], sides = [3, 4, 5], turn = ")") +
                                 (left ? "left" : "right") + "\" }"),
                        "triangle.toml");
    const Body& body = mechanism.bodies[2];
    // |CD| = 3, |DE| = 4, |EC| = 5: a right angle at D
    EXPECT_NEAR(body.points[2].local.x(), 3, 1e-15);
    EXPECT_NEAR(body.points[2].local.y(), left ? 4 : -4, 1e-15);
    EXPECT_NEAR(distance(body, body.points[0].point, body.points[2].point), 5, 1e-15);
  }
}

TEST(MechanismReader, AllowsAFlatTriangle) {
  const Mechanism mechanism =
      parse_mechanism(with(R"(CD = { points = ["C", "D"], length = 3 })",
                           R"(CD = { points = ["C", "D", "E"], sides = [0.1, 0.2, 0.3], turn = "left" })"),
                      "flat.toml");
  EXPECT_NEAR(mechanism.bodies[2].points[2].local.x(), 0.3, 1e-15);
  // 0.1 + 0.2 exceeds 0.3 by 5e-17, which is a height of √(2·0.3·5e-17…) at most
  EXPECT_NEAR(mechanism.bodies[2].points[2].local.y(), 0, 1e-8);
}

TEST(MechanismReader, ReadsAStructureWithoutDrives) {
  EXPECT_TRUE(parse_mechanism(R"(format = "oblique-mechanism/1"
[frame]
A = [0, 0]
[bodies]
AB = { points = ["A", "B"], length = 1 }
)",
                              "pendulum.toml")
                  .drives.empty());
}

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
const std::string kCrank = R"(crank = { turns = "AB", about = "A", speed = "1 rad/s", start = "0 deg" })";

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

TEST(MechanismReader, ReadsSlides) {
  std::string text = with("[sketch]", R"([slides]
s = { point = "D", along = ["B", "C"], offset = "10 mm" }
g = { point = "C", along = ["D", "A"], angle = "90 deg", of = "BC" }
[sketch])");
  text.replace(text.find(kCrank), kCrank.size(), R"(crank = { slides = "s", speed = "20 mm/s", start = 2 })");
  const Mechanism mechanism = parse_mechanism(text, "slides.toml");
  ASSERT_EQ(mechanism.slides.size(), 2U);
  const Slide& pin = mechanism.slides[0];
  EXPECT_EQ(mechanism.points[pin.point].name, "D");
  EXPECT_EQ(mechanism.points[pin.first].name, "B");
  EXPECT_EQ(mechanism.points[pin.second].name, "C");
  EXPECT_EQ(pin.carrier, mechanism.find_body("BC"));
  EXPECT_DOUBLE_EQ(pin.offset, 0.01);
  EXPECT_FALSE(pin.of);
  const Slide& guide = mechanism.slides[1];
  EXPECT_FALSE(guide.carrier);
  EXPECT_EQ(guide.of, mechanism.find_body("BC"));
  EXPECT_DOUBLE_EQ(guide.angle, std::numbers::pi / 2);
  EXPECT_EQ(mechanism.drives[0].slide, 0U);
  EXPECT_DOUBLE_EQ(mechanism.drives[0].speed, 0.02);
  EXPECT_EQ(mechanism.drives[0].start, 2);
}

TEST(MechanismReader, NeedsFrameAndBodies) {
  EXPECT_THAT(message("format = \"oblique-mechanism/1\"\n"),
              AllOf(HasSubstr("no point fixed in the frame"), HasSubstr("the mechanism has no bodies")));
}

TEST(MechanismReader, GivesBrokenTomlToTheTextStage) {
  EXPECT_THROW(parse_mechanism("format = ", "bad.toml"), text::ReadError);
  EXPECT_THROW(read_mechanism("no-such-file.toml"), text::ReadError);
}

}  // namespace
}  // namespace oblique::mechanism
