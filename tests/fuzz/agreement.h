// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "trial.h"

namespace oblique::fuzz {

/// Where two runs that should agree do so no more.
struct Difference {
  double time = 0;                  ///< [s] of the first run
  std::size_t row = 0, column = 0;  ///< of the first run's trajectory
  double a = 0, b = 0;
  double allowed = 0;
};

/// Rows of two runs that stand for the same moments: row k of `b` for row first + k of `a`, whose time is
/// `time` times less.
struct Beside {
  const solve::Run& a;
  const solve::Run& b;
  std::size_t first = 0;
  double time = 1;
};

/// The first row in which the runs differ by more than `allowed(row, column)`. Rows near an event of either
/// are left out: there an output that jumps has jumped in one of them. So is what follows the last event that
/// a run tells of.
std::optional<Difference> find_difference(const Beside& runs, double tolerance,
                                          const std::function<double(std::size_t, std::size_t)>& allowed);

/// The largest magnitude of any output.
double size_of(const solve::Run& run);

}  // namespace oblique::fuzz
