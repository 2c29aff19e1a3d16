// SPDX-License-Identifier: MIT
#include <oblique/ensemble/engine/work_queue.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>

namespace oblique::ensemble {
namespace {

/// Threads whose end is waited for. (Not every standard library has `std::jthread`.)
class Threads {
 public:
  Threads() = default;
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;
  ~Threads() {
    for (std::thread& thread : threads_) thread.join();
  }

  /// Throws std::system_error where there are no more to be had.
  template <class Work>
  void begin(Work work) {
    threads_.emplace_back(std::move(work));
  }

 private:
  std::vector<std::thread> threads_;
};

}  // namespace

void work_off(std::uint64_t first, std::uint64_t count, int threads,
              const std::function<void(const Next& next)>& work,
              const std::function<void(std::uint64_t given_out)>& progress) {
  std::atomic<std::uint64_t> given_out = 0;
  std::atomic<bool> broken = false;
  std::exception_ptr exception;
  const auto work_on = [&](bool tells) {
    try {
      work([&](std::uint64_t& number) {
        if (broken) return false;
        const std::uint64_t k = given_out++;
        if (tells && progress) progress(std::min(k, count));
        if (k >= count) return false;
        number = first + k;
        return true;
      });
    } catch (...) {
      if (!broken.exchange(true)) exception = std::current_exception();
    }
  };
  {
    Threads others;
    try {
      for (std::uint64_t t = 1; t < std::min(static_cast<std::uint64_t>(std::max(threads, 1)), count); ++t)
        others.begin([&] { work_on(false); });
    } catch (const std::system_error&) {  // no more threads to be had: those there are do the work
    }
    work_on(true);
  }
  if (exception) std::rethrow_exception(exception);
}

}  // namespace oblique::ensemble
