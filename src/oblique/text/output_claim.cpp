// SPDX-License-Identifier: MIT
#include <oblique/text/output_claim.h>

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <mutex>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>

namespace oblique::text {
namespace {

/// What is claimed in this program, by any of its threads.
struct Claims {
  std::mutex mutex;
  std::vector<const OutputClaim*> all;
};

// Claims may live as long as the program does, and so does this: what a function holds would end before them.
// NOLINTNEXTLINE(*-avoid-non-const-global-variables)
Claims claims;

/// The records that are kept in this program, by any of its threads.
struct Records {
  std::mutex mutex;
  std::vector<InputRecord*> all;
};

// As the claims.
// NOLINTNEXTLINE(*-avoid-non-const-global-variables)
Records records;

[[noreturn]] void refuse(const std::filesystem::path& output, const std::filesystem::path& input) {
  const std::string alias = output == input ? "" : fmt::format(", as {}", input.string());
  throw ReadError(Diagnostic{{output.string(), {}},
                             fmt::format("this file is read{}, and would be replaced", alias),
                             {},
                             "write to another file"});
}

std::optional<FileIdentity> identity_of(const struct stat& status) {
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino, {}};
}

}  // namespace

std::filesystem::path behind_links(std::filesystem::path path) {
  constexpr int kMostLinks = 40;  // as Linux has it
  std::error_code none;
  for (int k = 0; std::filesystem::is_symlink(path, none); ++k) {
    if (k == kMostLinks) throw std::system_error(ELOOP, std::generic_category());
    const std::filesystem::path next = std::filesystem::read_symlink(path);
    path = next.is_absolute() ? next : path.parent_path() / next;
  }
  return path;
}

std::optional<FileIdentity> FileIdentity::of_path(const std::filesystem::path& path) {
  struct stat status {};
  if (stat(path.c_str(), &status) == 0) return identity_of(status);
  if (errno != ENOENT) return std::nullopt;
  const std::filesystem::path target = behind_links(path);
  const std::filesystem::path folder = target.has_parent_path() ? target.parent_path() : ".";
  if (stat(folder.c_str(), &status) != 0) return std::nullopt;
  return FileIdentity{status.st_dev, status.st_ino, target.filename().string()};
}

std::optional<FileIdentity> FileIdentity::of_open_file(int descriptor) {
  struct stat status {};
  return fstat(descriptor, &status) == 0 ? identity_of(status) : std::nullopt;
}

OutputClaim::OutputClaim(std::filesystem::path path)
    : path_(std::move(path)), identity_(FileIdentity::of_path(path_)) {
  const std::scoped_lock lock(claims.mutex);
  for (const OutputClaim* other : claims.all) {
    if (!identity_ || other->identity_ != identity_) continue;
    throw ReadError(
        Diagnostic{{path_.string(), {}}, "two results would go to this file", {}, "name two files"});
  }
  claims.all.push_back(this);
}

OutputClaim::~OutputClaim() {
  const std::scoped_lock lock(claims.mutex);
  std::erase(claims.all, this);
}

void OutputClaim::refuse_input(int descriptor, const std::filesystem::path& path) {
  const std::scoped_lock lock(claims.mutex);
  if (claims.all.empty()) return;
  const std::optional<FileIdentity> identity = FileIdentity::of_open_file(descriptor);
  for (const OutputClaim* claim : claims.all) {
    if (identity && claim->identity_ == identity) refuse(claim->path_, path);
  }
}

InputRecord::InputRecord() {
  const std::scoped_lock lock(records.mutex);
  records.all.push_back(this);
}

InputRecord::~InputRecord() {
  const std::scoped_lock lock(records.mutex);
  std::erase(records.all, this);
}

std::vector<std::filesystem::path> InputRecord::files() const {
  const std::scoped_lock lock(records.mutex);
  return files_;
}

void InputRecord::note(const std::filesystem::path& path) {
  const std::scoped_lock lock(records.mutex);
  for (InputRecord* record : records.all) record->files_.push_back(path);
}

void refuse_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs) {
  const std::optional<FileIdentity> identity = FileIdentity::of_path(path);
  if (!identity) return;
  for (const std::filesystem::path& input : inputs) {
    if (FileIdentity::of_path(input) == identity) refuse(path, input);
  }
}

}  // namespace oblique::text
