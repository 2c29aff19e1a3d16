// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>

#include "verbs/command.h"

namespace oblique::cli {

/// What the command line asks for.
struct Chosen {
  Session session;
  std::function<ExitStatus()> work;  ///< the verb, bound to its request
};

/// Reads the command line into `chosen`. Gives a status where there is nothing to run: --help, --version, or
/// a mistake, which it has then reported with the nearest verb or option. CLI11 is used here, in the help and
/// the descriptions of the verbs, and nowhere else.
std::optional<ExitStatus> parse_arguments(int argc, char** argv, Chosen& chosen);

}  // namespace oblique::cli
