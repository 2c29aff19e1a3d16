// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>

namespace oblique::test {

/// Makes a folder of a test's own. No other test has it, of this checkout or of another one that is tested at
/// the same time, also where both count their processes for themselves.
inline std::filesystem::path make_scratch_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "oblique-test-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no folder could be made: " + name);
  return name;
}

/// Such a folder that is gone at the end.
class ScratchFolder {
 public:
  ScratchFolder() : path_(make_scratch_folder()) {}
  ~ScratchFolder() { std::filesystem::remove_all(path_); }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::filesystem::path& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// All bytes of a file.
inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

}  // namespace oblique::test
