// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "../support/process.h"
#include "../support/scratch_folder.h"

namespace oblique::test {

/// Runs the program in the folder of the sources, with files in a folder of its own.
class Verbs : public ::testing::Test {
 protected:
  Verbs() : folder_(make_scratch_folder()) { std::filesystem::create_directories(folder_); }
  ~Verbs() override { std::filesystem::remove_all(folder_); }

  static Outcome oblique(const std::string& arguments) {
    return run_command("oblique " + arguments, OBLIQUE_SOURCE_DIR);
  }
  std::string file(const std::string& name) const { return (folder_ / name).string(); }
  std::string bytes_of(const std::string& name) const {
    std::ifstream stream(folder_ / name, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }

  /// Rows of a CSV file, the header apart; empty fields are NaN.
  static std::vector<std::vector<double>> csv_rows(const std::string& path, std::string& header) {
    std::ifstream stream(path);
    std::getline(stream, header);
    std::vector<std::vector<double>> rows;
    for (std::string line; std::getline(stream, line);) {
      std::vector<double>& row = rows.emplace_back();
      std::istringstream fields(line);
      for (std::string field; std::getline(fields, field, ',');) {
        row.push_back(field.empty() ? std::nan("") : std::strtod(field.c_str(), nullptr));
      }
    }
    return rows;
  }

 private:
  std::filesystem::path folder_;
};

}  // namespace oblique::test
