// SPDX-License-Identifier: MIT
#include "terminal/output_files.h"

#include <cerrno>
#include <cstring>
#include <list>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

#include <oblique/text/file.h>
#include <oblique/text/new_file.h>
#include <oblique/text/output_claim.h>

#include "terminal/terminal.h"

namespace oblique::cli {
namespace {

/// For as long as the program runs.
void hold_claim(const std::filesystem::path& path) {
  static std::list<text::OutputClaim> claims;
  claims.emplace_back(path);
}

}  // namespace

void check_output(const std::filesystem::path& path, std::string_view ending) {
  check_output(path, std::span(&ending, 1));
}

void check_output(const std::filesystem::path& path, std::span<const std::string_view> endings) {
  check_writable(path, endings);
  hold_claim(path);
}

void check_writable(const std::filesystem::path& path, std::span<const std::string_view> endings) {
  text::check_ending(path, endings);
  std::error_code unknown;
  const std::filesystem::file_status status = std::filesystem::status(path, unknown);
  const bool in_a_circle = unknown == std::errc::too_many_symbolic_link_levels;
  const std::filesystem::path target = in_a_circle ? path : text::behind_links(path);
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (!std::filesystem::is_directory(folder, unknown)) {
    throw text::ReadError(text::Diagnostic{{path.string(), {}},
                                           "the folder of this file does not exist",
                                           {},
                                           fmt::format("make it first: mkdir -p {}", folder.string())});
  }
  const bool special = std::filesystem::exists(status) && !std::filesystem::is_regular_file(status);
  int reason = access(special ? path.c_str() : folder.c_str(), W_OK) == 0 ? 0 : errno;
  if (std::filesystem::is_directory(status)) reason = EISDIR;
  if (in_a_circle) reason = ELOOP;
  if (reason != 0) {
    throw text::ReadError(
        text::Diagnostic{{path.string(), {}},
                         fmt::format("this file could not be written: {}", std::strerror(reason)),
                         {},
                         "name a file in a folder that you may write to"});
  }
}

void save(const std::filesystem::path& path, std::string_view text) {
  text::write_file(path, text);
  note(fmt::format("wrote {}\n", path.string()));
}

void save_together(const std::vector<Written>& files) {
  std::list<text::NewFile> open;
  for (const Written& file : files) open.emplace_back(file.path).append(file.text);
  for (text::NewFile& file : open) file.commit();
  for (const Written& file : files) note(fmt::format("wrote {}\n", file.path));
}

}  // namespace oblique::cli
