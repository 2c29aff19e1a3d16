// SPDX-License-Identifier: MIT
// The entry that libFuzzer calls; FUZZ_TARGET names one function of targets.h.
#include <cstddef>
#include <cstdint>
#include <string>

#include "targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  oblique::fuzz::FUZZ_TARGET(std::string(data, data + size));
  return 0;
}
