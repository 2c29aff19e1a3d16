// SPDX-License-Identifier: MIT
#include "terminal/memory.h"

#include <atomic>
#include <cstdlib>
#include <exception>
#include <new>
#include <string_view>

#include <unistd.h>

#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

/// Given back when memory runs out, so that unwinding finds some.
constexpr std::size_t kReserve = 65'536;

std::atomic<void*> reserve = nullptr;
std::atomic<bool> ran_out = false;
std::terminate_handler terminate_before = nullptr;

void give_up_allocation() {
  ran_out = true;
  std::free(reserve.exchange(nullptr));
  throw std::bad_alloc();
}

bool for_lack_of_memory(const std::exception_ptr& thrown) {
  if (ran_out) return true;
  if (!thrown) return false;
  try {
    std::rethrow_exception(thrown);
  } catch (const std::bad_alloc&) {
    return true;
  } catch (...) {
    return false;
  }
}

[[noreturn]] void terminate() {
  if (for_lack_of_memory(std::current_exception())) {
    print_no_memory();
    std::_Exit(static_cast<int>(ExitStatus::bad_request));
  }
  terminate_before();
  std::abort();
}

}  // namespace

void guard_memory() {
  reserve = std::malloc(kReserve);
  std::set_new_handler(give_up_allocation);
  terminate_before = std::set_terminate(terminate);
}

bool memory_ran_out() {
  return ran_out;
}

void print_no_memory() {
  print_error_mark();
  note(
      "there is not enough memory for this\n"
      "  remedy: ask for fewer rows ('samples' in [run], --positions) or outputs, or split the diagram\n");
}

}  // namespace oblique::cli
