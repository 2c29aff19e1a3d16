// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <sys/types.h>

#include <oblique/text/leftover.h>

namespace oblique::text {

/// A file that is written out of sight and takes its name when it is complete. Before that, or where it never
/// comes to that, the file that had the name stands untouched and nothing new stands beside it: the bytes go
/// to a file without a name, which the system itself discards when the program ends, however it ends. Only
/// where the file system knows no such files they go to a neighbour of the target (a Leftover), and that
/// remains if the program is killed. A pipe or a device is written to and never replaced; a link stays a
/// link, also one to a file that is yet to come.
/// All functions throw ReadError where writing fails. Not installed.
class NewFile {
 public:
  explicit NewFile(std::filesystem::path path);
  ~NewFile();
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// Adds bytes at the end.
  void append(std::string_view bytes);
  /// Writes `bytes` from the byte `offset` on, at once; a file is either appended to or written in this way.
  void write_at(std::uint64_t offset, std::string_view bytes) const;
  /// Whether a file is to outlive a loss of power: it then takes its name when all of it is on the disk.
  enum class Lasting { no, yes };
  /// Gives the file its name.
  void commit(Lasting lasting = Lasting::yes);

 private:
  void open_beside();
  void claim_neighbour(bool link_to_open_file);
  void flush();
  void write(std::string_view bytes) const;
  void synchronise() const;
  [[noreturn]] void fail(int reason) const;

  std::filesystem::path path_;       ///< as given, for messages
  std::filesystem::path target_;     ///< what is replaced; empty where the path is written to itself
  std::filesystem::path neighbour_;  ///< the name until then; empty where there is none
  Leftover leftover_;                ///< the neighbour
  std::optional<std::filesystem::perms> permissions_;  ///< of the file that is replaced
  int descriptor_ = -1;
  std::string buffer_;
};

}  // namespace oblique::text
