// SPDX-License-Identifier: MIT
// Every read and write of every verb fails in turn, and memory runs out everywhere (tests/support/faults.cpp
// plants the faults). The promises: the program ends with a status of its own and one message that is true; a
// file is the old one or the whole new one, and nothing else is left; and where it ends well, it gives what
// it gives without a fault.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "../support/process.h"

namespace oblique::test {
namespace {

using ::testing::HasSubstr;

constexpr const char* kOld = "what stood there before";
constexpr const char* kNoMemory =
    "error: there is not enough memory for this\n"
    "  remedy: ask for fewer rows ('samples' in [run], --positions) or outputs, or split the diagram\n";

struct Call {
  const char* name;
  std::string arguments;
  const char* input = "";   ///< its name
  const char* output = "";  ///< its name; empty: the results go to stdout
};

const std::vector<Call> kCalls{
    {"Run", "run division.toml -o out.csv", "division.toml", "out.csv"},
    {"RunToMatlab", "run division.toml --until 0.1 -o out.mat", "division.toml", "out.mat"},
    {"Check", "check division.toml", "division.toml"},
    {"Rescale", "check division.toml --rescale -o out.toml", "division.toml", "out.toml"},
    {"Solve", "solve four-bar.toml --positions 5 -o out.json", "four-bar.toml", "out.json"},
    {"Modes", "modes four-bar.toml", "four-bar.toml"},
    {"Patch", "patch four-bar.toml -o out.toml", "four-bar.toml", "out.toml"},
    {"Compare", "compare four-bar.toml --gain 1e3 --json -o out.json", "four-bar.toml", "out.json"},
    {"MonteCarlo",
     "compare four-bar.toml --gain 1e3 --monte-carlo 3 --tolerance 1% --threads 2 --json -o out.json",
     "four-bar.toml", "out.json"},
    {"Sweep", "sweep division.toml --vary q.gain=1e3,1e4 --jobs 2 -o out.csv", "division.toml", "out.csv"},
    {"Report", "report four-bar.toml -o out.html", "four-bar.toml", "out.html"},
    {"ReportOnDiagram", "report division.toml -o out.html", "division.toml", "out.html"},
    {"Fit", "fit four-bar.toml --path path.csv --free AB=0.9..1.1 --starts 1 -o out.toml", "four-bar.toml",
     "out.toml"},
    {"Draw", "draw four-bar.toml -o out.svg", "four-bar.toml", "out.svg"},
    {"DrawPixels", "draw four-bar.toml -o out.png", "four-bar.toml", "out.png"},
    {"DrawDiagram", "draw division.toml -o out.svg", "division.toml", "out.svg"},
    {"Animate", "animate four-bar.toml -o out.svg", "four-bar.toml", "out.svg"},
    {"AnimatePixels", "animate four-bar.toml --frames 8 --size 100 -o out.gif", "four-bar.toml", "out.gif"},
    {"Blocks", "blocks"},
    {"Machines", "machines"},
    {"Help", "--help"},
};

void PrintTo(const Call& call, std::ostream* out) {
  *out << call.arguments;
}

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// Seconds that were measured are not the same in each run.
std::string without_times(const std::string& text) {
  static const std::regex time(R"(\b[0-9][0-9.e+-]* m?s\b)");
  return std::regex_replace(text, time, "TIME");
}

class Faults : public ::testing::TestWithParam<Call> {
 protected:
  struct Ending {
    int status = 0;  ///< below 0: the signal that ended it
    std::string out, err, file;
    long memory_calls = 0, file_calls = 0;
  };

  Faults() {
    std::string name = testing::TempDir() + "oblique-faults-XXXXXX";
    folder_ = mkdtemp(name.data());
    std::filesystem::create_directories(folder_ / "work");
    std::filesystem::create_directories(folder_ / "temporary");
    const std::filesystem::path diagrams = std::filesystem::path(OBLIQUE_SOURCE_DIR) / "diagrams";
    std::filesystem::copy_file(diagrams / "lessons/division.toml", work("division.toml"));
    std::filesystem::copy_file(diagrams / "mechanisms/four-bar.toml", work("four-bar.toml"));
    std::ofstream(work("path.csv")) << "B.x,B.y\n1.05,0\n0,1.05\n-1.05,0\n0,-1.05\n";
  }
  ~Faults() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path work(const char* name) const { return folder_ / "work" / name; }

  Ending run_with(const std::string& fault) const;
  void expect_promises(const std::string& fault, const Ending& whole) const;

