// SPDX-License-Identifier: MIT
// Every kind of bad file ends with its exit status and one message that says where, what and what to do.
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct BadInput {
  const char* name;
  const char* verb;
  std::string text;  ///< of the file
  int status;
  std::vector<const char*> says;  ///< on stderr
};

std::string diagram(const std::string& blocks, const std::string& rest = "") {
  return "format = \"oblique-diagram/1\"\n" + rest + "[blocks]\n" + blocks;
}

std::string mechanism(const std::string& bodies,
                      const std::string& drives = "crank = { turns = \"AB\", about = \"A\", speed = 1 }\n",
                      const std::string& frame = "A = [0, 0]\nD = [4, 0]\n",
                      const std::string& sketch = "C = [3, 3]\n") {
  return "format = \"oblique-mechanism/1\"\n[frame]\n" + frame + "[bodies]\n" + bodies + "[drives]\n" +
         drives + "[sketch]\n" + sketch;
}

const std::string kCrank = "AB = { points = [\"A\", \"B\"], length = 1 }\n";
const std::string kCoupler = "BC = { points = [\"B\", \"C\"], length = 3.5 }\n";
const std::string kRocker = "CD = { points = [\"C\", \"D\"], length = 3 }\n";

const std::vector<BadInput> kCases{
    {"BrokenToml",
     "run",
     "format = \"oblique-diagram/1\"\n[blocks\n",
     2,
     {"input.toml:2:", "broken TOML", "remedy"}},
    {"WrongFormat",
     "run",
     "format = \"oblique-mechanism/1\"\n",
     2,
     {"input.toml:1:10: the format is 'oblique-mechanism/1'; expected 'oblique-diagram/1'"}},
    {"UnknownKey",
     "run",
     diagram("a = { type = \"constant\" }\n", "tilte = \"x\"\n"),
     2,
     {"input.toml:2:1: unknown key 'tilte'", "did you mean 'title'?"}},
    {"UnknownBlockType",
     "run",
     diagram("a = { type = \"integrater\", in = \"a\" }\n"),
     2,
     {"input.toml:3:", "integrater", "did you mean 'integrator'?"}},
    {"UnknownPort",
     "run",
     diagram("a = { type = \"constant\", valeu = 1 }\n"),
     2,
     {"input.toml:3:", "valeu", "did you mean 'value'?"}},
    {"UnknownSignal",
     "run",
     diagram("one = { type = \"constant\" }\nb = { type = \"cosine\", in = \"onne\" }\n"),
     2,
     {"input.toml:4:", "onne", "did you mean 'one'?"}},
    {"OpenInput",
     "run",
     diagram("m = { type = \"multiplier\", x = \"m\" }\n"),
     2,
     {"input.toml:3:", "input 'm.y' (multiplier) is not connected", "remedy"}},
    {"DoublyDrivenInput",
     "run",
     diagram("one = { type = \"constant\" }\nc = { type = \"cosine\", in = [\"one\", \"one\"] }\n"),
     2,
     {"input.toml:4:37: input 'c.in' is doubly driven: it takes one signal and was given 2", "remedy"}},
    {"DecimalCommaInAWeight",
     "run",
     diagram("a = { type = \"integrator\", in = \"-0,5*a\" }\n"),
     2,
     {"input.toml:3:36: input 'a.in': there is a comma in the number; expected a decimal point",
      "remedy: write -0.5*a"}},
    {"DecimalCommaInANumber",
     "run",
     diagram("a = { type = \"constant\", value = 0,5 }\n"),
     2,
     {"input.toml:3:", "remedy: numbers have a decimal point, not a comma: write 0.5"}},
    {"DecimalCommaInAPoint",
     "run",
     diagram(
         "a = { type = \"constant\" }\nf = { type = \"function-generator\", in = \"a\", points = [[0,5, 1], "
         "[1, 2]] }\n"),
     2,
     {"input.toml:4:", "something other than a point; expected [x, y]",
      "remedy: numbers have a decimal point, not a comma"}},
    {"WrongUnit",
     "run",
     diagram("one = { type = \"constant\" }\na = { type = \"servo-amplifier\", in = \"one\", bandwidth = "
             "\"10 mm\" }\n"),
     2,
     {"input.toml:4:", "'mm' is the wrong unit here", "Hz"}},
    {"OutOfRange",
     "run",
     diagram("one = { type = \"constant\" }\na = { type = \"potentiometer\", in = \"one\", setting = 2 }\n"),
     2,
     {"input.toml:4:", "setting", "2", "1"}},
    {"SingularLoop",
     "run",
     diagram("one = { type = \"constant\" }\na = { type = \"summer\", in = [\"a\", \"one\"] }\n"),
     3,
     {"the algebraic loop a → a is singular at t = 0 s: its gain is 1",
      "remedy: change a weight so that the gain of the loop is not 1, or put an integrator into it"}},
    {"AmplifierWithoutFeedback",
     "run",
     diagram(
         "one = { type = \"constant\" }\na = { type = \"servo-amplifier\", in = [\"one\"], gain = inf }\n"),
     3,
     {"the algebraic loop a → a is singular", "the inputs of 'a' do not respond to its output", "remedy"}},
    {"PositiveFeedbackServo",
     "run",
     diagram("one = { type = \"constant\" }\na = { type = \"servo-amplifier\", in = [\"one\", \"-a\"] }\n"),
     3,
     {"the servo loops do not come to rest", "'a'", "remedy: check the signs at the amplifier's inputs"}},
    {"BlowUp",
     "run",
     diagram("x = { type = \"integrator\", in = [\"xx\"], initial = 1 }\nxx = { type = \"multiplier\", in = "
             "[\"x\", \"x\"] }\n",
             "[run]\nuntil = 2\n"),
     3,
     {"the run stopped at t = ", "the solution grows without bound", "'x' =", "largest weighted local errors",
      "remedy"}},
    {"ZeroLength",
     "solve",
     mechanism("AB = { points = [\"A\", \"B\"], length = 0 }\n" + kCoupler + kRocker),
     2,
     {"input.toml:6:", "length", "0", "above 0"}},
    {"LengthBeyondAllMeasure",
     "solve",
     mechanism("AB = { points = [\"A\", \"B\"], length = 1e200 }\n" + kCoupler + kRocker),
     2,
     {"input.toml:6:", "'length' of body 'AB' is 1e+200; expected a length from 1e-100 to 1e+100"}},
    {"CoordinateBeyondAllMeasure",
     "solve",
     mechanism(kCrank + kCoupler + kRocker, "crank = { turns = \"AB\", about = \"A\", speed = 1 }\n",
               "A = [0, 0]\nD = [4e200, 0]\n"),
     2,
     {"input.toml:4:", "frame point 'D' is at [4e+200, 0]; expected coordinates up to 1e+100"}},
    {"MechanismWrongUnit",
     "solve",
     mechanism(kCrank + kCoupler + kRocker, "crank = { turns = \"AB\", about = \"A\", speed = \"1 kg\" }\n"),
     2,
     {"input.toml:10:", "kg", "rad/s"}},
    {"UnknownBody",
     "solve",
     mechanism(kCrank + kCoupler + kRocker, "crank = { turns = \"AC\", about = \"A\", speed = 1 }\n"),
     2,
     {"input.toml:10:", "'AC'", "remedy: did you mean"}},
    {"CannotBeAssembled",
     "solve",
     mechanism(
         kCrank +
         "BC = { points = [\"B\", \"C\"], length = 0.5 }\nCD = { points = [\"C\", \"D\"], length = 0.5 }\n"),
     1,
     {"cannot be assembled", "BC", "CD"}},
    {"WithoutDrive", "solve", mechanism(kCrank + kCoupler + kRocker, ""), 2, {"the mechanism has no drive"}},
    {"UnderDriven",
     "solve",
     mechanism(
         kCrank + kCoupler +
         "CE = { points = [\"C\", \"E\"], length = 1 }\nED = { points = [\"E\", \"D\"], length = 2 }\n"),
     2,
     {"mobility", "2", "1 drive"}},
    {"OverDriven",
     "solve",
     mechanism(kCrank + kCoupler + kRocker,
               "crank = { turns = \"AB\", about = \"A\", speed = 1 }\nrocker = { turns = \"CD\", about = "
               "\"D\", speed = 1 }\n"),
     2,
     {"mobility", "1", "2 drives"}},
    {"DriveAThousandMillionTimesFaster",
     "check",
     mechanism(
         kCrank + "DE = { points = [\"D\", \"E\"], length = 1 }\n" +
             "BC = { points = [\"B\", \"C\"], length = 4 }\nEC = { points = [\"E\", \"C\"], length = 4 }\n",
         "slow = { turns = \"AB\", about = \"A\", speed = 1 }\nfast = { turns = \"DE\", about = \"D\", "
         "speed = 1e9 }\n"),
     2,
     {"input.toml:12:1: drive 'fast' turns 1e+09 times in the 6.28319 s of the motion",
      "expected 10000 turns", "remedy: a motion lasts one turn of the first drive"}},
    {"NoSketch",
     "solve",
     mechanism(kCrank + kCoupler + kRocker, "crank = { turns = \"AB\", about = \"A\", speed = 1 }\n",
               "A = [0, 0]\nD = [4, 0]\n", ""),
     2,
     {"[sketch]", "C = [3.0416", "C = [3.0416"}},
};

