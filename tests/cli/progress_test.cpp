// SPDX-License-Identifier: MIT
// What takes longer than a second says on a terminal how far it is.
#include <array>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <regex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

namespace oblique::test {
namespace {

/// What the program shows on a terminal until `last` is seen, until its own end, or for a minute at the most.
/// It is ended then.
std::string shown_on_terminal(const std::vector<std::string>& arguments, const std::regex& last) {
  int terminal = -1;
  const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
  if (child == 0) {
    std::vector<char*> words;
    for (const std::string& word : arguments) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    if (chdir(OBLIQUE_SOURCE_DIR) == 0) execv(OBLIQUE_PROGRAM, words.data());
    _exit(127);
  }
  std::string shown;
  const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (!std::regex_search(shown, last) && std::chrono::steady_clock::now() < end) {
    pollfd waits{terminal, POLLIN, 0};
    std::array<char, 1024> bytes{};
    if (poll(&waits, 1, 100) == 0) continue;
    const ssize_t length = read(terminal, bytes.data(), bytes.size());
    if (length <= 0) break;
    shown.append(bytes.data(), static_cast<std::size_t>(length));
  }
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(terminal);
  return shown;
}

struct Long {
  const char* name;
  const char* what;
  std::vector<std::string> arguments;
};

/// So many gains, from a hundred on.
std::string gains(int count) {
  std::string all;
  for (int k = 0; k < count; ++k) all += (k > 0 ? "," : "") + std::to_string(100 + k);
  return all;
}

constexpr const char* kJansen = "diagrams/mechanisms/jansen.toml";

class Progress : public ::testing::TestWithParam<Long> {};
INSTANTIATE_TEST_SUITE_P(
    Cli, Progress,
    ::testing::Values(
        Long{"Run", "running", {"run", "diagrams/lessons/circle.toml", "--until", "1e7"}},
        Long{"Sweep", "running", {"sweep", kJansen, "--tolerance-of-elements", "0.1%", "--runs", "1000000"}},
        Long{"Gains", "comparing", {"compare", kJansen, "--gain", gains(500)}},
        Long{"Budget", "differentiating", {"compare", kJansen, "--budget", "--tolerance", "0.1%"}},
        Long{"MonteCarlo",
             "drawing elements",
             {"compare", kJansen, "--monte-carlo", "1000000", "--tolerance", "0.1%"}}),
    [](const auto& tested) { return std::string(tested.param.name); });

TEST_P(Progress, IsShownOnATerminal) {
  std::vector<std::string> command{"oblique"};
  command.insert(command.end(), GetParam().arguments.begin(), GetParam().arguments.end());
  const std::regex told(std::string("\r") + GetParam().what + ": +[0-9]+ %");
  const std::string shown = shown_on_terminal(command, told);
  EXPECT_TRUE(std::regex_search(shown, told)) << shown;
}

}  // namespace
}  // namespace oblique::test
