// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/rosenbrock_solver.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/integrator/rosenbrock.h>

namespace oblique::solve {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

constexpr double kSafety = 0.9, kLeastFactor = 0.2, kMostFactor = 6;  ///< of the next step
constexpr double kMostFirstFactor = 100;  ///< of the second one: the first was a guess
constexpr double kRefusedFactor = 0.25;   ///< of a step in which there is no value
constexpr int kMostTries = 200;           ///< of a step: from the longest to the shortest that there is

constexpr double kLookAt = 0.5;  ///< part of a step, where its polynomial is looked at

constexpr double kFirstChange = 0.01;  ///< of the states in the first step, by their rates
constexpr double kFirstPart = 0.1;     ///< of the segment, at most

/// df/dt is a difference of second order over this part of the step, and of no less than this many roundings
/// of the time. A shorter one would carry more rounding than the finest tolerance bears, a longer one more
/// of the curvature.
constexpr double kTimePart = 2e-3;
constexpr double kTimeRoundings = 1e3;

bool all_finite(std::span<const double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

network::SparsePattern full_pattern(std::size_t n) {
  network::SparsePattern full;
  for (std::size_t column = 1; column <= n; ++column)
    full.column_starts.push_back(static_cast<std::int64_t>(column * n));
  for (std::size_t k = 0; k < n * n; ++k) full.rows.push_back(static_cast<std::int64_t>(k % n));
  return full;
}

/// y += c x.
void add(double c, const double* x, std::span<double> y) {
  for (std::size_t i = 0; i < y.size(); ++i) y[i] += c * x[i];
}

}  // namespace

RosenbrockSolver::RosenbrockSolver(OdeSystem& system, double t0, std::span<const double> x0, double end,
                                   double length, const SolverSettings& settings)
    : system_(system),
      n_(system.size()),
      settings_(settings),
      longest_(settings.max_step),
      matrix_(system.pattern()),
      rates_(n_),
      by_time_(n_),
      at_(n_),
      stages_(Rodas5p::kStages * n_),
      derivatives_(n_),
      after_(n_),
      rates_after_(n_),
      between_after_(3 * n_),
      before_(n_),
      between_(3 * n_) {
  restart(t0, x0, end, length);
}

void RosenbrockSolver::restart(double t, std::span<const double> x, double end, double length) {
  x_.assign(x.begin(), x.end());
  start_ = t_ = t;
  end_ = end;
  length_ = length;
  clock_ = 0;
  step_ = 0;
  small_steps_.restart();
  next_.reset();
  first_ = true;
  knows_linearisation_ = false;
}

void RosenbrockSolver::limit_step(double longest) {
  longest_ = std::min(longest, settings_.max_step);
}

SolverFailure RosenbrockSolver::failure() const {
  using Kind = SolverFailure::Kind;
  return {saw_not_finite_ ? Kind::not_finite : saw_refusal_ ? Kind::no_value : Kind::small_step, t_, 0};
}

/// False where there is no value.
bool RosenbrockSolver::evaluate(double clock, std::span<const double> x, std::span<double> dxdt) {
  if (system_.is_to_end()) throw SolverFailure{SolverFailure::Kind::interrupted, t_, 0};
  ++statistics_.evaluations;
  if (!system_.derivatives(time_of(clock), x.data(), dxdt.data())) {
    saw_refusal_ = true;
    return false;
  }
  if (all_finite(dxdt)) return true;
  saw_not_finite_ = true;
  return false;
}

/// In which the states change by a part of themselves, or of what is small beside a machine unit.
double RosenbrockSolver::first_step() const {
  double size = 0, rate = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const double weight =
        1 / (settings_.absolute_tolerance_of(i) + settings_.relative_tolerance * std::abs(x_[i]));
    size = std::max(size, std::abs(x_[i]) * weight);
    rate = std::max(rate, std::abs(rates_[i]) * weight);
  }
  size = std::max(size, kFirstChange / settings_.relative_tolerance);
  const double most = kFirstPart * length_;
  return rate * most > kFirstChange * size ? kFirstChange * size / rate : most;
}

