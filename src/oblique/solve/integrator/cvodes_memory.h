// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <oblique/solve/integrator/ode_system.h>
#include <oblique/solve/integrator/solver.h>
#include <oblique/solve/sensitivity/sensitivities.h>

namespace oblique::solve {

struct VectorDeleter {
  void operator()(N_Vector v) const { N_VDestroy(v); }
};
struct MatrixDeleter {
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
};
struct LinearSolverDeleter {
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
};
struct ContextDeleter {
  void operator()(SUNContext c) const { SUNContext_Free(&c); }
};
struct CvodesDeleter {
  void operator()(void* cvodes) const { CVodeFree(&cvodes); }
};

template <class Handle, class Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

/// Throws where SUNDIALS refuses its setup: for lack of memory, or for arguments that the code here fixes.
void check_setup(int code);

bool all_finite(const double* values, std::size_t size);

/// CVODES with all of SUNDIALS' memory that it needs, and what it calls: the equations of one system, from
/// its last start on. Not installed.
struct CvodesMemory {
  OdeSystem* system;
  double start;                                            ///< the time at which CVODES' clock is zero [s]
  double t;                                                ///< reached [s]
  double end;                                              ///< [s]
  double clock = 0;                                        ///< CVODES' own: since `start` [s]
  double length;                                           ///< from `start` to `end` [s]
  double max_step;                                         ///< [s]
  double limit = std::numeric_limits<double>::infinity();  ///< see `limit_step`
  double relative_tolerance, absolute_tolerance;
  std::vector<double> start_states;
  std::int64_t max_steps;
  std::int64_t steps = 0;
  long watched = 0;  ///< steps since the failures were counted last
  long failed = 0;   ///< tests of the error until then
  bool holds_step = false;
  SolverStatistics before_restart;  ///< CVODES counts from its last start
  SmallSteps small_steps;
  bool saw_refusal = false;  ///< these since the last step that was not small
  bool saw_not_finite = false;
  bool saw_no_derivative = false;  ///< of the sensitivities alone

  Owned<SUNContext, ContextDeleter> context;
  Owned<N_Vector, VectorDeleter> states;
  Owned<N_Vector, VectorDeleter> scratch;
  Owned<SUNMatrix, MatrixDeleter> matrix;
  Owned<SUNLinearSolver, LinearSolverDeleter> linear_solver;
  std::unique_ptr<void, CvodesDeleter> cvodes;

  Sensitivities* sensitivities = nullptr;
  std::vector<std::vector<double>> start_sensitivities;
  std::vector<Owned<N_Vector, VectorDeleter>> sensitivity_vectors;
  std::vector<N_Vector> sensitivity_handles;  ///< the same as CVODES wants them

  /// Starts at (t0, x0); `until_then` is the time from there to `last_time`, which it does not pass.
  CvodesMemory(OdeSystem& ode, double t0, std::span<const double> x0, double last_time, double until_then,
               const SolverSettings& settings);

  /// Integrates these sensitivities along with the states.
  void follow(Sensitivities& what);
  /// CVODES begins at `start` with the states as they are in their vector.
  void begin();
  /// A step, and CVODES' code for it: the first one of a start tries this part of the way first.
  int take_step(double part);
  /// The states, or with `derivative` 1 their rates, at a time within the last step.
  void interpolate(double at, int derivative, std::span<double> values) const;
  std::vector<std::vector<double>> sensitivities_at(double at) const;
  /// What ended a step with this code, or the row of small steps that one of success ends.
  SolverFailure failure(int code) const;

 private:
  void watch_failures();
  void load_sensitivities();
  double own_time(double at) const;
  static int evaluate(sunrealtype t, N_Vector x, N_Vector dxdt, void* user);
  static int differentiate(sunrealtype t, N_Vector x, N_Vector, SUNMatrix matrix, void* user, N_Vector,
                           N_Vector, N_Vector);
  static int evaluate_sensitivity(int, sunrealtype t, N_Vector x, N_Vector, int k, N_Vector s, N_Vector rates,
                                  void* user, N_Vector, N_Vector);
};

}  // namespace oblique::solve
