// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/text/diagnostic.h>
#include <oblique/text/expression.h>

namespace oblique::cli {

/// How many columns of `width` characters a table may have on this terminal (110 characters where there is
/// none).
std::size_t columns_that_fit(std::size_t width);

/// Characters in a line of this terminal, or `otherwise` where stdout is none.
std::size_t terminal_width(std::size_t otherwise);

/// Whether stdout is a terminal that wants colours (NO_COLOR).
bool stdout_has_colours();

/// Writes results to stdout, `visible`: nothing that stands in a file commands the terminal.
void print(std::string_view text);

/// The same of a text whose colours are escapes of our own.
void print_coloured(std::string_view text);

/// Keeps the number of stdout taken where the caller has closed it, so that no file is opened in its place.
void keep_stdout();

/// Whether everything printed so far has reached stdout.
bool results_are_written();

/// Writes anything else to stderr, `visible`.
void note(std::string_view text);

/// Writes an error to stderr, "error:" in red where that is a terminal that wants colours (NO_COLOR).
void print_error(std::string_view text);

/// The word before it, for those who write the text themselves with `note`; takes no memory.
void print_error_mark();

/// A line on stderr that shows how far work of more than a second has come; nothing where stderr is no
/// terminal.
class Progress {
 public:
  explicit Progress(std::string what);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void show(double fraction);

 private:
  std::string what_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
  std::chrono::steady_clock::time_point last_ = begin_;
  bool terminal_;  ///< whether there is one, to which it is shown
  bool shown_ = false;
};

/// A quantity given as an option, in `unit`. Throws ReadError that names the option.
double quantity_option(const std::string& option, const std::string& text, std::string_view unit);

/// What the verb that was asked for can be given, without the dashes.
void know_options(std::vector<std::string> names);

/// How this program spells settings and actions: "--until", or "'until' of [run]" where the verb has no such
/// option; "`oblique check FILE`".
const text::Vocabulary& command_line();

/// A diagnostic in these words.
std::string message(const text::Diagnostic& diagnostic);

}  // namespace oblique::cli
