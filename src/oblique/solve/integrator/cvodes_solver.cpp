// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/cvodes_solver.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/integrator/cvodes_memory.h>

namespace oblique::solve {

CvodesSolver::CvodesSolver(OdeSystem& system, double t0, std::span<const double> x0, double end,
                           double length, const SolverSettings& settings)
    : memory_(std::make_unique<CvodesMemory>(system, t0, x0, end, length, settings)) {}
CvodesSolver::~CvodesSolver() = default;
CvodesSolver::CvodesSolver(CvodesSolver&&) noexcept = default;
CvodesSolver& CvodesSolver::operator=(CvodesSolver&&) noexcept = default;

void CvodesSolver::restart(double t, std::span<const double> x, double end, double length) {
  CvodesMemory& m = *memory_;
  m.before_restart = statistics();
  if (m.sensitivities != nullptr) m.start_sensitivities = m.sensitivities_at(t);
  std::copy(x.begin(), x.end(), N_VGetArrayPointer(m.states.get()));
  m.start = m.t = t;
  m.start_states.assign(x.begin(), x.end());
  m.clock = 0;
  m.end = end;
  m.length = length;
  m.small_steps.restart();
  m.begin();
}

void CvodesSolver::change_settings(const SolverSettings& settings) {
  const CvodesMemory& m = *memory_;
  auto next = std::make_unique<CvodesMemory>(*m.system, m.t, states(), m.end, m.length - m.clock, settings);
  next->before_restart = statistics();
  next->steps = m.steps;
  const double limit = m.limit;
  memory_ = std::move(next);
  limit_step(limit);
}

int CvodesSolver::last_order() const {
  int order = 0;
  CVodeGetLastOrder(memory_->cvodes.get(), &order);
  return order;
}

void CvodesSolver::follow(Sensitivities& sensitivities) {
  memory_->follow(sensitivities);
}

void CvodesSolver::set_sensitivities(const std::vector<std::vector<double>>& values) {
  memory_->start_sensitivities = values;
  memory_->begin();
}

std::vector<std::vector<double>> CvodesSolver::sensitivities_at(double t) const {
  return memory_->sensitivities_at(t);
}

void CvodesSolver::limit_step(double longest) {
  memory_->limit = longest;
  const double most = std::min(longest, memory_->max_step);
  check_setup(CVodeSetMaxStep(memory_->cvodes.get(), std::isinf(most) ? 0 : most));
}

double CvodesSolver::step() {
  CvodesMemory& m = *memory_;
  if (m.steps >= m.max_steps) throw SolverFailure{SolverFailure::Kind::step_budget, m.t, 0};
  if (!m.small_steps.any()) m.saw_refusal = m.saw_not_finite = m.saw_no_derivative = false;
  double before = m.clock;
  int code = m.take_step(1);
  // Newton's iteration leaves the state of a servo loop within a tolerance that shrinks where it passes zero,
  // and no shorter step takes that back: another start lets the loop settle. One that comes no farther than
  // this [of the time] has met what no start passes.
  constexpr double kFarther = 1e-6;
  if (code == CV_ERR_FAILURE && before > kFarther * (std::abs(m.t) + m.length)) {
    const std::vector<double> states(this->states().begin(), this->states().end());
    restart(m.t, states, m.end, m.length - before);
    before = 0;
    code = m.take_step(1);
  }
  // CVODES begins with no shorter step than 1e-14 of the time to go, and gives up after some tries with a
  // tenth each: beside a long run a fast decay needs another start.
  constexpr double kNearer = 1e-6, kNearest = 1e-20;
  for (double part = kNearer; code == CV_ERR_FAILURE && before == 0 && part > kNearest; part *= kNearer) {
    std::copy(m.start_states.begin(), m.start_states.end(), N_VGetArrayPointer(m.states.get()));
    m.begin();
    code = m.take_step(part);
  }
  m.t = time_within(m.start, m.clock, m.end, m.length);
  if (code < 0 && m.system->is_to_end()) throw SolverFailure{SolverFailure::Kind::interrupted, m.t, code};
  if (code < 0) throw m.failure(code);
  ++m.steps;
  if (!all_finite(N_VGetArrayPointer(m.states.get()), m.system->size())) {
    throw SolverFailure{SolverFailure::Kind::not_finite, m.t, code};
  }
  if (m.small_steps.take(before, m.clock, m.length, m.t, true)) throw m.failure(code);
  return m.t;
}

void CvodesSolver::states_at(double t, std::span<double> x) const {
  memory_->interpolate(t, 0, x);
}

void CvodesSolver::rates_at(double t, std::span<double> dxdt) const {
  memory_->interpolate(t, 1, dxdt);
}

std::span<const double> CvodesSolver::states() const {
  return {N_VGetArrayPointer(memory_->states.get()), memory_->system->size()};
}

SolverStatistics CvodesSolver::statistics() const {
  void* const cvodes = memory_->cvodes.get();
  SolverStatistics s;
  long steps = 0;
  CVodeGetNumSteps(cvodes, &steps);
  s.steps = steps;
  CVodeGetNumRhsEvals(cvodes, &s.evaluations);
  CVodeGetNumJacEvals(cvodes, &s.jacobians);
  CVodeGetNumLinSolvSetups(cvodes, &s.factorizations);
  CVodeGetNumErrTestFails(cvodes, &s.error_test_failures);
  CVodeGetLastStep(cvodes, &s.last_step);
  const SolverStatistics& before = memory_->before_restart;
  s.steps += before.steps;
  s.evaluations += before.evaluations;
  s.jacobians += before.jacobians;
  s.factorizations += before.factorizations;
  s.error_test_failures += before.error_test_failures;
  return s;
}

std::vector<double> CvodesSolver::weighted_errors() const {
  const CvodesMemory& m = *memory_;
  const Owned<N_Vector, VectorDeleter> weights(N_VClone(m.states.get()));
  CVodeGetEstLocalErrors(m.cvodes.get(), m.scratch.get());
  CVodeGetErrWeights(m.cvodes.get(), weights.get());
  std::vector<double> errors(m.system->size());
  for (std::size_t i = 0; i < errors.size(); ++i) {
    errors[i] = std::abs(N_VGetArrayPointer(m.scratch.get())[i] * N_VGetArrayPointer(weights.get())[i]);
  }
  return errors;
}

}  // namespace oblique::solve
