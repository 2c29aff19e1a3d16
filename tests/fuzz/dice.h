// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string_view>

namespace oblique::fuzz {

/// Choices that a string of bytes makes, the same on every machine; where the bytes end, each is the first
/// one.
class Dice {
 public:
  explicit Dice(std::string_view bytes) : bytes_(bytes) {}

  /// A whole number in [0, n), n at most 256.
  std::size_t below(std::size_t n) { return byte() % n; }

  /// Whether one of `n` equally probable things has come; false where the bytes have ended.
  bool one_in(std::size_t n) { return byte() % n == n - 1; }

  /// A number in [low, high]: mostly on a grid of sixteenths, so that signals meet levels and each other
  /// exactly more often than by chance.
  double number(double low, double high) {
    if (low == high) return low;
    constexpr unsigned kOnGrid = 192;
    const unsigned choice = byte();
    if (choice < kOnGrid) return low + (high - low) * static_cast<double>(choice % 17) / 16;
    return low + (high - low) * (byte() + 0.37) / 256;
  }

 private:
  unsigned byte() { return at_ < bytes_.size() ? static_cast<unsigned char>(bytes_[at_++]) : 0; }

  std::string_view bytes_;
  std::size_t at_ = 0;
};

}  // namespace oblique::fuzz
