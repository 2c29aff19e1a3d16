// SPDX-License-Identifier: MIT
#include <oblique/ensemble/plan/fingerprint.h>

#include <fmt/format.h>

// Compiled in: whoever links this library needs no other for it.
#define XXH_INLINE_ALL
#include <xxhash.h>

namespace oblique::ensemble {

std::string fingerprint_of(std::string_view bytes) {
  const XXH128_hash_t hash = XXH3_128bits(bytes.data(), bytes.size());
  return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
}

Fingerprint& Fingerprint::add(std::string_view name, std::string_view bytes) {
  collected_ += fmt::format("{} {} {}\n", name.size(), name, bytes.size());
  collected_ += bytes;
  return *this;
}

}  // namespace oblique::ensemble
