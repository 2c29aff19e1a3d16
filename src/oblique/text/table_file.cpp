// SPDX-License-Identifier: MIT
#include <oblique/text/table_file.h>

#include <algorithm>
#include <stdexcept>

#include <fmt/format.h>

#include <oblique/text/file.h>
#include <oblique/text/new_file.h>
#include <oblique/text/table_mat.h>
#include <oblique/text/table_npy.h>
#include <oblique/text/table_text.h>

namespace oblique::text {
namespace {

MakeTableFormat& format_of(const std::filesystem::path& path) {
  constexpr std::array<MakeTableFormat*, kTableEndings.size()> kFormats{make_csv_format, make_npy_format,
                                                                        make_mat_format, make_json_format};
  check_ending(path, kTableEndings);
  const auto* const found = std::find(kTableEndings.begin(), kTableEndings.end(), path.extension().string());
  return *kFormats[static_cast<std::size_t>(found - kTableEndings.begin())];
}

}  // namespace

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
