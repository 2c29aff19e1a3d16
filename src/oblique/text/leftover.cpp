// SPDX-License-Identifier: MIT
#include <oblique/text/leftover.h>

#include <unistd.h>

#include <array>
#include <atomic>
#include <cerrno>

namespace oblique::text {
namespace {

constexpr std::size_t kMostShown = 512, kLongest = 511;

enum class Slot { free, taken, filled };

struct Remembered {
  std::atomic<Slot> slot = Slot::free;
  std::array<char, kLongest + 1> path{};
};

// A signal reaches no other, and asks for no memory.
// NOLINTNEXTLINE(*-avoid-non-const-global-variables)
std::array<Remembered, kMostShown> remembered;

static_assert(std::atomic<Slot>::is_always_lock_free, "for the handler of a signal");

}  // namespace

void Leftover::remember(std::string_view path) noexcept {
  forget();
  if (path.size() > kLongest) return;
  for (std::size_t k = 0; k < kMostShown; ++k) {
    Slot expected = Slot::free;
    if (!remembered[k].slot.compare_exchange_strong(expected, Slot::taken)) continue;
    path.copy(remembered[k].path.data(), path.size());
    remembered[k].path[path.size()] = '\0';
    remembered[k].slot = Slot::filled;
    slot_ = static_cast<std::ptrdiff_t>(k);
    return;
  }
}

void Leftover::forget() noexcept {
  if (slot_ >= 0) remembered[static_cast<std::size_t>(slot_)].slot = Slot::free;
  slot_ = -1;
}

void clear_away_leftovers() noexcept {
  const int before = errno;
  for (const Remembered& one : remembered) {
    if (one.slot == Slot::filled) unlink(one.path.data());
  }
  for (const Remembered& one : remembered) {
    if (one.slot == Slot::filled) rmdir(one.path.data());
  }
  errno = before;
}

}  // namespace oblique::text
