// SPDX-License-Identifier: MIT
// A machine that obeys lines of commands.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class Operate : public ::testing::Test {
 protected:
  Operate() {
    std::ofstream(folder_ / "decay.toml")
        << "format = \"oblique-diagram/1\"\n[blocks]\n"
           "x = { type = \"integrator\", in = \"-x\", initial = 1 }\n"
           "[outputs]\nside = { signal = \"x\", scale = 10, unit = \"mm\" }\n";
  }

  Outcome operate(const std::string& commands) const {
    std::ofstream(folder_ / "commands") << commands;
    return run_command("oblique operate decay.toml < commands", folder_.path().string());
  }

  std::string text_of(const std::string& file) const {
    std::ostringstream text;
    text << std::ifstream(folder_ / file).rdbuf();
    return text.str();
  }

  ScratchFolder folder_;
};

TEST_F(Operate, ReadsOutputsSignalsAndPots) {
  const Outcome done =
      operate("# nothing yet\n\n  read x   # at the start\nread side\r\nread x.initial\nquit\nread y\n");
  EXPECT_EQ(done.out, "x = 1 machine unit\nside = 10 mm\nx.initial = 1 machine unit\n");
  EXPECT_THAT(done.err, IsEmpty());
  EXPECT_EQ(done.status, 0);
}

// Each bad line is told of with its number, and the machine obeys the others.
TEST_F(Operate, GoesOnAfterBadLines) {
  const Outcome done = operate(
      "raed x\nread\nread y\nturn x.rate\nturn x.rate fast\nadvance -1\nadvance 2 kg\nscope x,y\nhold it\n"
      "restore nothing.toml\nadvance 1\nread x.rate\n");
  EXPECT_EQ(done.out, "x.rate = 1 1/s\n");
  EXPECT_EQ(done.status, 2);
  for (const char* const told :
       {"error: line 1: there is no command 'raed'\n  remedy: did you mean 'read'?",
        "error: line 2: 'read' is followed by nothing; expected read NAME",
        "error: line 3: decay.toml: there is no signal or pot 'y'",
        "error: line 4: 'turn x.rate' names no value; expected turn BLOCK.PARAMETER VALUE", "error: line 5: ",
        "error: line 6: decay.toml: the machine cannot run until -1 s; expected a time from 0 s on",
        "error: line 7: ", "error: line 8: decay.toml: there is no signal or pot 'y'",
        "error: line 9: 'hold' is followed by 'it'; expected 'hold' alone",
        "error: line 10: nothing.toml: cannot open the file"})
    EXPECT_THAT(done.err, HasSubstr(told));
  EXPECT_THAT(done.err, Not(HasSubstr("line 11")));
}

TEST_F(Operate, DrawsWithAScope) {
  const Outcome done = operate("scope side\nadvance 3\nscope\nadvance 4\n");
  EXPECT_THAT(done.out, AllOf(HasSubstr(" side"), HasSubstr("t [s]"), HasSubstr("10 ┤")));
  EXPECT_EQ(done.out.find("t [s]"), done.out.rfind("t [s]")) << "the scope was put away";
  EXPECT_EQ(done.status, 0);
}

TEST_F(Operate, ShowsItsLamps) {
  const Outcome done = operate("overloads\nturn x.initial 2\nic\noverloads\n");
  EXPECT_EQ(done.out, "no signal is beyond ±1 machine unit\nx = 2 machine unit\n");
  EXPECT_EQ(done.status, 0);
}

TEST_F(Operate, ReplacesNothingThatItsMachineWasMadeFrom) {
  std::filesystem::create_symlink("decay.toml", folder_ / "link.toml");
  const std::string before = text_of("decay.toml");
  const Outcome done = operate("advance 1\nsave decay.toml\nsave ./decay.toml\nsave link.toml\nread x\n");
  EXPECT_EQ(done.err,
            "error: line 2: decay.toml: this file is read, and would be replaced\n"
            "  remedy: write to another file\n"
            "error: line 3: ./decay.toml: this file is read, as decay.toml, and would be replaced\n"
            "  remedy: write to another file\n"
            "error: line 4: link.toml: this file is read, as decay.toml, and would be replaced\n"
            "  remedy: write to another file\n");
  EXPECT_THAT(done.out, HasSubstr("x = 0.367879"));
  EXPECT_EQ(done.status, 2);
  EXPECT_EQ(text_of("decay.toml"), before);
}

// Also where the system gives a new file the number of one that was replaced.
TEST_F(Operate, SavesUnderOneNameAsOftenAsItIsAskedTo) {
  const Outcome done = operate(
      "advance 1\nsave s.toml\nadvance 2\nsave s.toml\nadvance 3\nsave s.toml\nrestore s.toml\n"
      "save s.toml\nsave t.toml\nrestore t.toml\nsave t.toml\nadvance 4\nrestore s.toml\nread x\n");
  EXPECT_EQ(done.err, "wrote s.toml\nwrote s.toml\nwrote s.toml\nwrote s.toml\nwrote t.toml\nwrote t.toml\n");
  EXPECT_THAT(done.out, HasSubstr("x = 0.049787"));
  EXPECT_EQ(done.status, 0);
}

TEST_F(Operate, SavesAndRestores) {
  const Outcome done =
      operate("advance 1\nsave s.toml\nadvance 2\nrestore s.toml\nhold\nadvance 5\nread side\n");
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("side = 3.678794"));
  EXPECT_THAT(text_of("s.toml"), HasSubstr("time = 1\n"));
}

}  // namespace
}  // namespace oblique::test
