// SPDX-License-Identifier: MIT
#include <oblique/text/document.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include <unistd.h>

#include <fmt/format.h>

namespace oblique {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string what, std::string remedy) {
  throw ReadError(Diagnostic{{path.string(), {}}, std::move(what), {}, std::move(remedy)});
}

[[noreturn]] void fail_to_write(const std::filesystem::path& path, int reason) {
  std::string remedy = "name a file in a folder that exists and that you may write to";
  if (reason == ENOSPC || reason == EDQUOT) remedy = "make room on the disk";
  if (reason == EISDIR) remedy = "name a file in it";
  fail(path, fmt::format("cannot write the file: {}", std::strerror(reason)), std::move(remedy));
}

/// Writes `text` to `path` as it stands; gives the reason of a failure, 0 where there is none.
int write_in_place(const std::filesystem::path& path, std::string_view text) {
  errno = 0;
  std::ofstream stream(path, std::ios::binary);
  stream.write(text.data(), static_cast<std::streamsize>(text.size()));
  stream.close();
  if (stream) return 0;
  return errno != 0 ? errno : EIO;
}

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    fail(path, "this is a directory, not a file", "name a file in it");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    const int reason = errno;
    fail(path, fmt::format("cannot open the file: {}", std::strerror(reason)),
         reason == ENOENT ? "check the spelling and the folder you stand in" : "check its permissions");
  }
  std::ostringstream text;
  text << stream.rdbuf();
  return std::move(text).str();
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (std::filesystem::is_directory(status)) fail_to_write(path, EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    // A pipe or a device (/dev/stdout, /dev/null) is written to, never replaced.
    if (const int reason = write_in_place(path, text); reason != 0) fail_to_write(path, reason);
    return;
  }
  // A link stays a link: its target is replaced.
  const bool through_link = std::filesystem::is_symlink(path, error) && std::filesystem::exists(status);
  const std::filesystem::path target = through_link ? std::filesystem::canonical(path, error) : path;
  const std::filesystem::path neighbour = target.parent_path() / fmt::format(".oblique-{}.part", getpid());
  const auto give_up = [&](int reason) {
    std::error_code ignored;
    std::filesystem::remove(neighbour, ignored);
    fail_to_write(path, reason);
  };
  if (const int reason = write_in_place(neighbour, text); reason != 0) give_up(reason);
  if (std::filesystem::exists(status)) std::filesystem::permissions(neighbour, status.permissions(), error);
  std::filesystem::rename(neighbour, target, error);
  if (error) give_up(error.value());
}

}  // namespace oblique
