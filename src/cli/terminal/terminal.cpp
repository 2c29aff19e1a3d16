// SPDX-License-Identifier: MIT
#include "terminal/terminal.h"

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

#include "terminal/memory.h"

namespace oblique::cli {
namespace {

/// See `know_options`.
std::vector<std::string>& known_options() {
  static std::vector<std::string> names;
  return names;
}

bool has_colours(int descriptor) {
  return isatty(descriptor) != 0 && std::getenv("NO_COLOR") == nullptr;
}

void write_note(std::string_view text) {
  std::fflush(stdout);  // where both go to one place, results and notes stay in order
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace

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

Progress::Progress(std::string what) : what_(std::move(what)), terminal_(isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  if (shown_) write_note("\r\033[K");
}

void Progress::show(double fraction) {
  if (!terminal_) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - begin_ < std::chrono::seconds(1) || now - last_ < std::chrono::milliseconds(200)) return;
  last_ = now;
  shown_ = true;
  constexpr double kTells = 0.02;  // of the work: less says little of the rest
  std::string left;
  if (fraction > kTells) {
    const double elapsed = std::chrono::duration<double>(now - begin_).count();
    left = fmt::format(", {:.0f} s left", std::ceil(elapsed * (1 - fraction) / fraction));
  }
  write_note(fmt::format("\r{}: {:3.0f} %{}\033[K", what_, 100 * fraction, left));
}

double quantity_option(const std::string& option, const std::string& text, std::string_view unit) {
  try {
    return text::parse_quantity(text, text::parse_unit(unit).value());
  } catch (const text::ExpressionError& error) {
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("{} {}: {}", option, text, error.what), error.expected, error.remedy});
  }
}

void know_options(std::vector<std::string> names) {
  known_options() = std::move(names);
}

const text::Vocabulary& command_line() {
  static const text::Vocabulary spelled{
      [](const text::Setting& setting) {
        const bool is_of_run = setting.name == "until" || setting.name == "tolerance";
        const std::vector<std::string>& known = known_options();
        if (is_of_run && std::count(known.begin(), known.end(), setting.name) == 0)
          return fmt::format("'{}' of [run]", setting.name);
        if (setting.value.empty()) return "--" + setting.name;
        const bool is_one_word = setting.value.find(' ') == std::string::npos;
        return is_one_word ? fmt::format("--{} {}", setting.name, setting.value)
                           : fmt::format("--{} \"{}\"", setting.name, setting.value);
      },
      [](const text::Action& action) {
        return action.subject.empty() ? fmt::format("`oblique {}`", action.name)
                                      : fmt::format("`oblique {} {}`", action.name, action.subject);
      }};
  return spelled;
}

std::string message(const text::Diagnostic& diagnostic) {
  return text::to_string(diagnostic, command_line());
}

}  // namespace oblique::cli
