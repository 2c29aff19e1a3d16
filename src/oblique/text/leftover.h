// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace oblique::text {

/// A file or a folder that is to go before the program ends, however it ends: as long as this lives,
/// `clear_away_leftovers` deletes it. Takes no memory. Not installed.
class Leftover {
 public:
  Leftover() = default;
  ~Leftover() { forget(); }
  Leftover(const Leftover&) = delete;
  Leftover& operator=(const Leftover&) = delete;

  /// Of the path that there is from now on. What is too long or one too many (of hundreds) is not cleared
  /// away.
  void remember(std::string_view path) noexcept;
  void forget() noexcept;

 private:
  std::ptrdiff_t slot_ = -1;
};

/// Deletes what is remembered, folders last. For the handler of a signal, where hardly anything else may be
/// called.
void clear_away_leftovers() noexcept;

}  // namespace oblique::text
