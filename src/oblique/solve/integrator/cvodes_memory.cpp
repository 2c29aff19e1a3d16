// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/cvodes_memory.h>

#include <algorithm>
#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include <oblique/solve/integrator/solver_vector.h>

namespace oblique::solve {
namespace {

static_assert(sizeof(sunindextype) == sizeof(std::int64_t), "SparsePattern shares its arrays with SUNDIALS");

constexpr int kGiveUp = -1;  ///< of what CVODES calls: it is not to try again

/// SUNDIALS' sentences are for its own log; ours are made from the return code.
void ignore_message(int, const char*, const char*, char*, void*) {}

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

/// SUNDIALS writes into what this gives without a look whether it gave anything. So the lack of memory is
/// thrown, as by the clones of `make_solver_vector`.
SUNMatrix clone_matrix_or_throw(SUNMatrix matrix) {
  return made(SUNMatClone_Sparse(matrix));
}

}  // namespace

void check_setup(int code) {
  if (code == CV_MEM_FAIL || code == CVLS_MEM_FAIL) throw std::bad_alloc();
  if (code != CV_SUCCESS)
    throw std::logic_error("CVODES refuses its setup with code " + std::to_string(code));
}

bool all_finite(const double* values, std::size_t size) {
  return std::all_of(values, values + size, [](double v) { return std::isfinite(v); });
}

CvodesMemory::CvodesMemory(OdeSystem& ode, double t0, std::span<const double> x0, double last_time,
                           double until_then, const SolverSettings& settings)
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
  cvodes.reset(made(
      CVodeCreate(settings.method == diagram::IntegrationMethod::adams ? CV_ADAMS : CV_BDF, context.get())));
  check_setup(CVodeSetErrHandlerFn(cvodes.get(), ignore_message, nullptr));
  const int started = CVodeInit(cvodes.get(), evaluate, 0, states.get());
  // It has then freed its vectors, and CVodeFree would do so again.
  if (started == CV_MEM_FAIL) static_cast<void>(cvodes.release());
  check_setup(started);
  check_setup(CVodeSetUserData(cvodes.get(), this));
  if (settings.own_tolerances.empty()) {
    check_setup(CVodeSStolerances(cvodes.get(), settings.relative_tolerance, settings.absolute_tolerance));
  } else {
    const Owned<N_Vector, VectorDeleter> own(N_VClone(states.get()));
    std::copy(settings.own_tolerances.begin(), settings.own_tolerances.end(), N_VGetArrayPointer(own.get()));
    check_setup(CVodeSVtolerances(cvodes.get(), settings.relative_tolerance, own.get()));
  }
  check_setup(CVodeSetLinearSolver(cvodes.get(), linear_solver.get(), matrix.get()));
  check_setup(CVodeSetJacFn(cvodes.get(), differentiate));
  // Of a decay that becomes slower by powers of ten from step to step (y′/x from x = 0 on) an old Jacobian
  // takes Newton's corrections away, and with them the estimated error: a new one for each factorisation.
  check_setup(CVodeSetJacEvalFrequency(cvodes.get(), 1));
  if (std::isfinite(max_step)) check_setup(CVodeSetMaxStep(cvodes.get(), max_step));
  check_setup(CVodeSetStopTime(cvodes.get(), length));
}

void CvodesMemory::load_sensitivities() {
  for (std::size_t k = 0; k < sensitivity_handles.size(); ++k)
    std::copy(start_sensitivities[k].begin(), start_sensitivities[k].end(),
              N_VGetArrayPointer(sensitivity_handles[k]));
}

void CvodesMemory::follow(Sensitivities& what) {
  sensitivities = &what;
  start_sensitivities = what.states();
  for (std::size_t k = 0; k < what.count(); ++k) {
    sensitivity_vectors.emplace_back(N_VClone(states.get()));
    sensitivity_handles.push_back(sensitivity_vectors.back().get());
  }
  load_sensitivities();
  std::vector<double> scales = what.scales(), tolerances;
  for (const double scale : scales) tolerances.push_back(absolute_tolerance / scale);
  check_setup(CVodeSensInit1(cvodes.get(), static_cast<int>(what.count()), CV_STAGGERED, evaluate_sensitivity,
                             sensitivity_handles.data()));
  check_setup(CVodeSensSStolerances(cvodes.get(), relative_tolerance, tolerances.data()));
  check_setup(CVodeSetSensErrCon(cvodes.get(), SUNTRUE));
}

void CvodesMemory::begin() {
  check_setup(CVodeReInit(cvodes.get(), 0, states.get()));
  watched = failed = 0;
  if (sensitivities != nullptr) {
    load_sensitivities();
    check_setup(CVodeSensReInit(cvodes.get(), CV_STAGGERED, sensitivity_handles.data()));
  }
  check_setup(CVodeSetStopTime(cvodes.get(), length));
}

