// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

// Of this stage; not installed.
namespace oblique::ensemble {

/// Tells texts apart, by 32 hexadecimal digits: XXH3 of 128 bits (xxhash.com), the same on every machine. Of
/// a million million different texts some two are taken for the same one with a probability of 1e-15. It
/// is made against accidents, not against who forges.
std::string fingerprint_of(std::string_view bytes);

/// Several texts, each with its name: neither may be taken for a part of another.
class Fingerprint {
 public:
  Fingerprint& add(std::string_view name, std::string_view bytes);
  std::string text() const { return fingerprint_of(collected_); }

 private:
  std::string collected_;
};

}  // namespace oblique::ensemble
