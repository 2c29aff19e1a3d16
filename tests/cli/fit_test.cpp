// SPDX-License-Identifier: MIT
// oblique fit: what it prints, writes and refuses; what it finds is tested in tests/synthesis.
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

/// A folder with a crank of 80 mm to be made one of 83 mm, by the circle of its end.
class FitVerb : public ::testing::Test {
 protected:
  FitVerb() : folder_(make_scratch_folder()) {
    std::filesystem::create_directories(folder_);
    std::filesystem::copy_file(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/six-bar.toml",
                               folder_ / "six-bar.toml", std::filesystem::copy_options::overwrite_existing);
    std::ofstream circle(folder_ / "circle.csv");
    circle.precision(17);
    circle << "B.x,B.y\n";
    for (int k = 0; k < 8; ++k) circle << 83 * std::cos(0.7 * k) << "," << 83 * std::sin(0.7 * k) << "\n";
  }
  ~FitVerb() override { std::filesystem::remove_all(folder_); }

  Outcome oblique(const std::string& arguments) const {
    return run_command("oblique " + arguments, folder_.string());
  }
  std::string read(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    std::ostringstream text;
    text << stream.rdbuf();
    return std::move(text).str();
  }
  bool exists(const std::string& name) const { return std::filesystem::exists(folder_ / name); }

 private:
  std::filesystem::path folder_;
};

TEST_F(FitVerb, PrintsWhatChangedAndWritesIt) {
  const Outcome outcome = oblique("fit six-bar.toml --path circle.csv --free AB=70..90 -o new.toml");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out,
              HasSubstr("path of B: 8 points of circle.csv, each to the nearest place of the path"));
  EXPECT_THAT(outcome.out, ContainsRegex("root mean square +3 "));
  EXPECT_THAT(outcome.out, ContainsRegex("AB +80 +83 +70 +90\n"));
  EXPECT_THAT(outcome.out, HasSubstr("it turns fully, as before"));
  EXPECT_THAT(outcome.err, HasSubstr("wrote new.toml"));
  EXPECT_THAT(read("new.toml"),
              ::testing::StartsWith("# Fitted from six-bar.toml: AB changed so that B follows"));
  EXPECT_EQ(oblique("check new.toml").status, 0);
}

TEST_F(FitVerb, SaysWhatLiesAtABound) {
  const Outcome outcome = oblique("fit six-bar.toml --path circle.csv --free AB=70..82");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, ContainsRegex("AB +80 +82 +70 +82 +at its upper bound\n"));
  EXPECT_THAT(outcome.err, Not(HasSubstr("wrote")));
}

TEST_F(FitVerb, EndsWithOneAndWritesNothingWhereNothingIsNearer) {
  const Outcome outcome = oblique("fit six-bar.toml --path circle.csv --free AB=70..80 -o new.toml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, HasSubstr("no mechanism within the bounds comes nearer than the given one"));
  EXPECT_THAT(outcome.out, HasSubstr("unchanged, at its upper bound"));
  EXPECT_THAT(outcome.err, HasSubstr("new.toml is not written"));
  EXPECT_FALSE(exists("new.toml"));
}

TEST_F(FitVerb, SaysThatTheGivenOneLiesOutsideTheBounds) {
  const Outcome outcome = oblique("fit six-bar.toml --path circle.csv --free AB=70..78");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.out, ContainsRegex("AB +80 +80 +70 +78 +unchanged, outside its bounds\n"));
}

TEST_F(FitVerb, EndsWithOneWhereNothingTurns) {
  const Outcome outcome = oblique("fit six-bar.toml --path circle.csv --free AB=300..310 -o new.toml");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err,
              HasSubstr("error: six-bar.toml: no mechanism was found within the bounds that turns fully"));
  EXPECT_FALSE(exists("new.toml"));
}

struct Refused {
  const char* name;
  const char* arguments;
  const char* says;
};

class FitRefusal : public FitVerb, public testing::WithParamInterface<Refused> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, FitRefusal,
    ::testing::Values(
        Refused{"UnknownBody", "--path circle.csv --free BFC",
                "error: six-bar.toml: free dimensions: 'BFC' is no dimension of the mechanism\n  remedy: did "
                "you mean "
                "'BCF'?"},
        Refused{"WithoutEffect", "--path circle.csv --free AB,CD", "'CD' has no effect on the path of 'B'"},
        Refused{"BoundsTheWrongWayRound", "--path circle.csv --free AB=90..70", "remedy: AB=70..90"},
        Refused{"MissingPath", "--path nowhere.csv --free AB", "error: nowhere.csv: cannot open the file"},
        Refused{"PathThatIsNoTable", "--path six-bar.toml --free AB", "error: six-bar.toml"},
        Refused{"WithoutFree", "--path circle.csv", "--free is required"},
        Refused{"WithoutPath", "--free AB", "--path is required"},
        Refused{"NoStarts", "--path circle.csv --free AB --starts 0",
                "--starts: 0; expected a whole number from 1 to"},
        Refused{"OutputOfAnotherKind", "--path circle.csv --free AB -o new.csv",
                "cannot write a '.csv' file; expected a name that ends in .toml"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(FitRefusal, EndsWithTwoAndAMessage) {
  const Outcome outcome = oblique(std::string("fit six-bar.toml ") + GetParam().arguments);
  EXPECT_EQ(outcome.status, 2) << outcome.out;
  EXPECT_THAT(outcome.out, ::testing::IsEmpty());
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().says));
}

}  // namespace
}  // namespace oblique::test
