// SPDX-License-Identifier: MIT
// What cannot be fitted is refused with one message that says what, and what to do.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/synthesis/fit.h>
#include <oblique/synthesis/synthesis_error.h>
#include <oblique/text/document.h>

#include "four_bar.h"

namespace oblique::synthesis {
namespace {

const std::string kPath = "crank,F.x,F.y\n0,100,100\n1,110,110\n2,90,120\n3,60,70\n";

struct Refused {
  const char* name;
  std::vector<std::string> free;
  std::string path;
  const char* message;
};

void PrintTo(const Refused& refused, std::ostream* out) {
  *out << refused.name;
}

/// A four-bar with a body given by its sides beside it.
std::string mechanism_text() {
  std::string text = test::FourBar{}.text();
  text.replace(text.find("CD  = {"), 7,
               "CG = { points = [\"C\", \"G\"], length = 60 }\nDG = { points = [\"D\", \"G\", \"H\"], sides "
               "= [150, 50, 160], turn = \"left\" }\nCD  = {");
  text.replace(text.find("[sketch]\n"), 9, "[sketch]\nG = [100, 180]\n");
  return text;
}

class Refusal : public ::testing::TestWithParam<Refused> {};
INSTANTIATE_TEST_SUITE_P(
    Fit, Refusal,
    ::testing::Values(
        Refused{
            "UnknownDimension",
            {"AB", "BFC"},
            kPath,
            "m.toml: free dimensions: 'BFC' is no dimension of the mechanism\n  remedy: did you mean 'BCF'?"},
        Refused{
            "UnknownMark",
            {"BCF.G"},
            kPath,
            "m.toml: free dimensions: 'BCF.G' is no dimension of the mechanism\n  remedy: did you mean 'BCF"},
        Refused{"MovingPoint",
                {"F"},
                kPath,
                "free dimensions: point 'F' moves; its place is no dimension; expected a body, a mark of a "
                "body, or "
                "a point of the frame\n  remedy: as a mark it is called 'BCF.F'"},
        Refused{"MovingHinge",
                {"B"},
                kPath,
                "point 'B' moves; its place is no dimension; expected a body, a mark of a body, or a point "
                "of the "
                "frame\n  remedy: free a body that carries it: 'AB'"},
        Refused{
            "BodyGivenByItsSides",
            {"DG"},
            kPath,
            "free dimensions: body 'DG' is given by its sides and has no length; expected 'DG.sides', or one "
            "of them: 'DG.sides.1'"},
        Refused{"FreedTwice",
                {"D", "D.x"},
                kPath,
                "free dimensions: 'D.x' is freed twice\n  remedy: name it once"},
        Refused{
            "NothingFree", {}, kPath, "free dimensions: no dimension is free; expected names such as 'AB'"},
        Refused{"BoundsTheWrongWayRound",
                {"CD=150..130"},
                kPath,
                "free dimensions: the bounds of 'CD=150..130' are the wrong way round; expected "
                "lower..upper\n  "
                "remedy: CD=130..150"},
        Refused{"BoundsWithoutRoom",
                {"CD=150..150"},
                kPath,
                "the bounds of 'CD=150..150' leave no room; expected a lower bound below the upper one\n  "
                "remedy: "
                "leave 'CD' out and write 150 into the file"},
        Refused{"OneBound", {"CD=150"}, kPath, "'CD=150' does not have two bounds; expected CD=lower..upper"},
        Refused{"NoNumberForABound",
                {"CD=a..150"},
                kPath,
                "bound 'a' of 'CD=a..150': 'a' is not a known constant"},
        Refused{"EmptyBound", {"CD=..150"}, kPath, "bound '' of 'CD=..150': "},
        Refused{"BoundInAnotherUnit",
                {"CD=1 kg..150"},
                kPath,
                "bound '1 kg' of 'CD=1 kg..150': 'kg' is the wrong unit"},
        Refused{"InfiniteBound",
                {"CD=100..inf"},
                kPath,
                "bound 'inf' of 'CD=100..inf' is inf; expected finite bounds"},
        Refused{"LengthBelowZero",
                {"CD=-10..150"},
                kPath,
                "bound '-10' of 'CD=-10..150' is -10; expected lengths above 0"},
        Refused{"BoundsOfTwoNumbers",
                {"D=100..150"},
                kPath,
                "'D' is 2 numbers, which 'D=100..150' bounds together; expected bounds of one number\n  "
                "remedy: give "
                "each its own: D.x=100..150,D.y=100..150"},
        Refused{"WithoutEffect",
                {"AB", "CG"},
                kPath,
                "m.toml: free dimensions: 'CG' has no effect on the path of 'F'; expected dimensions that "
                "the path "
                "depends on\n  remedy: leave it out"},
        Refused{"BoundsThatExcludeEveryMechanism",
                {"AB=300..310"},
                kPath,
                "m.toml: no mechanism was found within the bounds that turns fully, as the given one does\n  "
                "remedy: "
                "widen the bounds"},
        Refused{"TooFewPoints",
                {"AB", "BCF", "CD"},
                "F.x,F.y\n1,2\n3,4\n",
                "path.csv: 2 targets for 3 free numbers; expected 3 or more\n  remedy: give more points of "
                "the path, or "
                "free fewer dimensions"},
        Refused{"TooFewTimedPoints",
                {"AB", "BCF", "CD"},
                "crank,F.x,F.y\n1,2,3\n",
                "path.csv: 1 target for 3 free numbers; expected 2 or more"},
        Refused{"NoRows", {"AB"}, "F.x,F.y\n", "path.csv: 0 targets for 1 free numbers; expected 1 or more"},
        Refused{
            "NoColumnsOfAPoint",
            {"AB"},
            "crank\n1\n",
            "path.csv: there are no columns of a point; expected columns P.x and P.y of a moving point P"},
        Refused{"UnknownColumn",
                {"AB"},
                "F.x,F.y,cranc\n1,2,3\n",
                "path.csv: column 'cranc' belongs to no path; expected columns P.x and P.y of a moving point "
                "P, and "
                "beside them a drive's angle [rad], t [s] or nothing\n  remedy: did you mean 'crank'?"},
        Refused{"UnknownPoint",
                {"AB"},
                "FF.x,FF.y\n1,2\n",
                "path.csv: column 'FF.x': the mechanism has no point 'FF'; expected columns P.x and P.y of a "
                "moving "
                "point P, and beside them a drive's angle [rad], t [s] or nothing\n  remedy: known: B, C, F"},
        Refused{"FixedPoint",
                {"AB"},
                "D.x,D.y\n1,2\n",
                "path.csv: point 'D' is fixed in the frame and has no path"},
        Refused{"OneCoordinate", {"AB"}, "F.x\n1\n", "path.csv: there is no column 'F.y'"},
        Refused{"TwoPoints",
                {"AB"},
                "F.x,F.y,B.x,B.y\n1,2,3,4\n",
                "path.csv: there are columns of two points, 'F' and 'B'; expected the path of one point"},
        Refused{"ColumnTwice", {"AB"}, "F.x,F.y,F.x\n1,2,3\n", "path.csv: there are two columns 'F.x'"},
        Refused{"TwoTimings",
                {"AB"},
                "t,crank,F.x,F.y\n1,2,3,4\n",
                "path.csv: columns 't' and 'crank' both tell when; expected one of them"},
        Refused{"Degrees",
                {"AB"},
                "crank,F.x,F.y\n0,1,2\n180,3,4\n",
                "path.csv: column 'crank' spans 28.6479 turns of drive 'crank'; expected one turn at most, "
                "in [rad]\n  "
                "remedy: head the column 'crank [deg]' if it is in degrees"},
        Refused{"UnitOfAnotherKind",
                {"AB"},
                "t [mm],F.x,F.y\n1,2,3\n",
                "path.csv: column 't' is in [mm]; expected a unit that can be turned into [s]"},
        Refused{"NotFinite",
                {"AB"},
                "F.x,F.y\n1,2\nnan,4\n",
                "path.csv: row 2 is not finite; expected finite numbers"},
        Refused{"NoNumber", {"AB"}, "F.x,F.y\n1,two\n", "path.csv:2:3: 'two' is no number"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(Refusal, SaysWhy) {
  const std::string text = mechanism_text();
  try {
    const TargetPath target =
        read_target_path(GetParam().path, "path.csv", mechanism::parse_mechanism(text, "m.toml"));
    fit_path(text, "m.toml", GetParam().free, target);
    FAIL() << "was not refused";
  } catch (const text::Error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(GetParam().message));
    EXPECT_EQ(error.diagnostics().size(), 1U);
  }
}

TEST(Refusals, OfDimensionsComeTogether) {
  const std::string text = mechanism_text();
  const TargetPath target = read_target_path(kPath, "path.csv", mechanism::parse_mechanism(text, "m.toml"));
  try {
    fit_path(text, "m.toml", std::vector<std::string>{"AX", "F", "CD=2..1"}, target);
    FAIL();
  } catch (const SynthesisError& error) {
    EXPECT_EQ(error.diagnostics().size(), 3U);
    EXPECT_EQ(error.kind(), SynthesisError::Kind::request);
  }
}

// A crank of 112 opens at 135°; a target there cannot be compared.
TEST(Refusals, OfATargetWhereTheMechanismIsOpen) {
  const std::string text = test::FourBar{112, 141, 151, 200, 50, 45}.text();
  const TargetPath target = read_target_path("crank,F.x,F.y\n1,100,100\n3.1,20,30\n", "path.csv",
                                             mechanism::parse_mechanism(text, "m.toml"));
  try {
    fit_path(text, "m.toml", std::vector<std::string>{"AB"}, target);
    FAIL();
  } catch (const SynthesisError& error) {
    EXPECT_STREQ(
        error.what(),
        "path.csv: point 'F' cannot be followed: the mechanism cannot be assembled where column 'crank' "
        "wants it; "
        "expected targets within the motion of the mechanism\n  remedy: 'solve m.toml' tells where it "
        "is open");
  }
}

}  // namespace
}  // namespace oblique::synthesis
