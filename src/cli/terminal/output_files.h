// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace oblique::cli {

/// Checks that a result can be written to `path`, whose name must end with one of `endings`, and claims it
/// (OutputClaim) for as long as the program runs: whatever is read from then on is not that file, and no
/// other result goes there. Call it once for each output, before anything is read. Throws ReadError.
void check_output(const std::filesystem::path& path, std::span<const std::string_view> endings);
void check_output(const std::filesystem::path& path, std::string_view ending);

/// As `check_output`, without the claim: for what is written as often as it is asked for, with
/// `text::refuse_output` for what was read.
void check_writable(const std::filesystem::path& path, std::span<const std::string_view> endings);

/// Writes a file and says so on stderr.
void save(const std::filesystem::path& path, std::string_view text);

/// A file and what it is to hold.
struct Written {
  std::string path;
  std::string text;
};

/// Writes all files or none, and says so: they take their names when all are complete.
void save_together(const std::vector<Written>& files);

}  // namespace oblique::cli