void RosenbrockSolver::begin() {
  if (!evaluate(0, x_, rates_)) throw failure();
  by_time_matters_ = system_.depends_on_time();
  next_ = first_step();
}

double RosenbrockSolver::length_of_next() const {
  const double left = length_ - clock_, h = std::min(*next_, longest_);
  if (h >= left) return left;
  return 2 * h > left ? left / 2 : h;
}

double RosenbrockSolver::step() {
  if (statistics_.steps >= settings_.max_steps) throw SolverFailure{SolverFailure::Kind::step_budget, t_, 0};
  if (!small_steps_.any()) saw_refusal_ = saw_not_finite_ = false;
  if (!next_) begin();
  bool tried = false;
  for (int tries = 0; tries < kMostTries; ++tries) {
    const double h = length_of_next();
    if (!(clock_ + h > clock_)) break;
    const Outcome outcome = try_step(h);
    if (outcome == Outcome::impossible) {
      next_ = kRefusedFactor * h;
    } else {
      next_ = h * factor_after(outcome, tried);
    }
    if (outcome == Outcome::taken) {
      const double before = clock_;
      take(h);
      if (small_steps_.take(before, clock_, length_, t_, has_moved())) throw failure();
      return t_;
    }
    tried = true;
  }
  throw failure();
}

/// How much longer than the one just tried the next step is to be.
double RosenbrockSolver::factor_after(Outcome outcome, bool tried) {
  const double wanted = std::isfinite(error_) ? kSafety * std::pow(error_, -0.2) : kLeastFactor;
  const double factor = std::clamp(wanted, kLeastFactor, first_ ? kMostFirstFactor : kMostFactor);
  if (outcome == Outcome::taken) return tried ? std::min(factor, 1.0) : factor;
  ++statistics_.error_test_failures;
  // An error that stays as the step becomes shorter is that of a decay much faster than the step.
  return tried ? kLeastFactor : std::min(factor, kSafety);
}

RosenbrockSolver::Outcome RosenbrockSolver::try_step(double h) {
  if (!knows_linearisation_ && !linearise(h)) return Outcome::impossible;
  ++statistics_.factorizations;
  if (!factors_->factorise(jacobian_, 1 / (h * Rodas5p::kGamma))) return Outcome::impossible;
  if (!run_stages(h)) return Outcome::impossible;
  if (!all_finite(after_)) {
    saw_not_finite_ = true;
    return Outcome::impossible;
  }
  error_ = error_of(std::span(stages_).last(n_));
  if (!(error_ <= 1)) return Outcome::inaccurate;
  find_between();
  if (!look_between(h)) return Outcome::impossible;
  if (!(error_ <= 1)) return Outcome::inaccurate;
  const double clock = h >= length_ - clock_ ? length_ : clock_ + h;
  if (system_.way_back(time_of(clock), after_.data(), h, derivatives_.data()))
    add(1, derivatives_.data(), after_);
  return evaluate(clock, after_, rates_after_) ? Outcome::taken : Outcome::impossible;
}

/// df/dx and df/dt at the time reached. Where there is no df/dx just there (of a root of zero), one within
/// the step serves for it: the error that it makes is in the estimate.
bool RosenbrockSolver::linearise(double h) {
  knows_linearisation_ = differentiate(clock_, x_);
  if (!knows_linearisation_) {
    at_ = x_;
    add(h / 2, rates_.data(), at_);
    if (!differentiate(clock_ + h / 2, at_)) return false;
  }
  if (by_time_matters_) differentiate_by_time(h);
  return true;
}

bool RosenbrockSolver::differentiate(double clock, std::span<const double> x) {
  ++statistics_.jacobians;
  if (!system_.is_jacobian_exact()) return take_differences(clock, x);
  factors_ = &matrix_;
  jacobian_.resize(system_.pattern().entries());
  if (!system_.jacobian(time_of(clock), x.data(), jacobian_.data())) {
    saw_refusal_ = true;
    return false;
  }
  return all_finite(jacobian_);
}

