// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/cvodes_solver.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include <cvodes/cvodes.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_klu.h>
#include <sunmatrix/sunmatrix_sparse.h>

#include <oblique/solve/integrator/solver_vector.h>

namespace oblique::solve {
namespace {

static_assert(sizeof(sunindextype) == sizeof(std::int64_t), "SparsePattern shares its arrays with SUNDIALS");

constexpr int kGiveUp = -1;  ///< of what CVODES calls: it is not to try again

/// SUNDIALS' sentences are for its own log; ours are made from the return code.
void ignore_message(int, const char*, const char*, char*, void*) {}

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
  void operator()(void* memory) const { CVodeFree(&memory); }
};

template <class Handle, class Deleter>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Deleter>;

template <class Handle>
Handle made(Handle handle) {
  if (handle == nullptr) throw std::bad_alloc();
  return handle;
}

/// SUNHashMap_New writes into what it is given without a look whether it was given anything, and
/// SUNContext_Create destroys a logger that it was not given. That there is more than a context takes is
/// found out first.
SUNContext make_context() {
  constexpr std::size_t kMoreThanContext = 16'384;
  ::operator delete(made(::operator new(kMoreThanContext, std::nothrow)));
  SUNContext context = nullptr;
  if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
  return context;
}

/// Setup calls fail only for lack of memory or for arguments that this file fixes.
void check_setup(int code) {
  if (code == CV_MEM_FAIL || code == CVLS_MEM_FAIL) throw std::bad_alloc();
  if (code != CV_SUCCESS)
    throw std::logic_error("CVODES refuses its setup with code " + std::to_string(code));
}

/// SUNDIALS writes into what this gives without a look whether it gave anything. So the lack of memory is
/// thrown, as by the clones of `make_solver_vector`.
SUNMatrix clone_matrix_or_throw(SUNMatrix matrix) {
  return made(SUNMatClone_Sparse(matrix));
}

bool all_finite(const double* values, std::size_t size) {
  return std::all_of(values, values + size, [](double v) { return std::isfinite(v); });
}

}  // namespace

struct CvodesSolver::Handles {
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
  SolverStatistics before_restart;  ///< CVODES counts from its last start
  int small_steps = 0;
  bool saw_refusal = false;  ///< these two since the last step that was not small
  bool saw_not_finite = false;

  Owned<SUNContext, ContextDeleter> context;
  Owned<N_Vector, VectorDeleter> states;
  Owned<N_Vector, VectorDeleter> scratch;
  Owned<SUNMatrix, MatrixDeleter> matrix;
  Owned<SUNLinearSolver, LinearSolverDeleter> linear_solver;
  std::unique_ptr<void, CvodesDeleter> memory;

  Sensitivities* sensitivities = nullptr;
  std::vector<std::vector<double>> start_sensitivities;
  std::vector<Owned<N_Vector, VectorDeleter>> sensitivity_vectors;
  std::vector<N_Vector> sensitivity_handles;  ///< the same as CVODES wants them

  Handles(OdeSystem& ode, double t0, std::span<const double> x0, double last_time, double until_then,
          const SolverSettings& settings)
      : system(&ode),
        start(t0),
        t(t0),
        end(last_time),
        length(until_then),
        max_step(settings.max_step),
        relative_tolerance(settings.relative_tolerance),
        absolute_tolerance(settings.absolute_tolerance),
        start_states(x0.begin(), x0.end()),
        max_steps(settings.max_steps),
        context(make_context()) {
    const auto n = static_cast<sunindextype>(x0.size());
    states.reset(make_solver_vector(n, context.get()));
    scratch.reset(N_VClone(states.get()));
    std::copy(x0.begin(), x0.end(), N_VGetArrayPointer(states.get()));
    const auto entries = static_cast<sunindextype>(system->pattern().entries());
    matrix.reset(made(SUNSparseMatrix(n, n, entries, CSC_MAT, context.get())));
    matrix->ops->clone = clone_matrix_or_throw;
    linear_solver.reset(made(SUNLinSol_KLU(states.get(), matrix.get(), context.get())));
    memory.reset(made(CVodeCreate(settings.method == diagram::IntegrationMethod::adams ? CV_ADAMS : CV_BDF,
                                  context.get())));
    void* const cvodes = memory.get();
    check_setup(CVodeSetErrHandlerFn(cvodes, ignore_message, nullptr));
    const int started = CVodeInit(cvodes, evaluate, 0, states.get());
    // It has then freed its vectors, and CVodeFree would do so again.
    if (started == CV_MEM_FAIL) static_cast<void>(memory.release());
    check_setup(started);
    check_setup(CVodeSetUserData(cvodes, this));
    if (settings.own_tolerances.empty()) {
      check_setup(CVodeSStolerances(cvodes, settings.relative_tolerance, settings.absolute_tolerance));
    } else {
      const Owned<N_Vector, VectorDeleter> own(N_VClone(states.get()));
      std::copy(settings.own_tolerances.begin(), settings.own_tolerances.end(),
                N_VGetArrayPointer(own.get()));
      check_setup(CVodeSVtolerances(cvodes, settings.relative_tolerance, own.get()));
    }
    check_setup(CVodeSetLinearSolver(cvodes, linear_solver.get(), matrix.get()));
    check_setup(CVodeSetJacFn(cvodes, differentiate));
    // Of a decay that becomes slower by powers of ten from step to step (y′/x from x = 0 on) an old Jacobian
    // takes Newton's corrections away, and with them the estimated error: a new one for each factorisation.
    check_setup(CVodeSetJacEvalFrequency(cvodes, 1));
    if (std::isfinite(max_step)) check_setup(CVodeSetMaxStep(cvodes, max_step));
    check_setup(CVodeSetStopTime(cvodes, length));
  }

