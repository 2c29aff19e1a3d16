// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace oblique::text {

/// Where a name for a file leads: links are followed, also one to a file that is not there yet. Throws
/// std::system_error for links in a circle.
std::filesystem::path behind_links(std::filesystem::path path);

/// What stays the same of a file, whatever name leads to it (a link, a hard link, "./"): its device and its
/// number there; of a file that is yet to come those of its folder, and its name. Not installed.
struct FileIdentity {
  std::uint64_t device = 0, number = 0;
  std::string name;  ///< empty: the file is there
  bool operator==(const FileIdentity&) const = default;

  /// Nothing for what is no plain file (a pipe, a terminal), which is never replaced, and for a file whose
  /// folder is not there.
  static std::optional<FileIdentity> of_path(const std::filesystem::path& path);
  static std::optional<FileIdentity> of_open_file(int descriptor);
};

/// Sets a file aside as one that will be written: as long as the claim lives, `read_file` refuses it, by
/// whatever name, and so does another claim. Whoever claims what it will write before it reads anything never
/// replaces what it was made from, however deep in the work that is read. Not installed.
class OutputClaim {
 public:
  /// Throws ReadError where the file is claimed already.
  explicit OutputClaim(std::filesystem::path path);
  ~OutputClaim();
  OutputClaim(const OutputClaim&) = delete;
  OutputClaim& operator=(const OutputClaim&) = delete;

  /// Throws ReadError where the open file, an input with the name `path`, is claimed.
  static void refuse_input(int descriptor, const std::filesystem::path& path);

 private:
  std::filesystem::path path_;
  std::optional<FileIdentity> identity_;
};

/// The files that `read_file` reads as long as the record lives, on any thread: for a program that goes on
/// after it has read them, and learns only then what it is to write. Not installed.
class InputRecord {
 public:
  InputRecord();
  ~InputRecord();
  InputRecord(const InputRecord&) = delete;
  InputRecord& operator=(const InputRecord&) = delete;

  std::vector<std::filesystem::path> files() const;

  /// Tells every record of a file that is read.
  static void note(const std::filesystem::path& path);

 private:
  std::vector<std::filesystem::path> files_;
};

/// Throws ReadError where the output `path` leads to one of the files that were read.
void refuse_output(const std::filesystem::path& path, const std::vector<std::filesystem::path>& inputs);

}  // namespace oblique::text
