// SPDX-License-Identifier: MIT
#pragma once

#include <CLI/CLI.hpp>

namespace oblique::cli {

/// Lets the program and all its verbs, once they are there, tell how they are called, each with an example.
void write_help(CLI::App& app);

}  // namespace oblique::cli