bool RosenbrockSolver::take_differences(double clock, std::span<const double> x) {
  if (!full_matrix_) full_matrix_.emplace(full_pattern(n_));
  factors_ = &*full_matrix_;
  jacobian_.resize(n_ * n_);
  std::vector<double> moved(x.begin(), x.end()), here(n_);
  if (!evaluate(clock, x, here)) return false;
  const double part = std::sqrt(kEpsilon);
  for (std::size_t j = 0; j < n_; ++j) {
    const double size =
        std::max(std::abs(x[j]), settings_.absolute_tolerance_of(j) / settings_.relative_tolerance);
    bool known = false;
    for (const double change : {part * size, -part * size}) {
      moved[j] = x[j] + change;
      if (!(known = evaluate(clock, moved, derivatives_))) continue;
      for (std::size_t i = 0; i < n_; ++i)
        jacobian_[j * n_ + i] = (derivatives_[i] - here[i]) / (moved[j] - x[j]);
      break;
    }
    moved[j] = x[j];
    if (!known) return false;
  }
  return true;
}

/// From values at the time reached and at two later ones within the segment.
void RosenbrockSolver::differentiate_by_time(double h) {
  std::fill(by_time_.begin(), by_time_.end(), 0.0);
  const double apart = std::max(kTimePart * h, kTimeRoundings * kEpsilon * std::abs(t_));
  const double most = (length_ - clock_) / 2;
  double times[2];
  for (int k = 0; k < 2; ++k) times[k] = time_of(clock_ + (k + 1) * std::min(apart, most)) - t_;
  const double a = times[0], b = times[1];
  if (!(a > 0) || !(b > a)) return;  // nothing changes in what the clock cannot show
  if (!evaluate(clock_ + std::min(apart, most), x_, derivatives_)) return;
  if (!evaluate(clock_ + 2 * std::min(apart, most), x_, at_)) return;
  for (std::size_t i = 0; i < n_; ++i) {
    by_time_[i] = (b / a * (derivatives_[i] - rates_[i]) - a / b * (at_[i] - rates_[i])) / (b - a);
  }
}

bool RosenbrockSolver::run_stages(double h) {
  const auto stage = [this](std::size_t k) { return std::span(stages_).subspan(k * n_, n_); };
  for (std::size_t i = 0; i < Rodas5p::kStages; ++i) {
    const bool goes_on = i + 2 >= Rodas5p::kStages;  // from where the stage before has ended
    if (goes_on) {
      add(1, stage(i - 1).data(), at_);
    } else {
      std::copy(x_.begin(), x_.end(), at_.begin());
      for (std::size_t j = 0; j < i; ++j) add(Rodas5p::a[i][j], stage(j).data(), at_);
    }
    const double part = Rodas5p::c[i];
    const double clock = part == 1 && h >= length_ - clock_ ? length_ : clock_ + part * h;
    const std::span<double> right = stage(i);
    if (i == 0) {
      std::copy(rates_.begin(), rates_.end(), right.begin());
    } else if (!evaluate(clock, at_, right)) {
      return false;
    }
    for (std::size_t j = 0; j < i; ++j) add(Rodas5p::C[i][j] / h, stage(j).data(), right);
    if (by_time_matters_ && Rodas5p::d[i] != 0) add(h * Rodas5p::d[i], by_time_.data(), right);
    factors_->solve(right);
  }
  std::copy(at_.begin(), at_.end(), after_.begin());
  add(1, stage(Rodas5p::kStages - 1).data(), after_);
  return true;
}

std::vector<double> RosenbrockSolver::weighted_errors() const {
  std::vector<double> errors(n_);
  const double* const last = stages_.data() + (Rodas5p::kStages - 1) * n_;
  for (std::size_t i = 0; i < n_; ++i) {
    const double size = std::max(std::abs(x_[i]), std::abs(after_[i]));
    errors[i] =
        std::abs(last[i]) / (settings_.absolute_tolerance_of(i) + settings_.relative_tolerance * size);
  }
  return errors;
}

/// A difference of states in the step that was tried, beside their tolerances.
double RosenbrockSolver::error_of(std::span<const double> difference) const {
  double largest = 0;
  for (std::size_t i = 0; i < n_; ++i) {
    const double size = std::max(std::abs(x_[i]), std::abs(after_[i]));
    largest = std::max(largest, std::abs(difference[i]) / (settings_.absolute_tolerance_of(i) +
                                                           settings_.relative_tolerance * size));
  }
  return largest;
}