  void load_sensitivities() {
    for (std::size_t k = 0; k < sensitivity_handles.size(); ++k)
      std::copy(start_sensitivities[k].begin(), start_sensitivities[k].end(),
                N_VGetArrayPointer(sensitivity_handles[k]));
  }

  void follow(Sensitivities& what) {
    sensitivities = &what;
    start_sensitivities = what.states();
    for (std::size_t k = 0; k < what.count(); ++k) {
      sensitivity_vectors.emplace_back(N_VClone(states.get()));
      sensitivity_handles.push_back(sensitivity_vectors.back().get());
    }
    load_sensitivities();
    void* const cvodes = memory.get();
    std::vector<double> scales = what.scales(), tolerances;
    for (const double scale : scales) tolerances.push_back(absolute_tolerance / scale);
    check_setup(CVodeSensInit1(cvodes, static_cast<int>(what.count()), CV_STAGGERED, evaluate_sensitivity,
                               sensitivity_handles.data()));
    check_setup(CVodeSensSStolerances(cvodes, relative_tolerance, tolerances.data()));
    check_setup(CVodeSetSensErrCon(cvodes, SUNTRUE));
  }

  /// CVODES begins at `start` with the states as they are in their vector.
  void begin() {
    check_setup(CVodeReInit(memory.get(), 0, states.get()));
    if (sensitivities != nullptr) {
      load_sensitivities();
      check_setup(CVodeSensReInit(memory.get(), CV_STAGGERED, sensitivity_handles.data()));
    }
    check_setup(CVodeSetStopTime(memory.get(), length));
  }

  static int evaluate_sensitivity(int, sunrealtype t, N_Vector x, N_Vector, int k, N_Vector s, N_Vector rates,
                                  void* user, N_Vector, N_Vector) {
    auto& self = *static_cast<Handles*>(user);
    if (self.system->is_to_end()) return kGiveUp;
    double* const values = N_VGetArrayPointer(rates);
    if (!self.sensitivities->rates(self.start + t, N_VGetArrayPointer(x), static_cast<std::size_t>(k),
                                   N_VGetArrayPointer(s), values)) {
      self.saw_refusal = true;
      return 1;
    }
    return all_finite(values, self.system->size()) ? 0 : 1;
  }

  /// The time of CVODES' own clock that is t, within its last step: the end of the step to the bit, and no
  /// rounding beyond its ends, which CVODES would refuse.
  double own_time(double at) const {
    sunrealtype last = 0;
    CVodeGetLastStep(memory.get(), &last);
    return at >= t ? clock : std::clamp(at - start, clock - last, clock);
  }

  std::vector<std::vector<double>> sensitivities_at(double at) const {
    if (clock == 0) return start_sensitivities;
    std::vector<std::vector<double>> values;
    for (std::size_t k = 0; k < sensitivity_handles.size(); ++k) {
      check_setup(CVodeGetSensDky1(memory.get(), own_time(at), 0, static_cast<int>(k), scratch.get()));
      const double* const found = N_VGetArrayPointer(scratch.get());
      values.emplace_back(found, found + system->size());
    }
    return values;
  }

  /// In one-step mode the time to go tells the direction, and of the first step the size; it must not be the
  /// stop time itself.
  int take_step(double part) {
    const double direction = part < 1 ? part * length : 2 * length + 1;
    const int code = CVode(memory.get(), direction, states.get(), &clock, CV_ONE_STEP);
    // CVODES takes a factorisation that found no memory for one that failed.
    if (code < 0 && SUNLinSol_KLUGetCommon(linear_solver.get())->status == KLU_OUT_OF_MEMORY)
      throw std::bad_alloc();
    return code;
  }

