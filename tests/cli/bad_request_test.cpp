// SPDX-License-Identifier: MIT
// Every kind of bad request ends with its exit status and a message that says what, and what to do.
#include <string_view>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

TEST(BadRequest, MissingFileSaysWhere) {
  const Outcome outcome = run_command("oblique run nowhere.toml", OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err,
            "error: nowhere.toml: cannot open the file: No such file or directory\n"
            "  remedy: check the spelling and the folder you stand in\n");
}

TEST(BadRequest, ReportsAllWiringErrorsAtOnce) {
  const Outcome outcome = run_command(
      "printf 'format = \"oblique-diagram/1\"\\n[blocks]\\na = { type = \"cosine\" }\\nb = { type = "
      "\"sine\", in = \"c\" }\\n' "
      ">$SCRATCH/two.toml; oblique run $SCRATCH/two.toml; status=$?; rm $SCRATCH/two.toml; exit "
      "$status",
      OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("SCRATCH/two.toml:3:"));
  EXPECT_THAT(outcome.err, HasSubstr("SCRATCH/two.toml:4:"));
}

struct BadRequestCase {
  const char* name;
  const char* command;
  int status;
  const char* says;
};

void PrintTo(const BadRequestCase& request, std::ostream* out) {
  *out << request.command;
}