  std::filesystem::path folder_;
};
INSTANTIATE_TEST_SUITE_P(Cli, Faults, ::testing::ValuesIn(kCalls),
                         [](const auto& tested) { return tested.param.name; });

/// Where SUNHashMap_New and SUNLogger_Create stand in the program (in each of the libraries of SUNDIALS there
/// is one): the one does not look whether it was given memory, the other takes down what it has not made. The
/// program finds out before that there is some.
std::string spared_code() {
  static const std::string found = [] {
    const Outcome outcome = run_command(
        "nm -S " OBLIQUE_PROGRAM " | sed -n 's/ [Tt] SUN\\(HashMap_New\\|Logger_Create\\)$//p'", "/");
    return outcome.out;
  }();
  return found;
}

Faults::Ending Faults::run_with(const std::string& fault) const {
  const char* const output = GetParam().output;
  if (*output != '\0') std::ofstream(work(output)) << kOld;
  const auto out = folder_ / "out", err = folder_ / "err", counts = folder_ / "counts";
  const std::vector<std::string> added{"LD_PRELOAD=" OBLIQUE_FAULTS,
                                       "OBLIQUE_FAULT=" + fault,
                                       "OBLIQUE_FAULT_SPARED=" + spared_code(),
                                       "OBLIQUE_FAULT_COUNTS=" + counts.string(),
                                       "TMPDIR=" + (folder_ / "temporary").string(),
                                       "NO_COLOR=1"};
  std::vector<std::string> words{OBLIQUE_PROGRAM};
  std::istringstream stream(GetParam().arguments);
  for (std::string word; stream >> word;) words.push_back(word);

  const pid_t child = fork();
  if (child == 0) {
    for (const std::string& entry : added) putenv(const_cast<char*>(entry.c_str()));
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const rlimit seconds{20, 20};  // a hang ends by a signal
    const bool ready = chdir((folder_ / "work").c_str()) == 0 && setrlimit(RLIMIT_CPU, &seconds) == 0 &&
                       dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO) >= 0 &&
                       dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO) >= 0;
    if (ready) execv(OBLIQUE_PROGRAM, arguments.data());
    _exit(127);
  }
  int code = 0;
  waitpid(child, &code, 0);
  Ending ending;
  ending.status = WIFEXITED(code) ? WEXITSTATUS(code) : -WTERMSIG(code);
  ending.out = without_times(bytes_of(out));
  ending.err = without_times(bytes_of(err));
  if (*output != '\0') ending.file = without_times(bytes_of(work(output)));
  std::ifstream(counts) >> ending.memory_calls >> ending.file_calls;
  return ending;
}

std::size_t files_in(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

std::size_t times_in(std::string_view text, std::string_view part) {
  std::size_t times = 0;
  for (std::size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++times;
  return times;
}

void Faults::expect_promises(const std::string& fault, const Ending& whole) const {
  const std::size_t files = files_in(folder_ / "work");
  const Ending ending = run_with(fault);
  SCOPED_TRACE("OBLIQUE_FAULT=" + fault + " oblique " + GetParam().arguments + "\n" + ending.err);
  EXPECT_EQ(files_in(folder_ / "work"), files);
  // Where memory is never to be had again, a folder that is being made may stay.
  if (!fault.ends_with("+")) {
    EXPECT_EQ(files_in(folder_ / "temporary"), 0U);
  }
  if (ending.status == 0) {
    EXPECT_EQ(ending.out, whole.out);
    EXPECT_EQ(ending.err, whole.err);
    EXPECT_TRUE(ending.file == whole.file) << "another file";
    return;
  }
  EXPECT_EQ(ending.status, 2);
  EXPECT_EQ(times_in(ending.err, "error:"), 1U);
  EXPECT_TRUE(ending.file == kOld || ending.file == whole.file) << "half a file";
  if (fault.starts_with("memory")) {
    EXPECT_THAT(ending.err, HasSubstr(kNoMemory));
  } else {
    EXPECT_THAT(ending.err, ::testing::ContainsRegex(
                                "(four-bar.toml|division.toml|path.csv|out\\.[a-z]*|/picture\\.[a-z]*"
                                "): (cannot (open|read|write) the file|rsvg-convert could not be "
                                "started): |could not be written to stdout|no temporary folder"));
  }
}

TEST_P(Faults, OfEachReadAndWriteAreTold) {
  const Ending whole = run_with("none:0");
  ASSERT_EQ(whole.status, 0) << whole.err;
  ASSERT_GT(whole.file_calls, 0);
  // Of an animation's frames, each of which is written and read again, the first and what follows the last.
  constexpr long kFirst = 16, kLast = 4;
  for (long call = 1; call <= whole.file_calls; ++call) {
    if (call <= kFirst || call > whole.file_calls - kLast)
      expect_promises("file:" + std::to_string(call), whole);
  }
}

// A system may give and take less than it is asked for, and may be interrupted, at any time.
TEST_P(Faults, AreNotMadeOfPieces) {
  const Ending whole = run_with("none:0");
  const Ending ending = run_with("pieces:0");
  EXPECT_EQ(ending.status, 0) << ending.err;
  EXPECT_EQ(ending.out, whole.out);
  EXPECT_TRUE(ending.file == whole.file);
}

// The calls are very many, a million in a report: some of each verb, and some of those at its end, where the
// results are written. A version of the program whose calls have other numbers meets others.
TEST_P(Faults, OfMemoryAreTold) {
  const Ending whole = run_with("none:0");
  constexpr int kSomewhere = 9, kAtTheEnd = 6;
  std::mt19937 random(20240229);
  for (int k = 0; k < kSomewhere + kAtTheEnd; ++k) {
    const long span = k < kSomewhere ? whole.memory_calls : std::min(whole.memory_calls, 600L);
    const long call = whole.memory_calls - static_cast<long>(random() % static_cast<unsigned long>(span));
    expect_promises("memory:" + std::to_string(call) + (k % 3 == 2 ? "+" : ""), whole);
  }
}

}  // namespace
}  // namespace oblique::test
