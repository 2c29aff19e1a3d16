// SPDX-License-Identifier: MIT
#include <oblique/report/text_table.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::report {
namespace {

/// Width on a terminal, near enough: code points.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace

std::string Table::text(std::size_t left_columns) const {
  std::vector<std::size_t> widths(rows_.front().size(), 0);
  for (const auto& row : rows_) {
    for (std::size_t c = 0; c < row.size(); ++c) widths[c] = std::max(widths[c], width(row[c]));
  }
  std::string out;
  for (const auto& row : rows_) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c) {
      const std::string padding(widths[c] - width(row[c]), ' ');
      if (c > 0) line += "  ";
      line += c < left_columns ? row[c] + padding : padding + row[c];
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

std::vector<std::size_t> spread_rows(std::size_t rows, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t shown = std::min(rows, most);
  for (std::size_t k = 0; k < shown; ++k) chosen.push_back(shown == 1 ? 0 : k * (rows - 1) / (shown - 1));
  return chosen;
}

std::string short_number(double value, double scale) {
  constexpr double kRounding = 1e-14;
  if (std::isnan(value)) return {};
  return fmt::format("{:.6g}", value == 0 || std::abs(value) < kRounding * scale ? 0.0 : value);
}

std::string count(std::size_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

}  // namespace oblique::report
