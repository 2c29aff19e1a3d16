// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>

// Of this stage; not installed.
namespace oblique::ensemble {

/// Gives the next number of a queue; false where none is left.
using Next = std::function<bool(std::uint64_t& number)>;

/// Has `work` called in so many threads, the calling one among them, until the numbers from `first` on are
/// used up. An exception in any of them ends all, and is thrown again here. `progress` is called in the
/// calling thread only, with how many were given out.
void work_off(std::uint64_t first, std::uint64_t count, int threads,
              const std::function<void(const Next& next)>& work,
              const std::function<void(std::uint64_t given_out)>& progress);

}  // namespace oblique::ensemble
