// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace oblique::test {

/// What a command left behind.
struct Outcome {
  int status = -1;
  std::string out;
  std::string err;
};

/// Runs a shell command in `folder`; "oblique" in it is the program under test. Colours are off. $SCRATCH is
/// an empty folder of the command's own, and "SCRATCH" stands for its name in what is left behind.
Outcome run_command(const std::string& command, const std::string& folder);

}  // namespace oblique::test
