// SPDX-License-Identifier: MIT
// Small readers of tables, written from the published formats: they share no code with the writers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <oblique/text/table_file.h>

namespace oblique::test {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// What a reader found: the names and the values of each column.
struct ReadTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// Reads a file of NumPy with fields of doubles, as numpy.lib.format describes it.
ReadTable read_npy(const std::string& bytes);
/// Reads a MAT-file of level 4 with full real matrices of doubles.
ReadTable read_mat(const std::string& bytes);
ReadTable read_json(const std::string& bytes);
/// Cells of a CSV file without quotes; an empty one is NaN.
ReadTable read_csv(const std::string& bytes);

/// A folder of its own, empty at the start and gone at the end.
class Folder {
 public:
  Folder() {
    std::string name = testing::TempDir() + "oblique-table-XXXXXX";
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(path_))
      names.push_back(entry.path().filename().string());
    return names;
  }

 private:
  std::filesystem::path path_;
};

std::vector<text::TableColumn> named(const std::vector<std::string>& names);

/// The bytes of the file of a table, its rows added in blocks of `block_rows`.
std::string written(const std::string& ending, const std::vector<text::TableColumn>& columns,
                    const std::vector<double>& values, std::size_t block_rows = 1);

}  // namespace oblique::test
