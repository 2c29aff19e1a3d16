// SPDX-License-Identifier: MIT
#include "process.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/wait.h>
#include <unistd.h>

namespace oblique::test {
namespace {

std::string slurp(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

std::string quoted(const std::string& path) {
  return "'" + path + "'";
}

}  // namespace

Outcome run_command(const std::string& command, const std::string& folder) {
  const auto temporary =
      std::filesystem::temp_directory_path() / ("oblique-test-" + std::to_string(getpid()));
  std::filesystem::create_directories(temporary);
  const auto out = temporary / "out", err = temporary / "err";
  const std::string program_folder = std::filesystem::path(OBLIQUE_PROGRAM).parent_path().string();
  const std::string line = "cd " + quoted(folder) + " && PATH=" + quoted(program_folder) +
                           ":$PATH NO_COLOR=1; export PATH NO_COLOR; { " + command + "; } >" +
                           quoted(out.string()) + " 2>" + quoted(err.string()) + " </dev/null";
  const int code = std::system(line.c_str());
  Outcome outcome{WIFEXITED(code) ? WEXITSTATUS(code) : -1, slurp(out), slurp(err)};
  std::filesystem::remove_all(temporary);
  return outcome;
}

}  // namespace oblique::test