  static int evaluate(sunrealtype t, N_Vector x, N_Vector dxdt, void* user) {
    auto& self = *static_cast<Handles*>(user);
    const double* const states = N_VGetArrayPointer(x);
    double* const derivatives = N_VGetArrayPointer(dxdt);
    if (self.system->is_to_end()) return kGiveUp;
    if (!self.system->derivatives(self.start + t, states, derivatives)) {
      self.saw_refusal = true;
      return 1;
    }
    if (all_finite(derivatives, self.system->size())) return 0;
    self.saw_not_finite = true;
    return 1;  // recoverable: CVODES tries a shorter step
  }

  static int differentiate(sunrealtype t, N_Vector x, N_Vector, SUNMatrix matrix, void* user, N_Vector,
                           N_Vector, N_Vector) {
    auto& self = *static_cast<Handles*>(user);
    const network::SparsePattern& pattern = self.system->pattern();
    std::copy(pattern.column_starts.begin(), pattern.column_starts.end(),
              SUNSparseMatrix_IndexPointers(matrix));
    std::copy(pattern.rows.begin(), pattern.rows.end(), SUNSparseMatrix_IndexValues(matrix));
    double* const values = SUNSparseMatrix_Data(matrix);
    if (self.system->is_to_end()) return kGiveUp;
    if (!self.system->jacobian(self.start + t, N_VGetArrayPointer(x), values)) {
      self.saw_refusal = true;
      return 1;
    }
    return all_finite(values, pattern.entries()) ? 0 : 1;
  }

  /// The states, or with `derivative` 1 their rates, at a time within the last step.
  void interpolate(double at, int derivative, std::span<double> values) const {
    check_setup(CVodeGetDky(memory.get(), own_time(at), derivative, scratch.get()));
    const double* const found = N_VGetArrayPointer(scratch.get());
    std::copy(found, found + values.size(), values.begin());
  }

  /// What ended a step with this code, or the row of small steps that one of success ends.
  SolverFailure failure(int code) const {
    SolverFailure failure{SolverFailure::Kind::other, t, code};
    const bool refused = code == CV_RHSFUNC_FAIL || code == CV_FIRST_RHSFUNC_ERR ||
                         code == CV_REPTD_RHSFUNC_ERR || code == CV_UNREC_RHSFUNC_ERR;
    if (refused) failure.kind = SolverFailure::Kind::no_value;
    const bool too_short = code == CV_ERR_FAILURE || code == CV_CONV_FAILURE || code >= 0;
    if (too_short)
      failure.kind = saw_refusal ? SolverFailure::Kind::no_value : SolverFailure::Kind::small_step;
    if (saw_not_finite && failure.kind != SolverFailure::Kind::other)
      failure.kind = SolverFailure::Kind::not_finite;
    return failure;
  }
};

CvodesSolver::CvodesSolver(OdeSystem& system, double t0, std::span<const double> x0, double end,
                           double length, const SolverSettings& settings)
    : handles_(std::make_unique<Handles>(system, t0, x0, end, length, settings)) {}
CvodesSolver::~CvodesSolver() = default;
CvodesSolver::CvodesSolver(CvodesSolver&&) noexcept = default;
CvodesSolver& CvodesSolver::operator=(CvodesSolver&&) noexcept = default;

void CvodesSolver::restart(double t, std::span<const double> x, double end, double length) {
  Handles& h = *handles_;
  h.before_restart = statistics();
  if (h.sensitivities != nullptr) h.start_sensitivities = h.sensitivities_at(t);
  std::copy(x.begin(), x.end(), N_VGetArrayPointer(h.states.get()));
  h.start = h.t = t;
  h.start_states.assign(x.begin(), x.end());
  h.clock = 0;
  h.end = end;
  h.length = length;
  h.small_steps = 0;
  h.begin();
}

void CvodesSolver::change_settings(const SolverSettings& settings) {
  const Handles& h = *handles_;
  auto next = std::make_unique<Handles>(*h.system, h.t, states(), h.end, h.length - h.clock, settings);
  next->before_restart = statistics();
  next->steps = h.steps;
  const double limit = h.limit;
  handles_ = std::move(next);
  limit_step(limit);
}

int CvodesSolver::last_order() const {
  int order = 0;
  CVodeGetLastOrder(handles_->memory.get(), &order);
  return order;
}

