// SPDX-License-Identifier: MIT
// The MAT-file of MATLAB, level 4 ("MAT-File Format", chapter "Level 4 MAT-File Format"): for each variable
// five integers of 4 bytes (type, rows, columns, imaginary part, length of the name), the name with a zero
// behind it, then the numbers column by column.
#include <oblique/text/table_mat.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <limits>

#include <oblique/text/diagnostic.h>

namespace oblique::text {
namespace {

/// `namelengthmax` of MATLAB.
constexpr std::size_t kMostCharacters = 63;

/// Words that name no variable, in MATLAB (`iskeyword`) or in Octave.
constexpr std::array<std::string_view, 37> kKeywords{"break",
                                                     "case",
                                                     "catch",
                                                     "classdef",
                                                     "continue",
                                                     "do",
                                                     "else",
                                                     "elseif",
                                                     "end",
                                                     "end_try_catch",
                                                     "end_unwind_protect",
                                                     "endclassdef",
                                                     "endenumeration",
                                                     "endevents",
                                                     "endfor",
                                                     "endfunction",
                                                     "endif",
                                                     "endmethods",
                                                     "endparfor",
                                                     "endproperties",
                                                     "endswitch",
                                                     "endwhile",
                                                     "for",
                                                     "function",
                                                     "global",
                                                     "if",
                                                     "otherwise",
                                                     "parfor",
                                                     "persistent",
                                                     "return",
                                                     "spmd",
                                                     "switch",
                                                     "try",
                                                     "until",
                                                     "unwind_protect",
                                                     "unwind_protect_cleanup",
                                                     "while"};

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

/// The rules of matlab.lang.makeValidName: each character that may not stand in a name becomes '_', a keyword
/// "end" becomes "xEnd", and 'x' goes before a name that does not begin with a letter.
std::string valid_name(const std::string& name) {
  std::string valid;
  for (const char c : name) {
    const bool inside_character = (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;  // of UTF-8
    if (!inside_character) valid += is_letter(c) || (c >= '0' && c <= '9') ? c : '_';
  }
  const bool keyword = std::find(kKeywords.begin(), kKeywords.end(), valid) != kKeywords.end();
  if (!keyword && !valid.empty() && is_letter(valid[0])) return valid;
  if (keyword) valid[0] = static_cast<char>(std::toupper(valid[0]));
  return "x" + valid;
}

/// Different names for all columns; those that are good as they are stay so.
std::vector<std::string> variable_names(const std::vector<TableColumn>& columns) {
  std::vector<std::string> names(columns.size());
  std::set<std::string> taken;
  for (const bool unchanged : {true, false}) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const std::string valid = valid_name(columns[c].name);
      if ((valid == columns[c].name) == unchanged) names[c] = take_name(valid, taken, kMostCharacters);
    }
  }
  return names;
}

/// Since the number of rows is known, so is the place of every number. Rows are turned into columns in a
/// block, tile by tile, and each column of the block is written to its place.
class MatFormat : public TableFormat {
 public:
  MatFormat(NewFile& file, const std::vector<TableColumn>& columns, std::size_t rows)
      : file_(file), width_(columns.size()) {
    std::uint64_t at = 0;
    for (const std::string& name : variable_names(columns)) {
      const std::array<std::int32_t, 5> header{0, static_cast<std::int32_t>(rows), 1, 0,
                                               static_cast<std::int32_t>(name.size() + 1)};
      std::string bytes(sizeof(header) + name.size() + 1, '\0');
      std::memcpy(bytes.data(), header.data(), sizeof(header));
      std::memcpy(bytes.data() + sizeof(header), name.data(), name.size());
      file_.write_at(at, bytes);
      at += bytes.size();
      places_.push_back(at);
      at += rows * sizeof(double);
    }
    // Long pieces of the file for each call of the system, against a block that fits into a cache.
    constexpr std::size_t kBlockValues = 524'288;
    constexpr std::size_t kFewestRows = 512;
    capacity_ = std::min(rows, std::max(kFewestRows, kBlockValues / width_));
    tile_.reserve(kTileRows * width_);
    block_.resize(capacity_ * width_);
  }

  void add(std::span<const double> rows) override {
    while (!rows.empty()) {
      const std::size_t room = std::min(kTileRows, capacity_ - filled_) * width_ - tile_.size();
      const std::size_t taken = std::min(rows.size(), room);
      tile_.insert(tile_.end(), rows.begin(), rows.begin() + static_cast<std::ptrdiff_t>(taken));
      rows = rows.subspan(taken);
      if (taken == room) turn();
      if (filled_ == capacity_) flush();
    }
  }

  void finish() override {
    turn();
    flush();
  }

 private:
  /// The rows of the tile to the columns of the block.
  void turn() {
    const std::size_t rows = tile_.size() / width_;
    for (std::size_t c = 0; c < width_; ++c) {
      double* const column = block_.data() + c * capacity_ + filled_;
      for (std::size_t r = 0; r < rows; ++r) column[r] = tile_[r * width_ + c];
    }
    filled_ += rows;
    tile_.clear();
  }

  /// The columns of the block to the file.
  void flush() {
    for (std::size_t c = 0; c < width_; ++c) {
      const std::string_view bytes = bytes_of(std::span(block_).subspan(c * capacity_, filled_));
      file_.write_at(places_[c], bytes);
      places_[c] += bytes.size();
    }
    filled_ = 0;
  }

  static constexpr std::size_t kTileRows = 8;  ///< as many doubles as a line of the cache holds

  NewFile& file_;
  std::size_t width_;
  std::size_t capacity_ = 0;           ///< rows of the block
  std::size_t filled_ = 0;             ///< of these
  std::vector<std::uint64_t> places_;  ///< in the file, of the next row of each column
  std::vector<double> tile_;           ///< row by row
  std::vector<double> block_;          ///< column by column
};

}  // namespace

std::unique_ptr<TableFormat> make_mat_format(NewFile& file, const std::vector<TableColumn>& columns,
                                             std::size_t rows) {
  constexpr std::size_t kMostRows = std::numeric_limits<std::int32_t>::max();
  if (rows > kMostRows) {
    throw ReadError(
        Diagnostic{{}, "the table is too long for a .mat file", "2147483647 rows at most", "write .npy"});
  }
  return std::make_unique<MatFormat>(file, columns, rows);
}

}  // namespace oblique::text
