// SPDX-License-Identifier: MIT
// A program that is told to end does, by the signal that told it, and leaves nothing half done behind.
#include <array>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <oblique/text/leftover.h>

#include "../../src/cli/terminal/signals.h"
#include "../support/scratch_folder.h"

namespace oblique::test {
namespace {

/// Waits up to half a minute.
template <class Condition>
bool comes_true(const Condition& condition) {
  for (int k = 0; k < 3000; ++k) {
    if (condition()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

class Signalled : public ::testing::Test {
 protected:
  Signalled() {
    for (const char* name : {"temporary", "programs", "work"})
      std::filesystem::create_directory(folder_ / name);
    // Drawing goes on and on, as a large picture's does.
    std::ofstream(folder_ / "programs/rsvg-convert") << "#!/bin/sh\nexec sleep 60\n";
    std::filesystem::permissions(folder_ / "programs/rsvg-convert", std::filesystem::perms::owner_all);
  }

  /// Starts the program in a group of its own, as a shell does.
  pid_t start(const std::vector<std::string>& arguments) const {
    const pid_t child = fork();
    if (child != 0) return child;
    setpgid(0, 0);
    std::signal(SIGINT, SIG_DFL);
    setenv("TMPDIR", (folder_ / "temporary").c_str(), 1);
    setenv("PATH", ((folder_ / "programs").string() + ":" + std::getenv("PATH")).c_str(), 1);
    std::vector<char*> words;
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    if (chdir((folder_ / "work").c_str()) == 0) execv(OBLIQUE_PROGRAM, words.data());
    _exit(127);
  }

  ScratchFolder folder_;
};
class Signals : public Signalled, public testing::WithParamInterface<int> {};
INSTANTIATE_TEST_SUITE_P(Cli, Signals, ::testing::Values(SIGINT, SIGTERM, SIGHUP));

TEST_P(Signals, LeaveNothingOfAPictureInTheMaking) {
  const std::string mechanism = std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/four-bar.toml";
  const pid_t child = start({"oblique", "draw", mechanism, "-o", "x.png"});
  ASSERT_TRUE(comes_true([&] { return !std::filesystem::is_empty(folder_ / "temporary"); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // until the converter runs
  kill(-child, GetParam());                                     // as a terminal does
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == GetParam()) << status;
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "temporary"));
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "work"));
}

/// Waits until a child has ended, a while at most, and gives its status; nothing where it goes on.
std::optional<int> ended(pid_t child) {
  int status = 0;
  const bool done = comes_true([&] { return waitpid(child, &status, WNOHANG) == child; });
  return done ? std::optional(status) : std::nullopt;
}

// What 200 comparisons of sin(10⁶ x) with 2 do is looked for through every turn: of x = t the solver takes
// steps that are ten times as long as the ones before, and is minutes in each.
TEST_F(Signalled, SaveTheLastWholeStepOfARunThatIsInterruptedWithinOne) {
  std::filesystem::create_directory(folder_ / "work/blocks");
  std::ofstream(folder_ / "work/blocks/turns.toml")
      << "format = \"oblique-block/1\"\ntitle = \"Turns\"\n[inputs]\nin = {}\n[outputs]\nout = {}\n"
         "[equations]\nout = \"if(sin(1e6*in) > 2, 1, 0)\"\n";
  {
    std::ofstream diagram(folder_ / "work/d.toml");
    diagram << "format = \"oblique-diagram/1\"\n[run]\nuntil = 100\n[blocks]\n"
               "one = { type = \"constant\", value = 1 }\nx = { type = \"integrator\", in = \"one\" }\n";
    for (int k = 0; k < 200; ++k) {
      diagram << "s" << k << " = { type = \"turns\", in = \"x\" }\n"
              << "y" << k << " = { type = \"integrator\", in = \"s" << k << "\" }\n";
    }
    diagram << "[outputs]\nx = { signal = \"x\" }\n";
  }
  const pid_t child =
      start({"oblique", "--blocks", "blocks", "run", "d.toml", "--save", "state.toml", "-o", "x.csv"});
  std::this_thread::sleep_for(std::chrono::seconds(3));
  const auto asked = std::chrono::steady_clock::now();
  kill(child, SIGINT);
  const std::optional<int> status = ended(child);
  const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - asked;
  if (!status) kill(child, SIGKILL);
  ASSERT_TRUE(status && WIFEXITED(*status)) << status.value_or(-1);
  EXPECT_EQ(WEXITSTATUS(*status), 0);
  EXPECT_LT(waited.count(), 5);  // a hundredth of a second; sanitizers and a busy machine take more
  std::ifstream stream(folder_ / "work/state.toml");
  const std::string state{std::istreambuf_iterator<char>(stream), {}};
  std::smatch time, x;
  ASSERT_TRUE(std::regex_search(state, time, std::regex(R"(\ntime = (\S+))"))) << state;
  ASSERT_TRUE(std::regex_search(state, x, std::regex(R"(\n"?x"? = (\S+))"))) << state;
  const double at = std::stod(time[1]);
  EXPECT_GT(at, 0);
  EXPECT_LT(at, 100);
  EXPECT_NEAR(std::stod(x[1]), at, 1e-8 * at);  // x = t
  // And the run goes on from there.
  char until[40];
  snprintf(until, sizeof until, "%.17g", 1.001 * at);
  const pid_t next =
      start({"oblique", "--blocks", "blocks", "run", "d.toml", "--from", "state.toml", "--until", until});
  const std::optional<int> went_on = ended(next);
  if (!went_on) kill(next, SIGKILL);
  EXPECT_EQ(went_on, 0);
}

// The first Ctrl-C asks for the end of the run, the second does not ask.
TEST_F(Signalled, AskFirstWhereTheRunIsSavedAndThenEndIt) {
  std::ofstream(folder_ / "work/part") << "half";
  std::array<int, 2> said{};
  ASSERT_EQ(pipe(said.data()), 0);
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGINT, SIG_DFL);  // who runs the tests in the background has it ignored
    dup2(said[1], STDERR_FILENO);
    text::Leftover part;
    part.remember((folder_ / "work/part").native());
    cli::end_in_order_on_signals();
    const cli::InterruptGuard guard;
    if (cli::InterruptGuard::asked()) _exit(1);
    std::raise(SIGINT);
    if (!cli::InterruptGuard::asked() || !std::filesystem::exists(folder_ / "work/part")) _exit(2);
    std::raise(SIGINT);
    _exit(3);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) << status;
  EXPECT_TRUE(std::filesystem::is_empty(folder_ / "work"));
  std::string text(100, ' ');
  text.resize(static_cast<std::size_t>(read(said[0], text.data(), text.size())));
  EXPECT_EQ(text, "interrupting; Ctrl-C once more ends at once\n");
}

}  // namespace
}  // namespace oblique::test