void PrintTo(const BadInput& input, std::ostream* out) {
  *out << input.name;
}

class BadInputs : public ::testing::TestWithParam<BadInput> {};
INSTANTIATE_TEST_SUITE_P(Cli, BadInputs, ::testing::ValuesIn(kCases),
                         [](const auto& tested) { return tested.param.name; });

TEST_P(BadInputs, EndWithTheirStatusAndAMessage) {
  const ScratchFolder folder;
  std::ofstream(folder / "input.toml") << GetParam().text;
  const Outcome outcome =
      run_command(std::string("oblique ") + GetParam().verb + " input.toml", folder.path().string());
  EXPECT_EQ(outcome.status, GetParam().status) << outcome.err;
  EXPECT_THAT(outcome.out, IsEmpty());
  EXPECT_THAT(outcome.err, ::testing::StartsWith("error: "));
  for (const char* part : GetParam().says) EXPECT_THAT(outcome.err, HasSubstr(part));
}

/// A file with so many blocks, each wrong in the same way.
struct ManyFaults {
  const char* name;
  const char* rest_of_block;  ///< {} is its number
  std::string first;          ///< what is said of block 0
};

void PrintTo(const ManyFaults& tested, std::ostream* out) {
  *out << tested.name;
}

class ManyInputs : public ::testing::TestWithParam<ManyFaults> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, ManyInputs,
    ::testing::Values(
        ManyFaults{"UnknownSignals", "type = \"gain\", in = \"no{}\"",
                   "error: input.toml:3:29: input 'b0.in': there is no signal 'no0'\n"
                   "  remedy: known: b0, b1, b2, b3, b4, b5, b6, b7, b8, b9, b10, b11 and 2988 more\n"},
        ManyFaults{"OpenInputs", "type = \"gain\"",
                   "error: input.toml:3:1: input 'b0.in' (gain) is not connected; expected a signal\n"
                   "  remedy: in = \"NAME OF A SIGNAL\"\n"},
        ManyFaults{
            "TwoDrivers", "type = \"gain\", in = [\"b0\", \"b1\"]",
            "error: input.toml:3:35: input 'b0.in' is doubly driven: it takes one signal and was given "
            "2\n"
            "  remedy: add the signals in a block with a summing input and wire its output here\n"},
        ManyFaults{"UnknownTypes", "type = \"gian\", in = \"b0\"",
                   "error: input.toml:3:1: block 'b0': there is no block type 'gian'\n"
                   "  remedy: did you mean 'gain'?\n"}),
    [](const auto& tested) { return tested.param.name; });

TEST_P(ManyInputs, AreToldOfByTheFirstOfThem) {
  constexpr int kMany = 3000;
  const ScratchFolder folder;
  std::string blocks;
  for (int k = 0; k < kMany; ++k) {
    const std::string number = std::to_string(k);
    std::string rest = GetParam().rest_of_block;
    if (const auto at = rest.find("{}"); at != std::string::npos) rest.replace(at, 2, number);
    blocks += "b" + number + " = { " + rest + " }\n";
  }
  std::ofstream(folder / "input.toml") << diagram(blocks);
  const Outcome outcome = run_command("oblique run input.toml", folder.path().string());
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, ::testing::StartsWith(GetParam().first));
  EXPECT_THAT(outcome.err, ::testing::EndsWith("\nerror: … and 2980 more\n"));
  std::size_t findings = 0;
  for (std::size_t at = 0; (at = outcome.err.find("error: ", at)) != std::string::npos; ++at) ++findings;
  EXPECT_EQ(findings, 21U);
}

}  // namespace
}  // namespace oblique::test
