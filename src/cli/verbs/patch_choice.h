// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <oblique/patch/patch.h>

#include "verbs/command.h"

namespace oblique::cli {

/// A finite number above 0 given as an option, in `unit`. Throws ReadError that names the option.
double positive_option(const std::string& option, const std::string& text, std::string_view unit);

/// Lets a patch by one of these methods take triads apart as --split and --slower say. Throws ReadError where
/// none of the methods does.
void take_apart(const TriadChoice& choice, const std::vector<patch::PatchMethod>& methods,
                std::vector<std::string>& split, std::optional<double>& slower);

/// The patch that --method, --gain, --bandwidth, --split and --slower ask for. Throws ReadError.
patch::PatchOptions patch_options(const PatchChoice& choice);

/// How many times --magnify enlarges the errors; nothing where it is not given. Throws ReadError.
std::optional<double> magnify_option(const std::string& text);

}  // namespace oblique::cli
