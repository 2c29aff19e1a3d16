// SPDX-License-Identifier: MIT
#include "terminal/signals.h"

#include <csignal>
#include <string_view>

#include <sys/wait.h>
#include <unistd.h>

#include <oblique/text/leftover.h>

namespace oblique::cli {
namespace {

// NOLINTNEXTLINE(*-avoid-non-const-global-variables): a signal reaches no other
volatile std::sig_atomic_t only_asks = 0, interrupt_asked = 0;

void end_in_order(int number) {
  if (number == SIGINT && only_asks != 0 && interrupt_asked == 0) {
    interrupt_asked = 1;
    constexpr std::string_view kText = "interrupting; Ctrl-C once more ends at once\n";
    // Where it cannot be told it is done all the same.
    static_cast<void>(!write(STDERR_FILENO, kText.data(), kText.size()));
    return;
  }
  text::clear_away_leftovers();
  std::signal(number, SIG_DFL);
  std::raise(number);
}

}  // namespace

void end_in_order_on_signals() {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};
    if (sigaction(number, nullptr, &action) != 0 || action.sa_handler == SIG_IGN) continue;
    action.sa_handler = end_in_order;
    action.sa_flags = SA_RESTART;
    sigaction(number, &action, nullptr);
  }
}

InterruptGuard::InterruptGuard() {
  interrupt_asked = 0;
  only_asks = 1;
}

InterruptGuard::~InterruptGuard() {
  only_asks = 0;
}

bool InterruptGuard::asked() {
  return interrupt_asked != 0;
}

void end_as_ended(int status) {
  constexpr int kOfTheShell = 128;  // added to the number of the signal that ended what it ran
  if ((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT) ||
      (WIFEXITED(status) && WEXITSTATUS(status) == kOfTheShell + SIGINT))
    std::raise(SIGINT);
}

}  // namespace oblique::cli
