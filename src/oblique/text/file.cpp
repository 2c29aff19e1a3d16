// SPDX-License-Identifier: MIT
#include <oblique/text/file.h>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>
#include <oblique/text/encoding.h>
#include <oblique/text/new_file.h>
#include <oblique/text/output_claim.h>

namespace oblique::text {
namespace {

constexpr std::size_t kPiece = 16'384;      ///< read at once [bytes]
constexpr std::size_t kMost = 268'435'456;  ///< of a file [bytes]: a device may never end

[[noreturn]] void fail(const std::filesystem::path& path, std::string what, std::string remedy) {
  throw ReadError(Diagnostic{{path.string(), {}}, std::move(what), {}, std::move(remedy)});
}

/// Where there is no such file: the nearest name in its folder, or that the folder is missing.
std::string remedy_of_missing(const std::filesystem::path& path) {
  std::error_code error;
  std::vector<std::string> names;
  const std::filesystem::path folder = path.parent_path();
  for (auto at = std::filesystem::directory_iterator(folder.empty() ? "." : folder, error);
       !error && at != std::filesystem::directory_iterator(); at.increment(error))
    names.push_back(at->path().filename().string());
  std::sort(names.begin(), names.end());
  if (const auto nearest = nearest_name(path.filename().string(), names))
    return fmt::format("did you mean '{}'?", (folder / *nearest).string());
  if (!folder.empty() && !std::filesystem::exists(folder, error))
    return fmt::format("there is no folder '{}': check its spelling and the folder you stand in",
                       folder.string());
  return "check the spelling and the folder you stand in";
}

/// A file for reading. Not a stream of the standard library: those take a file that cannot be read any
/// further, and memory that runs out, for its end.
class OpenFile {
 public:
  explicit OpenFile(const std::filesystem::path& path)
      : descriptor_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (descriptor_ >= 0) return;
    const int reason = errno;
    fail(path, fmt::format("cannot open the file: {}", std::strerror(reason)),
         reason == ENOENT ? remedy_of_missing(path) : "check its permissions");
  }
  ~OpenFile() { close(descriptor_); }
  OpenFile(const OpenFile&) = delete;
  OpenFile& operator=(const OpenFile&) = delete;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace

std::string read_file(const std::filesystem::path& path) {
  if (path.native().find('\0') != std::string::npos)
    fail(visible(path.native()), "no file has a NUL character in its name", "correct the name");
  std::error_code ignored;
  if (std::filesystem::is_directory(path, ignored)) {
    fail(path, "this is a directory, not a file", "name a file in it");
  }
  const OpenFile file(path);
  OutputClaim::refuse_input(file.descriptor(), path);
  InputRecord::note(path);
  std::string text;
  for (std::array<char, kPiece> piece;;) {  // NOLINT(*-member-init): the system fills it
    const ssize_t length = read(file.descriptor(), piece.data(), piece.size());
    if (length == 0) return text;
    if (length > 0) text.append(piece.data(), static_cast<std::size_t>(length));
    if (text.size() > kMost) fail(path, "the file has more than 256 MiB", "split it, or leave out rows");
    if (length < 0 && errno != EINTR) {
      fail(path, fmt::format("cannot read the file: {}", std::strerror(errno)),
           "it, or the disk that it is on, may be damaged: read a copy");
    }
  }
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

}  // namespace oblique::text
