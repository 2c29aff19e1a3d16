// SPDX-License-Identifier: MIT
#include <oblique/text/table_file.h>

#include <algorithm>
#include <bit>
#include <stdexcept>

#include <fmt/format.h>

#include <oblique/text/document.h>
#include <oblique/text/table_format.h>

namespace oblique::text {
namespace {

static_assert(std::endian::native == std::endian::little,
              "the binary formats are written as they stand here");

MakeTableFormat& format_of(const std::filesystem::path& path) {
  constexpr std::array<MakeTableFormat*, kTableEndings.size()> kFormats{make_csv_format, make_npy_format,
                                                                        make_mat_format, make_json_format};
  check_ending(path, kTableEndings);
  const auto* const found = std::find(kTableEndings.begin(), kTableEndings.end(), path.extension().string());
  return *kFormats[static_cast<std::size_t>(found - kTableEndings.begin())];
}

}  // namespace

std::string_view bytes_of(std::span<const double> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

std::string take_name(const std::string& name, std::set<std::string>& taken, std::size_t most) {
  std::string free = name.substr(0, most);
  for (int k = 1; !taken.insert(free).second; ++k) {
    const std::string number = fmt::format("_{}", k);
    free = name.substr(0, most - number.size()) + number;
  }
  return free;
}

TableFile::TableFile(const std::filesystem::path& path, std::vector<TableColumn> columns, std::size_t rows)
    : columns_(std::move(columns)), values_left_(columns_.size() * rows) {
  if (columns_.empty()) throw std::logic_error("a table without columns");
  MakeTableFormat& make = format_of(path);
  file_ = std::make_unique<NewFile>(path);
  format_ = make(*file_, columns_, rows);
}

TableFile::~TableFile() = default;

void TableFile::add(std::span<const double> rows) {
  if (rows.size() % columns_.size() != 0 || rows.size() > values_left_) {
    throw std::logic_error(fmt::format("{} values for a table of {} columns that lacks {} values",
                                       rows.size(), columns_.size(), values_left_));
  }
  values_left_ -= rows.size();
  format_->add(rows);
}

void TableFile::finish() {
  if (values_left_ > 0) throw std::logic_error(fmt::format("the table lacks {} values", values_left_));
  format_->finish();
  file_->commit();
}

}  // namespace oblique::text