/// The coefficients of the polynomial between the ends of the step that was tried.
void RosenbrockSolver::find_between() {
  std::fill(between_after_.begin(), between_after_.end(), 0.0);
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t j = 0; j < Rodas5p::kStages; ++j)
      add(Rodas5p::between[k][j], stages_.data() + j * n_, std::span(between_after_).subspan(k * n_, n_));
  }
}

/// Takes the error of that polynomial into account, too. At the end of a step what is stiff is right by
/// itself, however long the step, and so is the estimate there; within the step it is the worse. With p the
/// polynomial and r = p′ − f(t, p) its residual, the error e obeys e′ = ∂f/∂x e + r, which an implicit step
/// solves with the matrix that is there already. False where there is no value.
bool RosenbrockSolver::look_between(double h) {
  const double part = kLookAt, rest = 1 - part;
  for (std::size_t i = 0; i < n_; ++i) {
    const double c2 = between_after_[n_ + i], c3 = between_after_[2 * n_ + i];
    const double bend = between_after_[i] + part * (c2 + part * c3);
    at_[i] = rest * x_[i] + part * (after_[i] + rest * bend);
    derivatives_[i] = (after_[i] - x_[i] + (rest - part) * bend + part * rest * (c2 + 2 * part * c3)) / h;
  }
  std::vector<double>& residual = rates_after_;
  if (!evaluate(clock_ + part * h, at_, residual)) return false;
  for (std::size_t i = 0; i < n_; ++i) residual[i] -= derivatives_[i];
  factors_->solve(residual);
  error_ = std::max(error_, error_of(residual));
  return true;
}

/// The step is over: what follows begins at its end.
void RosenbrockSolver::take(double h) {
  between_.swap(between_after_);
  before_.swap(x_);
  std::copy(after_.begin(), after_.end(), x_.begin());
  rates_.swap(rates_after_);
  clock_ = h >= length_ - clock_ ? length_ : clock_ + h;
  t_ = time_within(start_, clock_, end_, length_);
  step_ = h;
  ++statistics_.steps;
  statistics_.last_step = h;
  first_ = false;
  knows_linearisation_ = false;
}

/// Whether any state has moved in the last step by more than a few roundings.
bool RosenbrockSolver::has_moved() const {
  for (std::size_t i = 0; i < n_; ++i) {
    if (std::abs(x_[i] - before_[i]) > 4 * kEpsilon * std::abs(x_[i])) return true;
  }
  return false;
}

/// Where in the last step a time is: from 0 to 1.
double RosenbrockSolver::part_of(double t) const {
  if (t >= t_) return 1;
  return std::clamp(1 - (clock_ - (t - start_)) / step_, 0.0, 1.0);
}

void RosenbrockSolver::states_at(double t, std::span<double> x) const {
  const double part = step_ > 0 ? part_of(t) : 1, rest = 1 - part;
  if (part == 1) {
    std::copy(x_.begin(), x_.end(), x.begin());
    return;
  }
  for (std::size_t i = 0; i < n_; ++i) {
    const double bend = between_[i] + part * (between_[n_ + i] + part * between_[2 * n_ + i]);
    x[i] = rest * before_[i] + part * (x_[i] + rest * bend);
  }
}

void RosenbrockSolver::rates_at(double t, std::span<double> dxdt) const {
  if (!(step_ > 0)) {
    std::fill(dxdt.begin(), dxdt.end(), 0.0);
    if (next_) std::copy(rates_.begin(), rates_.end(), dxdt.begin());
    return;
  }
  const double part = part_of(t), rest = 1 - part;
  for (std::size_t i = 0; i < n_; ++i) {
    const double bend = between_[i] + part * (between_[n_ + i] + part * between_[2 * n_ + i]);
    const double slope = between_[n_ + i] + 2 * part * between_[2 * n_ + i];
    dxdt[i] = (x_[i] - before_[i] + (rest - part) * bend + part * rest * slope) / step_;
  }
}

}  // namespace oblique::solve