void CvodesSolver::follow(Sensitivities& sensitivities) {
  handles_->follow(sensitivities);
}

void CvodesSolver::set_sensitivities(const std::vector<std::vector<double>>& values) {
  handles_->start_sensitivities = values;
  handles_->begin();
}

std::vector<std::vector<double>> CvodesSolver::sensitivities_at(double t) const {
  return handles_->sensitivities_at(t);
}

void CvodesSolver::limit_step(double longest) {
  handles_->limit = longest;
  const double most = std::min(longest, handles_->max_step);
  check_setup(CVodeSetMaxStep(handles_->memory.get(), std::isinf(most) ? 0 : most));
}

double CvodesSolver::step() {
  Handles& h = *handles_;
  if (h.steps >= h.max_steps) throw SolverFailure{SolverFailure::Kind::step_budget, h.t, 0};
  if (h.small_steps == 0) h.saw_refusal = h.saw_not_finite = false;
  double before = h.clock;
  int code = h.take_step(1);
  // Newton's iteration leaves the state of a servo loop within a tolerance that shrinks where it passes zero,
  // and no shorter step takes that back: another start lets the loop settle. One that comes no farther than
  // this [of the time] has met what no start passes.
  constexpr double kFarther = 1e-6;
  if (code == CV_ERR_FAILURE && before > kFarther * (std::abs(h.t) + h.length)) {
    const std::vector<double> states(this->states().begin(), this->states().end());
    restart(h.t, states, h.end, h.length - before);
    before = 0;
    code = h.take_step(1);
  }
  // CVODES begins with no shorter step than 1e-14 of the time to go, and gives up after some tries with a
  // tenth each: beside a long run a fast decay needs another start.
  constexpr double kNearer = 1e-6, kNearest = 1e-20;
  for (double part = kNearer; code == CV_ERR_FAILURE && before == 0 && part > kNearest; part *= kNearer) {
    std::copy(h.start_states.begin(), h.start_states.end(), N_VGetArrayPointer(h.states.get()));
    h.begin();
    code = h.take_step(part);
  }
  h.t = h.clock >= h.length ? h.end : std::min(h.start + h.clock, h.end);
  if (code < 0 && h.system->is_to_end()) throw SolverFailure{SolverFailure::Kind::interrupted, h.t, code};
  if (code < 0) throw h.failure(code);
  ++h.steps;
  if (!all_finite(N_VGetArrayPointer(h.states.get()), h.system->size())) {
    throw SolverFailure{SolverFailure::Kind::not_finite, h.t, code};
  }
  const bool small = h.clock - before < kSmallestStep * std::min(std::abs(h.t), h.length);
  h.small_steps = small && h.clock < h.length ? h.small_steps + 1 : 0;
  if (h.small_steps > kMostSmallSteps) throw h.failure(code);
  return h.t;
}

void CvodesSolver::states_at(double t, std::span<double> x) const {
  handles_->interpolate(t, 0, x);
}

void CvodesSolver::rates_at(double t, std::span<double> dxdt) const {
  handles_->interpolate(t, 1, dxdt);
}

std::span<const double> CvodesSolver::states() const {
  return {N_VGetArrayPointer(handles_->states.get()), handles_->system->size()};
}

SolverStatistics CvodesSolver::statistics() const {
  void* const memory = handles_->memory.get();
  SolverStatistics s;
  long steps = 0;
  CVodeGetNumSteps(memory, &steps);
  s.steps = steps;
  CVodeGetNumRhsEvals(memory, &s.evaluations);
  CVodeGetNumJacEvals(memory, &s.jacobians);
  CVodeGetNumLinSolvSetups(memory, &s.factorizations);
  CVodeGetNumErrTestFails(memory, &s.error_test_failures);
  CVodeGetLastStep(memory, &s.last_step);
  const SolverStatistics& before = handles_->before_restart;
  s.steps += before.steps;
  s.evaluations += before.evaluations;
  s.jacobians += before.jacobians;
  s.factorizations += before.factorizations;
  s.error_test_failures += before.error_test_failures;
  return s;
}

std::vector<double> CvodesSolver::weighted_errors() const {
  const Handles& h = *handles_;
  const Owned<N_Vector, VectorDeleter> weights(N_VClone(h.states.get()));
  CVodeGetEstLocalErrors(h.memory.get(), h.scratch.get());
  CVodeGetErrWeights(h.memory.get(), weights.get());
  std::vector<double> errors(h.system->size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = std::abs(N_VGetArrayPointer(h.scratch.get())[i] * N_VGetArrayPointer(weights.get())[i]);
  }
  return errors;
}

}  // namespace oblique::solve
