// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include <oblique/diagram/diagram.h>

namespace oblique::solve {

/// The largest magnitude that a signal had in a run.
struct Peak {
  double value = 0;  ///< with its sign [machine unit]
  double time = 0;   ///< [s]
};

/// A signal that left the range ±1 machine unit.
struct OverloadRecord {
  std::size_t signal = 0;  ///< number among the signals of the program
  double first = 0;        ///< [s] when it left the range for the first time
  double duration = 0;     ///< [s] outside the range, all times together
  Peak peak;
  double suggested_scale = 1;  ///< the factor that brings it back into the range: 1/2, 1/5, 1/10, …
};

/// Something that happened between two smooth segments of a run.
struct EventRecord {
  double time = 0;  ///< [s]
  std::string what;
};

/// Where a run stands in its timeline.
struct PhasePosition {
  std::size_t phase = 0;
  double cycle = 0;  ///< number of those that are over
  double begin = 0;  ///< of the phase [s]
};

/// The method of a run and why.
struct MethodChoice {
  diagram::IntegrationMethod method = diagram::IntegrationMethod::bdf;  ///< never automatic
  std::string reason;
};

/// What a run cost.
struct SolverStatistics {
  std::int64_t steps = 0;
  long evaluations = 0;  ///< of dx/dt
  long jacobians = 0;    ///< evaluations of the Jacobian
  long factorizations = 0;
  long error_test_failures = 0;
  double last_step = 0;  ///< [s]
};

}  // namespace oblique::solve
