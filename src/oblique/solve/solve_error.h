// SPDX-License-Identifier: MIT
#pragma once

#include <utility>

#include <oblique/text/diagnostic.h>

namespace oblique::solve {

/// Thrown by the `solve` stage: the diagram is well formed, but its equations could not be solved.
class SolveError : public text::Error {
 public:
  enum class Kind { singular_loop, no_rest, blow_up, step_budget, chatter, other };

  SolveError(Kind kind, double time, text::Diagnostic diagnostic)
      : text::Error(std::move(diagnostic)), kind_(kind), time_(time) {}

  Kind kind() const { return kind_; }
  double time() const { return time_; }  ///< [s] where the run stopped

 private:
  Kind kind_;
  double time_;
};

}  // namespace oblique::solve
