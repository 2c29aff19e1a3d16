// SPDX-License-Identifier: MIT
// The .npy format of NumPy (numpy.lib.format, "NPY format"): a magic string, the version, the length of the
// header, the header (a Python dictionary, padded with blanks so that the data begin at a multiple of 64
// bytes), then the records.
#include <oblique/text/table_npy.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include <fmt/format.h>

namespace oblique::text {
namespace {

/// A string of Python.
std::string python_string(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20U || code == 0x7FU) {
      quoted += fmt::format("\\x{:02x}", code);
      continue;
    }
    if (c == '\'' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "'";
}

/// `bytes` of a number, the least significant one first.
std::string little_endian(std::size_t number, int bytes) {
  std::string text;
  for (int k = 0; k < bytes; ++k) text += static_cast<char>(number >> (8 * k) & 0xFFU);
  return text;
}

/// Version 1.0, in which the header is of ASCII (so far as Oblique is concerned) and shorter than 64 KiB; a
/// longer one wants version 2.0 and other letters version 3.0, where it is of UTF-8.
std::string preamble(const std::vector<TableColumn>& columns, std::size_t rows) {
  std::string fields;
  std::set<std::string> taken;
  for (const TableColumn& column : columns) {
    const std::string name = take_name(column.name, taken, std::string::npos);
    fields += fmt::format("{}({}, '<f8')", fields.empty() ? "" : ", ", python_string(name));
  }
  std::string header =
      fmt::format("{{'descr': [{}], 'fortran_order': False, 'shape': ({},), }}", fields, rows);
  const bool ascii =
      std::all_of(header.begin(), header.end(), [](char c) { return static_cast<unsigned char>(c) < 0x80U; });
  constexpr std::size_t kAlignment = 64;
  constexpr std::size_t kMagicSize = 8;
  const auto finish = [&](char version, int length_size) {
    const std::size_t before = kMagicSize + static_cast<std::size_t>(length_size);
    const std::size_t blanks = kAlignment - 1 - (before + header.size()) % kAlignment;
    const std::string padded = header + std::string(blanks, ' ') + "\n";
    const std::string magic = std::string("\x93NUMPY") + version + '\0';
    return magic + little_endian(padded.size(), length_size) + padded;
  };
  if (!ascii) return finish(3, 4);
  const bool fits = header.size() + kAlignment <= std::numeric_limits<std::uint16_t>::max();
  return fits ? finish(1, 2) : finish(2, 4);
}

class NpyFormat : public TableFormat {
 public:
  explicit NpyFormat(NewFile& file) : file_(file) {}
  void add(std::span<const double> rows) override { file_.append(bytes_of(rows)); }
  void finish() override {}

 private:
  NewFile& file_;
};

}  // namespace

std::unique_ptr<TableFormat> make_npy_format(NewFile& file, const std::vector<TableColumn>& columns,
                                             std::size_t rows) {
  file.append(preamble(columns, rows));
  return std::make_unique<NpyFormat>(file);
}

}  // namespace oblique::text
