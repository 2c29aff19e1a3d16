// SPDX-License-Identifier: MIT
#pragma once

namespace oblique::cli {

/// From then on the signals that ask the program to end (Ctrl-C, SIGTERM, SIGHUP) end it as ever, but nothing
/// half done stays behind. Those that are ignored stay so.
void end_in_order_on_signals();

/// While it lives, the first Ctrl-C only asks for the end of the work; the second ends the program.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// Whether Ctrl-C was pressed.
  static bool asked();
};

/// Where a program that ended with this status of `waitpid` was ended by Ctrl-C, so is this one.
void end_as_ended(int status);

}  // namespace oblique::cli