class BadRequests : public ::testing::TestWithParam<BadRequestCase> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, BadRequests,
    ::testing::Values(
        BadRequestCase{"UnknownVerb", "oblique rnu x", 2,
                       "there is no command 'rnu'\n  remedy: did you mean 'run'?"},
        BadRequestCase{"UnknownOption", "oblique run x --chek", 2,
                       "'run' has no option '--chek'\n  remedy: did you mean '--check'?"},
        BadRequestCase{"UnknownVerbBehindAnOption", "oblique --blocks . rnu x", 2,
                       "there is no command 'rnu'\n  remedy: did you mean 'run'?"},
        BadRequestCase{"VerbBehindDashes", "oblique -- run x", 2,
                       "'--' stands before the command 'run'\n  remedy: leave '--' out there"},
        BadRequestCase{
            "EmptyArgument", "oblique run diagrams/lessons/circle.toml -o ''", 2,
            "the argument behind '-o' is empty; expected a name or a value\n  remedy: leave it out; a "
            "variable of the shell that is not set makes one"},
        BadRequestCase{"ArgumentTooMany", "oblique run x extra --blocks .", 2,
                       "extra\n  remedy: oblique run --help"},
        BadRequestCase{"FullStdout", "oblique blocks >/dev/full", 2,
                       "error: the results could not be written to stdout\n  remedy: make room"},
        BadRequestCase{"FullStdoutOfARun", "oblique run diagrams/lessons/division.toml >/dev/full", 2,
                       "error: the results could not be written to stdout"},
        BadRequestCase{"ClosedStdout", "oblique blocks >&-", 2,
                       "error: the results could not be written to stdout"},
        BadRequestCase{"ClosedStdoutOfARun", "oblique run diagrams/lessons/division.toml >&-", 2,
                       "error: the results could not be written to stdout"},
        BadRequestCase{"TooLittleMemory",
                       "sed 's/^samples.*/samples = 10000000/' diagrams/lessons/circle.toml > "
                       "$SCRATCH/long.toml; ulimit -v 200000; oblique run $SCRATCH/long.toml; status=$?; "
                       "rm $SCRATCH/long.toml; exit $status",
                       2, "error: there is not enough memory for this\n  remedy: ask for fewer rows"},
        BadRequestCase{"OutputIsAFolder",
                       "mkdir $SCRATCH/folder.csv; oblique run diagrams/lessons/circle.toml -o "
                       "$SCRATCH/folder.csv "
                       "| grep -q . && touch $SCRATCH/folder.csv/ran; ls $SCRATCH/folder.csv >&2; "
                       "rm -r $SCRATCH/folder.csv; exit 2",
                       2,
                       "error: SCRATCH/folder.csv: this file could not be written: Is a directory\n"
                       "  remedy: name a file in a folder that you may write to\n"},
        BadRequestCase{"MissingArgument", "oblique solve", 2,
                       "remedy: oblique solve --help tells how to call it"},
        BadRequestCase{"PositionsOutOfRange", "oblique solve diagrams/mechanisms/four-bar.toml --positions 1",
                       2, "--positions: 1; expected a whole number from 2 to 10000000"},
        BadRequestCase{"PositionsThatAreNoDigits",
                       "oblique solve diagrams/mechanisms/four-bar.toml --positions 1e3", 2,
                       "--positions: 1e3; expected a whole number from 2 to 10000000"},
        BadRequestCase{"SeedOfASweepBelowZero", "oblique sweep diagrams/lessons/circle.toml --seed -1", 2,
                       "--seed: -1; expected a whole number from 0 on"},
        BadRequestCase{"EndlessMotion", "oblique solve diagrams/mechanisms/four-bar.toml --until inf", 2,
                       "--until inf; expected a finite time above 0"},
        BadRequestCase{"GainThatIsNoNumber", "oblique compare diagrams/mechanisms/four-bar.toml --gain high",
                       2, "--gain high: 'high' is not a known constant"},
        BadRequestCase{"GainBelowZero", "oblique compare diagrams/mechanisms/four-bar.toml --gain 1e3,0", 2,
                       "--gain 0; expected finite gains above 0"},
        BadRequestCase{"GainWithoutEnd",
                       "oblique compare diagrams/mechanisms/four-bar.toml --json --gain 1e3,inf", 2,
                       "--gain inf; expected finite gains above 0"},
        BadRequestCase{"BandwidthZero", "oblique compare diagrams/mechanisms/four-bar.toml --bandwidth 20,0",
                       2, "--bandwidth 0; expected finite bandwidths above 0, such as 10,100 or \"1 kHz\""},
        BadRequestCase{"BandwidthInSeconds",
                       "oblique compare diagrams/mechanisms/four-bar.toml --bandwidth '5 s'", 2,
                       "--bandwidth 5 s: 's' is the wrong unit here"},
        BadRequestCase{"MethodOfNoName",
                       "oblique compare diagrams/mechanisms/four-bar.toml --method triangles,gradiant", 2,
                       "--method gradiant; expected triangles, gradient or paper"},
        BadRequestCase{
            "BandwidthThatNoSolverTakes",
            "oblique compare diagrams/mechanisms/four-bar.toml --gain 1e9 --bandwidth 1e300", 3,
            "error: diagrams/mechanisms/four-bar.toml: with amplifiers of gain 1e+09 and 1e+300 Hz: "},
        BadRequestCase{
            "SlowerWithoutAnOuterLoop", "oblique patch diagrams/mechanisms/four-bar.toml --slower 10", 2,
            "four-bar.toml: --slower 10: this patch has no outer loop; expected a mechanism with a "
            "triad on three links\n  remedy: leave it out"},
        BadRequestCase{
            "SlowerWithGradient",
            "oblique patch diagrams/mechanisms/class-iii.toml --method gradient --slower 10", 2,
            "error: --slower 10 with --method gradient, which takes no group apart; expected --method "
            "triangles or paper beside it"},
        BadRequestCase{"SplitOfOtherLegs",
                       "oblique patch diagrams/mechanisms/class-iii.toml --split AB,DE,XY", 2,
                       "--split AB,DE,XY: no triad has these legs; expected the three legs of a triad"},
        BadRequestCase{
            "GradientOfInfiniteGain",
            "oblique patch diagrams/mechanisms/four-bar.toml --method gradient --gain inf", 2,
            "a gradient servo of infinite gain or bandwidth has no time scale; expected a finite gain and"},
        BadRequestCase{"SlowerWithoutEnd", "oblique patch diagrams/mechanisms/class-iii.toml --slower inf", 2,
                       "error: --slower inf; expected a finite number above 0"},
        BadRequestCase{"UnitWithoutEnd", "oblique patch diagrams/mechanisms/four-bar.toml --unit inf", 2,
                       "error: --unit inf; expected a finite number above 0"},
        BadRequestCase{"PeriodWithoutEnd", "oblique patch diagrams/mechanisms/four-bar.toml --period inf", 2,
                       "error: --period inf; expected a finite number above 0"},
        BadRequestCase{"SplitOfTheGradient",
                       "oblique patch diagrams/mechanisms/class-iii.toml --method gradient --split AB,O1C,DE",
                       2, "--split AB,O1C,DE with --method gradient, which takes no group apart"},
        BadRequestCase{"SensitivityToNothing", "oblique run diagrams/lessons/circle.toml --sensitivity x.rat",
                       2, "there is no sensitivity to 'x.rat': no block has such a parameter"},
        BadRequestCase{
            "MonteCarloWithoutTolerance",
            "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 10", 2,
            "--monte-carlo without how far the elements scatter; expected --tolerance, such as 0.1%, or a "
            "--machine"},
        BadRequestCase{
            "MonteCarloOfSeveralGains",
            "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 10 --tolerance 1% --gain "
            "1e3,1e4",
            2, "--monte-carlo with 2 values of --gain; expected one"},
        BadRequestCase{
            "MonteCarloOnAMachineThatSaysNothingOfScatter",
            "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 10 --machine ec-1", 2,
            "nothing is published of how the elements of Heathkit EC-1 scatter; expected --tolerance"},
        BadRequestCase{"CompareOnAMachineOfNoName",
                       "oblique compare diagrams/mechanisms/four-bar.toml --machine tr10", 2,
                       "there is no machine 'tr10'\n  remedy: did you mean 'tr-10'?"},
        BadRequestCase{"MachineWithSeveralMethods",
                       "oblique compare diagrams/mechanisms/four-bar.toml --machine tr-10 --method "
                       "triangles,gradient",
                       2, "--machine with 2 values of --method; expected one"},
        BadRequestCase{"ToleranceOfAFactor",
                       "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 10 --tolerance 2", 2,
                       "--tolerance 2; expected a number above 0 and up to 50%"},
        BadRequestCase{"YieldWithoutMonteCarlo",
                       "oblique compare diagrams/mechanisms/four-bar.toml --yield 1%", 2,
                       "--yield requires --monte-carlo"},
        BadRequestCase{
            "YieldBelowNothing",
            "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 3 --tolerance 1% --yield 0%", 2,
            "--yield 0%; expected a part of the largest link above 0, such as 1%, or a length"},
        BadRequestCase{"YieldWithinEverything",
                       "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 3 --tolerance 1% "
                       "--yield 1% --until-within 2",
                       2, "--until-within 2; expected a part above 0 and below 1, such as 1%"},
        BadRequestCase{"YieldWithinNothing",
                       "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 3 --tolerance 1% "
                       "--yield 1% --until-within 0%",
                       2, "--until-within 0%; expected a part above 0 and below 1, such as 1%"},
        BadRequestCase{"SeedWithoutMonteCarlo", "oblique compare diagrams/mechanisms/four-bar.toml --seed 3",
                       2, "--seed requires --monte-carlo"},
        BadRequestCase{
            "SeedBelowZero",
            "oblique compare diagrams/mechanisms/four-bar.toml --monte-carlo 3 --tolerance 1% --seed -3", 2,
            "--seed: "},
        BadRequestCase{
            "MethodThatFailsAmongSeveral",
            "oblique compare diagrams/mechanisms/four-bar.toml --method triangles,gradient --gain 1e300", 3,
            "four-bar.toml: with amplifiers of gain 1e+300, method triangles: the run"},
        BadRequestCase{"GainThatNoSolverTakes",
                       "oblique compare diagrams/mechanisms/four-bar.toml --gain 1e300", 3,
                       "error: diagrams/mechanisms/four-bar.toml: with amplifiers of gain 1e+300: the run"},
        BadRequestCase{"UntilInMillimetres", "oblique run diagrams/lessons/circle.toml --until '5 mm'", 2,
                       "--until 5 mm: 'mm' is the wrong unit here; expected a quantity in 's'"},
        BadRequestCase{"UntilZero", "oblique run diagrams/lessons/circle.toml --until 0", 2,
                       "the run would end at t = 0 s"},
        BadRequestCase{"UntilInfinity", "oblique run diagrams/lessons/circle.toml --until inf", 2,
                       "the run would end at t = inf s; expected a finite time above 0"},
        BadRequestCase{"SetOfAnUnknownParameter",
                       "oblique run diagrams/lessons/triangle-side.toml --set c.gian=3", 2,
                       "remedy: did you mean 'gain'?"},
        BadRequestCase{"SetOfAnUnknownBlock",
                       "oblique run diagrams/lessons/triangle-side.toml --set q.gain=3", 2, "'q'"},
        BadRequestCase{"SetOfAWireThereIsNot",
                       "oblique run diagrams/lessons/triangle-side.toml --set 'c.in[7]=1'", 2,
                       "--set c.in[7]=1: input 'c.in' has no wire 7; expected a number from 1 to 4"},
        BadRequestCase{"SetOfASignalThatIsNotWired",
                       "oblique run diagrams/lessons/triangle-side.toml --set 'c.in[b3]=1'", 2,
                       "--set c.in[b3]=1: no wire of input 'c.in' comes from 'b3'"},
        BadRequestCase{"SetWithoutValue", "oblique run diagrams/lessons/triangle-side.toml --set c.gain", 2,
                       "--set c.gain: this sets nothing"},
        BadRequestCase{"SetOfABlock", "oblique run diagrams/lessons/triangle-side.toml --set a=0.3", 2,
                       "--set a=0.3: 'a' is a block, not one of its values; expected a.value\n"},
        BadRequestCase{
            "SetWithABlankOnEachSide", "oblique run diagrams/lessons/triangle-side.toml --set c.gain = 10", 2,
            "error: a blank stands beside '='; expected c.gain=10\n  remedy: leave the blanks out\n"},
        BadRequestCase{"SetWithABlankBehind",
                       "oblique run diagrams/lessons/triangle-side.toml --set c.gain= 10 --check", 2,
                       "error: a blank stands beside '='; expected c.gain=10\n"},
        BadRequestCase{"SetWithABlankBefore",
                       "oblique sweep --vary c.gain =10 diagrams/lessons/triangle-side.toml", 2,
                       "error: a blank stands beside '='; expected c.gain=10\n"},
        BadRequestCase{"VaryWithABlankBehindAComma",
                       "oblique sweep diagrams/lessons/triangle-side.toml --vary c.gain=1e3, 1e4", 2,
                       "error: a blank stands beside ','; expected c.gain=1e3,1e4\n"},
        BadRequestCase{"OptionWithOneDash", "oblique run diagrams/lessons/triangle-side.toml -set c.gain=10",
                       2, "error: 'run' has no option '-set'\n  remedy: did you mean '--set'?\n"},
        BadRequestCase{"SetOfANumberInAUnit",
                       "oblique run diagrams/lessons/triangle-side.toml --set c.gain='10 Hz'", 2,
                       "'Hz' is the wrong unit here; expected a number without a unit\n"
                       "  remedy: leave the unit out\n"},
        BadRequestCase{"FileOfANearName", "oblique run diagrams/course/1-open-amplifer.toml", 2,
                       "remedy: did you mean 'diagrams/course/1-open-amplifier.toml'?\n"},
        BadRequestCase{"FileInNoFolder", "oblique run diagram/course/1-open-amplifier.toml", 2,
                       "remedy: there is no folder 'diagram/course': check its spelling and the folder you "
                       "stand in\n"},
        BadRequestCase{
            "OutputOfAnUnknownKind", "oblique run diagrams/lessons/triangle-side.toml -o x.xls", 2,
            "error: x.xls: cannot write a '.xls' file; expected a name that ends in .csv, .npy, .mat or "
            ".json\n"},
        BadRequestCase{
            "OutputWithoutAKind", "oblique solve diagrams/mechanisms/four-bar.toml -o motion", 2,
            "error: motion: the name of this file has no ending; expected a name that ends in .csv, "
            ".npy, .mat or .json\n"},
        BadRequestCase{
            "MechanismForADiagram", "oblique run diagrams/mechanisms/jansen.toml", 2,
            "jansen.toml:18:10: the format is 'oblique-mechanism/1'; expected 'oblique-diagram/1'\n"
            "  remedy: this is a mechanism: `oblique solve`, `oblique compare` and `oblique draw` take it, "
            "`oblique patch` makes a "
            "diagram of it\n"},
        BadRequestCase{"OutputToAFullDisk",
                       "ln -s /dev/full $SCRATCH/full.npy; oblique solve diagrams/mechanisms/four-bar.toml "
                       "-o $SCRATCH/full.npy; status=$?; rm $SCRATCH/full.npy; exit $status",
                       2,
                       "error: SCRATCH/full.npy: cannot write the file: No space left on device\n"
                       "  remedy: make room on the disk\n"},
        BadRequestCase{"UnknownColumnOfAMotion",
                       "oblique solve diagrams/mechanisms/jansen.toml -o /tmp/x.npy --columns t,P5.z", 2,
                       "error: --columns: there is no column 'P5.z'\n  remedy: did you mean 'P5.x'?\n"},
        BadRequestCase{"UnknownColumnOfARun",
                       "oblique run diagrams/lessons/triangle-side.toml -o /tmp/x.npy --columns sides", 2,
                       "error: --columns: there is no column 'sides'\n  remedy: did you mean 'side'?\n"},
        BadRequestCase{
            "ColumnsWithoutAFile", "oblique run diagrams/lessons/triangle-side.toml --columns side", 2,
            "error: --columns chooses what a file holds, and there is none; expected -o FILE beside "
            "it\n"},
        BadRequestCase{
            "NoTemporaryFolder",
            "TMPDIR=/nowhere oblique draw diagrams/mechanisms/four-bar.toml -o $SCRATCH/never.png; "
            "status=$?; test ! -e $SCRATCH/never.png || status=99; exit $status",
            2,
            "error: no temporary folder could be made for the conversion to pixels\n  remedy: set TMPDIR "
            "to a folder that you may write to\n"},
        BadRequestCase{"OutputInNoFolder",
                       "oblique run diagrams/lessons/triangle-side.toml -o no/where/x.csv", 2,
                       "the folder of this file does not exist\n  remedy: make it first: mkdir -p no/where"},
        BadRequestCase{"StaticTestWithCheck",
                       "oblique run diagrams/lessons/circle.toml --static-test --check", 2,
                       "--static-test runs nothing, so --check has nothing to work on"},
        BadRequestCase{"StaticTestWithTrust",
                       "oblique run diagrams/lessons/circle.toml --static-test --trust", 2,
                       "--static-test runs nothing, so --trust has nothing to work on"},
        BadRequestCase{"StaticTestWithOutput",
                       "oblique run diagrams/lessons/circle.toml --static-test -o x.csv", 2,
                       "so -o has nothing to work on; expected one of the two"},
        BadRequestCase{"RescaleWithoutOutput", "oblique check diagrams/lessons/circle.toml --rescale", 2,
                       "--rescale has no file to write to; expected -o NEW.toml"},
        BadRequestCase{"CheckOutputWithoutRescale", "oblique check diagrams/lessons/circle.toml -o x.toml", 2,
                       "there is nothing to write to x.toml; expected --rescale beside -o"},
        BadRequestCase{"RescaleToAnotherKind",
                       "oblique check diagrams/lessons/circle.toml --rescale -o x.csv", 2,
                       "cannot write a '.csv' file; expected a name that ends in .toml"},
        BadRequestCase{"RescaleOfAMechanism",
                       "oblique check diagrams/mechanisms/four-bar.toml --rescale -o x.toml", 2,
                       "a mechanism has no signals to scale; expected a diagram for --rescale"},
        BadRequestCase{"UnknownBlockPage", "oblique blocks multiplyer", 2, "did you mean 'multiplier'?"},
        BadRequestCase{"FileOfNoKnownFormat", "oblique check CMakePresets.json", 2,
                       "error: CMakePresets.json"},
        BadRequestCase{"BlocksFolderThatIsNotThere", "oblique --blocks nowhere blocks", 2, "nowhere"},
        BadRequestCase{"FailedExpectation",
                       "oblique run diagrams/lessons/triangle-side.toml --set c.gain=100 --check", 1, ""}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(BadRequests, EndWithTheirStatusAndAMessage) {
#ifdef __SANITIZE_ADDRESS__
  if (std::string_view(GetParam().name) == "TooLittleMemory")
    GTEST_SKIP() << "the sanitizer reserves more than the limit by itself";
#endif
  const Outcome outcome = run_command(GetParam().command, OBLIQUE_SOURCE_DIR);
  EXPECT_EQ(outcome.status, GetParam().status) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(GetParam().says));
}

}  // namespace
}  // namespace oblique::test