int CvodesMemory::evaluate_sensitivity(int, sunrealtype t, N_Vector x, N_Vector, int k, N_Vector s,
                                       N_Vector rates, void* user, N_Vector, N_Vector) {
  auto& self = *static_cast<CvodesMemory*>(user);
  if (self.system->is_to_end()) return kGiveUp;
  double* const values = N_VGetArrayPointer(rates);
  if (!self.sensitivities->rates(self.start + t, N_VGetArrayPointer(x), static_cast<std::size_t>(k),
                                 N_VGetArrayPointer(s), values)) {
    self.saw_refusal = true;
    return 1;
  }
  if (all_finite(values, self.system->size())) return 0;
  self.saw_no_derivative = true;
  return 1;
}

/// The time of CVODES' own clock that is t, within its last step: the end of the step to the bit, and no
/// rounding beyond its ends, which CVODES would refuse.
double CvodesMemory::own_time(double at) const {
  sunrealtype last = 0;
  CVodeGetLastStep(cvodes.get(), &last);
  return at >= t ? clock : std::clamp(at - start, clock - last, clock);
}

std::vector<std::vector<double>> CvodesMemory::sensitivities_at(double at) const {
  if (clock == 0) return start_sensitivities;
  std::vector<std::vector<double>> values;
  for (std::size_t k = 0; k < sensitivity_handles.size(); ++k) {
    check_setup(CVodeGetSensDky1(cvodes.get(), own_time(at), 0, static_cast<int>(k), scratch.get()));
    const double* const found = N_VGetArrayPointer(scratch.get());
    values.emplace_back(found, found + system->size());
  }
  return values;
}

/// In one-step mode the time to go tells the direction, and of the first step the size; it must not be the
/// stop time itself.
int CvodesMemory::take_step(double part) {
  const double direction = part < 1 ? part * length : 2 * length + 1;
  const int code = CVode(cvodes.get(), direction, states.get(), &clock, CV_ONE_STEP);
  // CVODES takes a factorisation that found no memory for one that failed.
  if (code < 0 && SUNLinSol_KLUGetCommon(linear_solver.get())->status == KLU_OUT_OF_MEMORY)
    throw std::bad_alloc();
  if (code >= 0) watch_failures();
  return code;
}

/// A change of the step may add an error of which steady steps show nothing: the length of a vector that
/// turns falls evenly by steps of the first order, and with it what is computed from the length. CVODES then
/// tries four times the step, fails, and comes back to where it was, before some steps of one length let it
/// consider a higher order: for ever. Where so many of so many steps have failed, some are to be no longer
/// than the last, and the others no more than twice as long.
void CvodesMemory::watch_failures() {
  constexpr long kSteps = 32, kFailures = 7, kHeld = 12;
  constexpr double kNoLonger = 1 + 1e-6, kTwice = 2;
  if (++watched < (holds_step ? kHeld : kSteps)) return;
  long all = 0;
  CVodeGetNumErrTestFails(cvodes.get(), &all);
  const bool hold = !holds_step && all - failed >= kFailures;
  if (hold != holds_step) check_setup(CVodeSetEtaMax(cvodes.get(), hold ? kNoLonger : kTwice));
  holds_step = hold;
  watched = 0;
  failed = all;
}

int CvodesMemory::evaluate(sunrealtype t, N_Vector x, N_Vector dxdt, void* user) {
  auto& self = *static_cast<CvodesMemory*>(user);
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

int CvodesMemory::differentiate(sunrealtype t, N_Vector x, N_Vector, SUNMatrix matrix, void* user, N_Vector,
                                N_Vector, N_Vector) {
  auto& self = *static_cast<CvodesMemory*>(user);
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

void CvodesMemory::interpolate(double at, int derivative, std::span<double> values) const {
  check_setup(CVodeGetDky(cvodes.get(), own_time(at), derivative, scratch.get()));
  const double* const found = N_VGetArrayPointer(scratch.get());
  std::copy(found, found + values.size(), values.begin());
}

SolverFailure CvodesMemory::failure(int code) const {
  SolverFailure failure{SolverFailure::Kind::other, t, code};
  const bool refused = code == CV_RHSFUNC_FAIL || code == CV_FIRST_RHSFUNC_ERR ||
                       code == CV_REPTD_RHSFUNC_ERR || code == CV_UNREC_RHSFUNC_ERR;
  if (refused) failure.kind = SolverFailure::Kind::no_value;
  const bool too_short = code == CV_ERR_FAILURE || code == CV_CONV_FAILURE || code >= 0;
  if (too_short) failure.kind = saw_refusal ? SolverFailure::Kind::no_value : SolverFailure::Kind::small_step;
  if (saw_not_finite && failure.kind != SolverFailure::Kind::other)
    failure.kind = SolverFailure::Kind::not_finite;
  const bool of_sensitivities = code == CV_SRHSFUNC_FAIL || code == CV_FIRST_SRHSFUNC_ERR ||
                                code == CV_REPTD_SRHSFUNC_ERR || code == CV_UNREC_SRHSFUNC_ERR;
  if (of_sensitivities || (too_short && saw_no_derivative && !saw_refusal && !saw_not_finite))
    failure.kind = SolverFailure::Kind::no_derivative;
  return failure;
}

}  // namespace oblique::solve
