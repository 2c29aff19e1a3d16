// SPDX-License-Identifier: MIT
#include "process.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <sys/wait.h>
#include "scratch_folder.h"

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
  const ScratchFolder outputs, scratch;
  const auto out = outputs / "out", err = outputs / "err";
  const std::string program_folder = std::filesystem::path(OBLIQUE_PROGRAM).parent_path().string();
  const std::string line = "cd " + quoted(folder) + " && PATH=" + quoted(program_folder) +
                           ":$PATH NO_COLOR=1 SCRATCH=" + quoted(scratch.path().string()) +
                           "; export PATH NO_COLOR; { " + command + "; } >" + quoted(out.string()) + " 2>" +
                           quoted(err.string()) + " </dev/null";
  const int code = std::system(line.c_str());
  Outcome outcome{WIFEXITED(code) ? WEXITSTATUS(code) : -1, slurp(out), slurp(err)};
  for (std::string* const text : {&outcome.out, &outcome.err}) {
    const std::string name = scratch.path().string();
    for (std::size_t at = 0; (at = text->find(name, at)) != text->npos;)
      text->replace(at, name.size(), "SCRATCH");
  }
  return outcome;
}

}  // namespace oblique::test
