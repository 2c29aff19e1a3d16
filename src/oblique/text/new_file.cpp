// SPDX-License-Identifier: MIT
#include <oblique/text/new_file.h>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>
#include <oblique/text/output_claim.h>

namespace oblique::text {
namespace {

/// What is smaller is collected: large enough that the system's work for a call does not count, small enough
/// for a processor's cache.
constexpr std::size_t kBufferSize = 262'144;
/// As of any new file; the user's mask takes away from it.
constexpr mode_t kMode = 0666;

/// The name by which the system knows an open file.
std::string name_of(int descriptor) {
  return fmt::format("/proc/self/fd/{}", descriptor);
}

}  // namespace

NewFile::NewFile(std::filesystem::path path) : path_(std::move(path)) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path_, error);
  if (std::filesystem::is_directory(status)) fail(EISDIR);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY);
    if (descriptor_ < 0) fail(errno);
    return;
  }
  if (std::filesystem::exists(status)) permissions_ = status.permissions();
  try {
    target_ = behind_links(path_);
  } catch (const std::system_error& circle) {
    fail(circle.code().value());
  }
  open_beside();
}

NewFile::~NewFile() {
  if (descriptor_ >= 0) close(descriptor_);
  if (!neighbour_.empty()) unlink(neighbour_.c_str());
}

void NewFile::open_beside() {
  const std::string folder = target_.has_parent_path() ? target_.parent_path().string() : ".";
  descriptor_ = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, kMode);
  if (descriptor_ >= 0 && access(name_of(descriptor_).c_str(), F_OK) != 0) {
    close(descriptor_);  // it could never be given a name
    descriptor_ = -1;
  }
  if (descriptor_ < 0) claim_neighbour(false);
}

/// Takes the first free name beside the target: for the open file, or for one that is opened by it. A name
/// that is taken is moved to where it is kept: a copy could fail for lack of memory, and the file would stay.
void NewFile::claim_neighbour(bool link_to_open_file) {
  for (int k = 0;; ++k) {
    std::filesystem::path name = target_.parent_path() / fmt::format(".oblique-{}-{}.part", getpid(), k);
    if (link_to_open_file) {
      if (linkat(AT_FDCWD, name_of(descriptor_).c_str(), AT_FDCWD, name.c_str(), AT_SYMLINK_FOLLOW) == 0) {
        neighbour_ = std::move(name);
        leftover_.remember(neighbour_.native());
        return;
      }
    } else {
      descriptor_ = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
      if (descriptor_ >= 0) {
        neighbour_ = std::move(name);
        leftover_.remember(neighbour_.native());
        return;
      }
    }
    if (errno != EEXIST) fail(errno);
  }
}

void NewFile::append(std::string_view bytes) {
  if (buffer_.size() + bytes.size() > kBufferSize) flush();
  if (bytes.size() >= kBufferSize) {
    write(bytes);
    return;
  }
  if (buffer_.empty()) buffer_.reserve(kBufferSize);
  buffer_.append(bytes);
}

void NewFile::flush() {
  write(buffer_);
  buffer_.clear();
}

void NewFile::write(std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
    if (written < 0 && errno != EINTR) fail(errno);
    if (written > 0) bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

void NewFile::write_at(std::uint64_t offset, std::string_view bytes) const {
  while (!bytes.empty()) {
    const ssize_t written = pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(offset));
    if (written < 0 && errno != EINTR) fail(errno);
    if (written <= 0) continue;
    bytes.remove_prefix(static_cast<std::size_t>(written));
    offset += static_cast<std::uint64_t>(written);
  }
}

/// What a disk does not do (a pipe, some file systems) need not be waited for.
void NewFile::synchronise() const {
  if (fsync(descriptor_) != 0 && errno != EINVAL && errno != ENOTSUP) fail(errno);
}

void NewFile::commit(Lasting lasting) {
  flush();
  if (!target_.empty()) {
    if (lasting == Lasting::yes) synchronise();
    // As far as the file system knows permissions.
    if (permissions_) static_cast<void>(fchmod(descriptor_, static_cast<mode_t>(*permissions_)));
    if (neighbour_.empty()) claim_neighbour(true);
  }
  if (close(std::exchange(descriptor_, -1)) != 0) fail(errno);  // a disk on a network may be full only now
  if (target_.empty()) return;
  if (std::rename(neighbour_.c_str(), target_.c_str()) != 0) fail(errno);
  neighbour_.clear();
  leftover_.forget();
}

void NewFile::fail(int reason) const {
  std::string remedy = "name a file in a folder that exists and that you may write to";
  if (reason == ENOSPC || reason == EDQUOT) remedy = "make room on the disk";
  if (reason == ELOOP) remedy = "name a file: this link leads back to itself";
  if (reason == EISDIR) remedy = "name a file in it";
  if (reason == ESPIPE) remedy = "name a file on a disk: this format is not written in one pass";
  throw ReadError(Diagnostic{{path_.string(), {}},
                             fmt::format("cannot write the file: {}", std::strerror(reason)),
                             {},
                             std::move(remedy)});
}

}  // namespace oblique::text
