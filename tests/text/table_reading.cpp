// SPDX-License-Identifier: MIT
#include "table_reading.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <stdexcept>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <oblique/text/file.h>

namespace oblique::test {
namespace {

template <class Number>
Number number_at(const std::string& bytes, std::size_t at) {
  Number number{};
  if (at + sizeof(number) > bytes.size()) throw std::runtime_error("the file ends in a number");
  std::memcpy(&number, bytes.data() + at, sizeof(number));
  return number;
}

}  // namespace

ReadTable read_npy(const std::string& bytes) {
  EXPECT_EQ(bytes.substr(0, 6), "\x93NUMPY");
  const int version = bytes.at(6);
  EXPECT_EQ(bytes.at(7), '\0');
  const std::size_t length_size = version == 1 ? 2 : 4;
  const std::size_t length =
      version == 1 ? number_at<std::uint16_t>(bytes, 8) : number_at<std::uint32_t>(bytes, 8);
  const std::size_t data = 8 + length_size + length;
  EXPECT_EQ(data % 64, 0U);
  EXPECT_EQ(bytes.at(data - 1), '\n');
  const std::string header = bytes.substr(8 + length_size, length);
  EXPECT_THAT(header, ::testing::StartsWith("{'descr': [('"));
  EXPECT_THAT(header, ::testing::HasSubstr("], 'fortran_order': False, 'shape': ("));
  ReadTable table;
  const std::string separator = ", '<f8')";
  for (std::size_t at = header.find("('"); at != std::string::npos && at < header.find("], 'fortran");) {
    std::string name;  // of a string of Python
    for (at += 2; header.at(at) != '\''; ++at) {
      if (header[at] == '\\' && header.at(++at) == 'x') {
        name += static_cast<char>(std::stoi(header.substr(at + 1, 2), nullptr, 16));
        at += 2;
      } else {
        name += header[at];
      }
    }
    EXPECT_EQ(header.substr(at + 1, separator.size()), separator);
    table.names.push_back(name);
    at = header.find("('", at);
  }
  const std::size_t rows = std::stoul(header.substr(header.find("'shape': (") + 10));
  table.columns.assign(table.names.size(), std::vector<double>(rows));
  EXPECT_EQ(bytes.size(), data + rows * table.names.size() * 8);
  std::size_t at = data;
  for (std::size_t r = 0; r < rows; ++r) {
    for (auto& column : table.columns) {
      column[r] = number_at<double>(bytes, at);
      at += 8;
    }
  }
  return table;
}

ReadTable read_mat(const std::string& bytes) {
  ReadTable table;
  std::size_t at = 0;
  while (at < bytes.size()) {
    EXPECT_EQ(number_at<std::int32_t>(bytes, at), 0) << "little endian, double, full matrix";
    const auto rows = static_cast<std::size_t>(number_at<std::int32_t>(bytes, at + 4));
    EXPECT_EQ(number_at<std::int32_t>(bytes, at + 8), 1) << "columns";
    EXPECT_EQ(number_at<std::int32_t>(bytes, at + 12), 0) << "no imaginary part";
    const auto length = static_cast<std::size_t>(number_at<std::int32_t>(bytes, at + 16));
    table.names.push_back(bytes.substr(at + 20, length - 1));
    EXPECT_EQ(bytes.at(at + 20 + length - 1), '\0');
    at += 20 + length;
    auto& column = table.columns.emplace_back(rows);
    for (double& value : column) {
      value = number_at<double>(bytes, at);
      at += 8;
    }
  }
  return table;
}

ReadTable read_json(const std::string& bytes) {
  const auto json = nlohmann::json::parse(bytes);
  EXPECT_EQ(json.size(), 2U);
  ReadTable table;
  for (const auto& column : json.at("columns")) table.names.push_back(column.at("name"));
  table.columns.resize(table.names.size());
  for (const auto& row : json.at("rows")) {
    EXPECT_EQ(row.size(), table.names.size());
    for (std::size_t c = 0; c < row.size(); ++c)
      table.columns[c].push_back(row[c].is_null() ? kNan : row[c].get<double>());
  }
  return table;
}

ReadTable read_csv(const std::string& bytes) {
  ReadTable table;
  std::istringstream lines(bytes);
  std::string line;
  const auto cells = [&] {
    std::vector<std::string> found(1);
    for (const char c : line) {
      if (c == ',')
        found.emplace_back();
      else
        found.back() += c;
    }
    return found;
  };
  std::getline(lines, line);
  table.names = cells();
  table.columns.resize(table.names.size());
  while (std::getline(lines, line)) {
    const auto row = cells();
    EXPECT_EQ(row.size(), table.names.size());
    for (std::size_t c = 0; c < row.size(); ++c)
      table.columns[c].push_back(row[c].empty() ? kNan : std::strtod(row[c].c_str(), nullptr));
  }
  return table;
}

std::vector<text::TableColumn> named(const std::vector<std::string>& names) {
  std::vector<text::TableColumn> columns;
  for (const std::string& name : names) columns.push_back({name});
  return columns;
}

std::string written(const std::string& ending, const std::vector<text::TableColumn>& columns,
                    const std::vector<double>& values, std::size_t block_rows) {
  const Folder folder;
  const auto path = folder / ("table" + ending);
  text::TableFile file(path, columns, values.size() / columns.size());
  for (std::span<const double> left(values); !left.empty();) {
    const std::size_t taken = std::min(left.size(), block_rows * columns.size());
    file.add(left.first(taken));
    left = left.subspan(taken);
  }
  file.finish();
  EXPECT_THAT(folder.files(), ::testing::ElementsAre("table" + ending));
  return text::read_file(path);
}

}  // namespace oblique::test
