// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/philox.h>

namespace oblique::ensemble {

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  constexpr std::uint64_t kFirstFactor = 0xD2511F53, kSecondFactor = 0xCD9E8D57;
  constexpr std::uint32_t kFirstStep = 0x9E3779B9, kSecondStep = 0xBB67AE85;
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::uint64_t first = kFirstFactor * counter[0], second = kSecondFactor * counter[2];
    counter = {
        static_cast<std::uint32_t>(second >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(second),
        static_cast<std::uint32_t>(first >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(first)};
    key[0] += kFirstStep;
    key[1] += kSecondStep;
  }
  return counter;
}

double uniform(const DrawKey& key, std::uint32_t which, std::uint32_t what) {
  const auto low = [](std::uint64_t value) { return static_cast<std::uint32_t>(value); };
  const auto high = [](std::uint64_t value) { return static_cast<std::uint32_t>(value >> 32); };
  const auto bits = philox({low(key.run), high(key.run), which, what}, {low(key.seed), high(key.seed)});
  const std::uint64_t all = (static_cast<std::uint64_t>(bits[0]) << 32) | bits[1];
  return static_cast<double>(all >> 11) * 0x1p-53;
}

}  // namespace oblique::ensemble
