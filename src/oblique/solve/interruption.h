// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <functional>
#include <utility>

namespace oblique::solve {

/// Thrown within a run that is asked to end; `run` catches it.
class Interrupted : public std::exception {
 public:
  const char* what() const noexcept override { return "interrupted"; }
};

/// Whether a run is asked to end: whatever may take long asks again and again.
class Interruption {
 public:
  Interruption() = default;
  explicit Interruption(std::function<bool()> asked) : asked_(std::move(asked)) {}

  bool is_asked() const { return asked_ && asked_(); }
  /// Throws Interrupted.
  void check() const {
    if (is_asked()) throw Interrupted();
  }

 private:
  std::function<bool()> asked_;
};

}  // namespace oblique::solve
