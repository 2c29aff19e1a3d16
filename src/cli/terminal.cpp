// SPDX-License-Identifier: MIT
#include "terminal.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <new>

#include <fcntl.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <fmt/format.h>

#include <oblique/text/encoding.h>
#include <oblique/text/quantity.h>

#include "memory.h"

namespace oblique::cli {
namespace {

/// Width on a terminal, near enough: code points.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

bool has_colours(int descriptor) {
  return isatty(descriptor) != 0 && std::getenv("NO_COLOR") == nullptr;
}

void write_note(std::string_view text) {
  std::fflush(stdout);  // where both go to one place, results and notes stay in order
  std::fwrite(text.data(), 1, text.size(), stderr);
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

std::size_t terminal_width(std::size_t otherwise) {
  winsize size{};
  const bool known =
      isatty(STDOUT_FILENO) != 0 && ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : otherwise;
}

std::size_t columns_that_fit(std::size_t column_width) {
  return std::max<std::size_t>(2, terminal_width(110) / column_width);
}

bool stdout_has_colours() {
  return has_colours(STDOUT_FILENO);
}

std::string short_number(double value, double scale) {
  constexpr double kRounding = 1e-14;
  if (std::isnan(value)) return {};
  return fmt::format("{:.6g}", value == 0 || std::abs(value) < kRounding * scale ? 0.0 : value);
}

void print(std::string_view text) {
  print_coloured(text::is_visible(text) ? std::string(text) : text::visible(text));
}

void print_coloured(std::string_view text) {
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void keep_stdout() {
  if (fcntl(STDOUT_FILENO, F_GETFD) >= 0) return;
  const int nothing = open("/dev/null", O_RDONLY);  // to which nothing can be written
  if (nothing >= 0 && nothing != STDOUT_FILENO) {
    dup2(nothing, STDOUT_FILENO);
    close(nothing);
  }
}

bool results_are_written() {
  return std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
}

std::string count(std::size_t n, std::string_view one, std::string_view many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

void note(std::string_view text) {
  if (text::is_visible(text)) {
    write_note(text);
  } else {
    write_note(text::visible(text));
  }
}

void print_error_mark() {
  write_note(has_colours(STDERR_FILENO) ? "\033[1;31merror:\033[0m " : "error: ");
}

void print_error(std::string_view text) {
  if (memory_ran_out()) throw std::bad_alloc();  // the finding may be for the lack of it
  const std::string line = fmt::format("{}\n", text);
  print_error_mark();
  note(line);
}

Progress::~Progress() {
  if (shown_) write_note("\r\033[K");
}

void Progress::show(double fraction) {
  if (isatty(STDERR_FILENO) == 0) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - begin_ < std::chrono::seconds(1) || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  shown_ = true;
  write_note(fmt::format("\r{}: {:3.0f} %\033[K", what_, 100 * fraction));
}

double quantity_option(const std::string& option, const std::string& text, std::string_view unit) {
  try {
    return text::parse_quantity(text, text::parse_unit(unit).value());
  } catch (const text::ExpressionError& error) {
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("{} {}: {}", option, text, error.what), error.expected, error.remedy});
  }
}

}  // namespace oblique::cli
