// SPDX-License-Identifier: MIT
#include <oblique/text/document.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>

#include <fmt/format.h>

#include <oblique/text/new_file.h>

namespace oblique {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::string what, std::string remedy) {
  throw ReadError(Diagnostic{{path.string(), {}}, std::move(what), {}, std::move(remedy)});
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
  NewFile file(path);
  file.append(text);
  file.commit();
}

void check_ending(const std::filesystem::path& path, std::span<const std::string_view> endings) {
  const std::string ending = path.extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return;
  std::string expected(endings.front());
  for (std::size_t k = 1; k < endings.size(); ++k) {
    expected += fmt::format("{}{}", k + 1 == endings.size() ? " or " : ", ", endings[k]);
  }
  throw ReadError(Diagnostic{{path.string(), {}},
                             ending.empty() ? "the name of this file has no ending"
                                            : fmt::format("cannot write a '{}' file", ending),
                             "a name that ends in " + expected,
                             {}});
}

}  // namespace oblique
