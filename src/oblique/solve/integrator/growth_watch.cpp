// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/growth_watch.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/Dense>

namespace oblique::solve {
namespace {

/// A run is to be good to so many of its tolerances where it grows out of an equilibrium. While it does so by
/// e² the solver makes errors of so many of its own, relative ones, as parts of the distance: by Adams and
/// BDF some 3, by Rodas5P 0.2 (the distance has become e² times as large by then).
constexpr double kKept = 100, kMade = 20, kMadeByRodas = 1.5;
/// Its absolute ones come to as much; but a finer run can make them smaller alone. As a part of the size at
/// which they are as large as the relative ones:
constexpr double kNearZero = 2e-2;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// In powers of e: what has grown more is judged. Less is the growth of every step that turns away.
constexpr double kGrown = 2;

/// A Jacobian is looked at after so many steps, ever more of them where nothing grows and nothing is near
/// zero, or where what was near has grown by so much since, in powers of e.
constexpr int kStepsBetween = 8, kMostStepsBetween = 32;
constexpr double kGrownBetween = 0.25;

/// More states than these are not asked by differences.
constexpr std::size_t kMostByDifferences = 100;
constexpr double kDifference = 1e-7;  ///< [of a state, or machine unit]
/// Of the rates: what is left of them where there is no equilibrium, though the linearised equations have
/// one.
constexpr double kNoRoot = 0.3;

bool is_any(const std::vector<bool>& states) {
  return std::find(states.begin(), states.end(), true) != states.end();
}

}  // namespace

GrowthWatch::GrowthWatch(OdeSystem& system, const SolverSettings& settings, double span)
    : system_(system),
      settings_(settings),
      span_(span),
      steps_between_(kStepsBetween),
      near_part_((settings.method == diagram::IntegrationMethod::rodas ? kMadeByRodas : kMade) *
                 settings.relative_tolerance / (kKept * settings.asked)),
      change_(system.size()),
      jacobian_(system.pattern().entries()),
      small_modes_(system.pattern()),
      modes_(system.pattern()),
      growth_(system.size()),
      distance_(system.size()),
      least_(system.size(), kInfinity),
      acts_with_(system.size()),
      near_(system.size()),
      near_zero_(system.size()),
      told_(system.size()),
      stood_(system.size()),
      held_since_(system.size()) {
  for (std::size_t i = 0; i < system.size(); ++i)
    switch_over_.push_back(settings_.absolute_tolerance_of(i) / settings_.relative_tolerance);
}

void GrowthWatch::restart(double t, std::span<const double> x) {
  if (before_.empty() || std::all_of(growth_.begin(), growth_.end(), [](double g) { return g == 0; }))
    judged_ = t;
  for (std::size_t i = 0; i < before_.size() && t > time_; ++i) stood_[i] = x[i] == before_[i];
  // Where segments are short, growth goes on through many of them: but for that of states that have jumped.
  for (std::size_t i = 0; i < before_.size(); ++i) {
    const bool near_zero = is_near_zero(i, x[i]) && is_near_zero(i, before_[i]);
    if (!near_zero && !(std::abs(x[i] - before_[i]) < near_distance(i, x[i]))) growth_[i] = 0;
  }
  before_.assign(x.begin(), x.end());
  time_ = t;
}

double GrowthWatch::near_distance(std::size_t i, double x) const {
  return near_part_ * (std::abs(x) + switch_over_[i]);
}

bool GrowthWatch::is_near_zero(std::size_t i, double x) const {
  return std::abs(x) < kNearZero * switch_over_[i];
}

/// Whether any state has moved, and by little or near zero.
bool GrowthWatch::is_near_rest(std::span<const double> x) {
  any_near_zero_ = false;
  bool any = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double change = std::abs(x[i] - before_[i]);
    const bool near = change > 0 && change < near_distance(i, x[i]);
    const bool near_zero = change > 0 && is_near_zero(i, x[i]) && is_near_zero(i, before_[i]);
    change_[i] = change;
    near_[i] = near;
    near_zero_[i] = near_zero;
    any_near_zero_ = any_near_zero_ || near_zero;
    any = any || near || near_zero;
  }
  return any;
}

void GrowthWatch::advance(double t, std::span<const double> x) {
  step_ = t - time_;
  const bool near = is_near_rest(x);
  time_ = t;
  if (!near) {
    std::fill(growth_.begin(), growth_.end(), 0.0);
    std::fill(least_.begin(), least_.end(), kInfinity);
    judged_ = t;
  } else if (++steps_ >= (any_near_zero_ ? kStepsBetween : steps_between_) ||
             fastest_ * (t - judged_) > kGrownBetween) {
    judge(t, x, step_);
    const bool grows = std::any_of(growth_.begin(), growth_.end(), [](double g) { return g > 0; });
    steps_between_ = grows ? kStepsBetween : std::min(2 * steps_between_, kMostStepsBetween);
    judged_ = t;
    steps_ = 0;
  }
  std::copy(x.begin(), x.end(), before_.begin());
}

/// ∂f/∂x of a state by itself, by the Jacobian that was looked at last.
double GrowthWatch::own_growth(std::size_t state) const {
  const network::SparsePattern& pattern = system_.pattern();
  for (auto k = pattern.column_starts[state]; k < pattern.column_starts[state + 1]; ++k) {
    const auto entry = static_cast<std::size_t>(k);
    if (pattern.rows[entry] == static_cast<std::int64_t>(state)) return jacobian_[entry];
  }
  return 0;
}

bool GrowthWatch::grows(double t, std::span<const double> x, double within, double part) {
  return system_.jacobian(t, x.data(), jacobian_.data()) && system_.own_growth() * within > part;
}

double GrowthWatch::outrun(double t, std::span<const double> x, double step) {
  // In powers of e: Euler's implicit step, the first one of BDF, turns the growth round from 1 on.
  constexpr double kMost = 0.5;
  constexpr double kFaster = 1.5;  // than what others hold: it is asked again
  const auto is_passed_over = [&](double rate) { return rate * step > kMost; };
  const double fastest = system_.own_growth();
  if (!is_passed_over(fastest)) return 0;
  // Of what was all held the Jacobian is looked at ever again, but not at each step.
  const bool is_held = fastest <= kFaster * fastest_held_;
  if ((is_held && ++held_steps_ < kStepsBetween) || !system_.jacobian(t, x.data(), jacobian_.data()))
    return 0;
  held_steps_ = 0;
  std::vector<double> rates(x.size());
  double outrun = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!is_passed_over(own_growth(i))) continue;
    const CoupledModes group = closed_modes(system_.pattern(), jacobian_, i);
    double rate = 0;
    for (const std::complex<double>& mode : group.eigenvalues) rate = std::max(rate, mode.real());
    if (!is_passed_over(rate) ||
        (!system_.is_jacobian_exact() && !grows_by_differences(t, x, group.states, rate))) {
      fastest_held_ = std::max(fastest_held_, own_growth(i));
      continue;
    }
    // From an equilibrium that is met exactly nothing grows.
    const bool moves =
        system_.derivatives(t, x.data(), rates.data()) &&
        std::any_of(group.states.begin(), group.states.end(), [&](std::size_t k) { return rates[k] != 0; });
    if (moves) outrun = std::max(outrun, rate);
  }
  return outrun;
}

void GrowthWatch::end() {
  if (steps_ > 0 && (is_any(near_) || any_near_zero_)) judge(time_, before_, step_);
}

/// Whether a mode of these states grows about as fast as the Jacobian says. That of a slide does not: it
/// takes the shares of the two sides as they are, and it is their change that holds the states on the
/// switching surface.
bool GrowthWatch::grows_by_differences(double t, std::span<const double> x,
                                       const std::vector<std::size_t>& states, double rate) {
  if (states.size() > kMostByDifferences) return true;
  const auto n = static_cast<Eigen::Index>(states.size());
  Eigen::MatrixXd matrix(n, n);
  std::vector<double> moved(x.begin(), x.end()), above(x.size()), below(x.size());
  for (Eigen::Index column = 0; column < n; ++column) {
    const std::size_t i = states[static_cast<std::size_t>(column)];
    const double off = kDifference * std::max(1.0, std::abs(x[i]));
    moved[i] = x[i] + off;
    if (!system_.derivatives(t, moved.data(), above.data())) return true;
    moved[i] = x[i] - off;
    if (!system_.derivatives(t, moved.data(), below.data())) return true;
    moved[i] = x[i];
    for (Eigen::Index row = 0; row < n; ++row) {
      const std::size_t k = states[static_cast<std::size_t>(row)];
      matrix(row, column) = (above[k] - below[k]) / (2 * off);
    }
  }
  if (!matrix.allFinite()) return true;
  return matrix.eigenvalues().real().maxCoeff() >= rate / 2;
}

/// How far from the equilibrium what the time does, and of one that is not zero what the other states do,
/// would take these states in a time constant of their growth, where they are [machine unit]: with
/// f = rate · (x − e) they grow as (x − e) + e′/rate does. An amplifier that leaves its limit begins at e
/// exactly, and yet nothing but e′ decides where it goes.
double GrowthWatch::driven_distance(double t, std::span<const double> x,
                                    const std::vector<std::size_t>& states, double rate, bool zero) {
  const double dt = std::min(step_, 1 / rate);
  std::vector<double> past(x.begin(), x.end()), now(x.size()), before(x.size());
  for (std::size_t i = 0; i < x.size() && !zero; ++i) past[i] -= (x[i] - before_[i]) * dt / step_;
  for (const std::size_t i : states) past[i] = x[i];
  if (!system_.derivatives(t - dt, past.data(), before.data()) ||
      !system_.derivatives(t, x.data(), now.data()))
    return 0;
  double distance = 0;
  for (const std::size_t i : states)
    distance = std::max(distance, std::abs((zero ? 0 : now[i]) + (now[i] - before[i]) / (dt * rate)) / rate);
  return distance;
}

/// Whether errors move the time at which these states leave the equilibrium by less than the tolerance shows:
/// a real amplifier goes from one limit to the other at once, whatever it started from. What stood at a limit
/// was known exactly, and no step is longer than its growth takes (see `outrun`): each errs by a part of the
/// distance that it has come to, so that neither the side is in doubt nor the time by more than that.
bool GrowthWatch::leaves_at_once(std::span<const double> x, const std::vector<std::size_t>& states,
                                 double rate, double distance) const {
  // Nearer than so many errors the side is not known: those of the whole run, or of a few steps.
  constexpr double kErrors = 100, kErrorsOfSteps = 5;
  const double most = settings_.relative_tolerance * span_;
  constexpr double kOwn = 0.5;  // of the growth: of a state that makes it
  bool any = false, stood = true;
  for (const std::size_t i : states) {
    if (own_growth(i) < kOwn * rate) continue;
    any = true;
    stood = stood && stood_[i];
  }
  stood = stood && any;
  if (stood && 1 / rate < most) return true;
  double error = 0;
  for (const std::size_t i : states)
    error =
        std::max(error, settings_.relative_tolerance * std::abs(x[i]) + settings_.absolute_tolerance_of(i));
  return distance > (stood ? kErrorsOfSteps : kErrors) * error && error / distance / rate < most;
}

void GrowthWatch::judge(double t, std::span<const double> x, double step) {
  if (!system_.jacobian(t, x.data(), jacobian_.data())) return;
  ++looked_;
  fastest_ = 0;
  std::vector<bool> unstable(x.size(), false), small(x.size(), false);
  for (const CoupledModes& group : small_modes_.find(jacobian_, near_zero_)) {
    judge(group, t, x, step, true, unstable);
    watch_amplitude(group.states, t, x);
    for (const std::size_t i : group.states) small[i] = true;
  }
  for (const CoupledModes& group : modes_.find(jacobian_, near_)) judge(group, t, x, step, false, unstable);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!unstable[i]) growth_[i] = 0;
    if (!small[i]) least_[i] = kInfinity;
  }
}

/// Growth that no mode shows at any instant, as that of a swing whose length changes: states near zero, where
/// they would stay by themselves, that have become many times as large.
void GrowthWatch::watch_amplitude(const std::vector<std::size_t>& states, double t,
                                  std::span<const double> x) {
  constexpr double kTimes = 50;  // an oscillation takes its states through zero by turns
  double amplitude = 0, least = 0;
  for (const std::size_t i : states) amplitude = std::max(amplitude, std::abs(x[i]));
  constexpr double kOut = 0.05;  // of what counts as near zero: what stays below is not read as larger
  bool told = false, is_on_its_way = false;
  for (const std::size_t i : states) {
    const bool same = std::exchange(acts_with_[i], states.size()) == states.size();
    least_[i] = same ? std::min(least_[i], amplitude) : amplitude;
    least = std::max(least, least_[i]);
    told = told || told_[i];
    is_on_its_way = is_on_its_way || !is_near_zero(i, x[i] / kOut);
  }
  if (told || !is_on_its_way || !(amplitude > kTimes * least)) return;
  constexpr double kOfThemselves = 1e-3;  // of their rates: what is left of them at zero
  std::vector<double> zero(x.begin(), x.end()), there(x.size()), here(x.size());
  for (const std::size_t i : states) zero[i] = 0;
  if (!system_.derivatives(t, zero.data(), there.data()) || !system_.derivatives(t, x.data(), here.data()))
    return;
  double left = 0, largest = 0;
  for (const std::size_t i : states) {
    left = std::max(left, std::abs(there[i]));
    largest = std::max(largest, std::abs(here[i]));
  }
  if (!(left <= kOfThemselves * largest)) return;
  found_.push_back({t, states, least});
  for (const std::size_t i : states) told_[i] = true;
}

/// The same of states that act on each other, of an equilibrium at `zero` or elsewhere, unless they are found
/// to be `unstable` before.
void GrowthWatch::judge(const CoupledModes& group, double t, std::span<const double> x, double step,
                        bool zero, std::vector<bool>& unstable) {
  double rate = 0;
  for (const std::complex<double>& mode : group.eigenvalues) rate = std::max(rate, mode.real());
  fastest_ = std::max(fastest_, rate);
  if (rate == 0) return;
  // The equilibrium is as far as the states would go back in a time constant of their growth.
  const double part = std::min(1.0, rate * step);
  double distance = 0, size = 0;
  for (const std::size_t i : group.states) {
    if (unstable[i] || (!zero && !(change_[i] < part * near_distance(i, x[i])))) return;
    distance = std::max(distance, zero ? std::abs(x[i]) : change_[i] / part);
    size = std::max(size, std::abs(x[i]));
  }
  distance = std::max(distance, driven_distance(t, x, group.states, rate, zero));
  const auto is_near = [&](std::size_t i) { return distance < near_distance(i, x[i]); };
  if (!zero && std::none_of(group.states.begin(), group.states.end(), is_near)) return;
  const bool in_relative = !zero && size > 2 * distance;
  double least = distance;
  bool much = false, told = false;
  for (const std::size_t i : group.states) {
    unstable[i] = true;
    distance_[i] = growth_[i] == 0 ? distance : std::min(distance_[i], distance);
    growth_[i] += rate * (t - judged_);
    much = much || growth_[i] > kGrown;
    told = told || told_[i];
    least = std::min(least, distance_[i]);
  }
  if (!much || told || leaves_at_once(x, group.states, rate, least)) return;
  // Near may be the part of a loop that the rest of it holds. That is asked ever more seldom.
  const std::size_t first = group.states.front();
  const auto let_go = [&] {
    for (const std::size_t i : group.states) growth_[i] = 0;
  };
  if (held_since_[first] > 0 && looked_ < 2 * held_since_[first]) return let_go();
  const CoupledModes closed = closed_modes(system_.pattern(), jacobian_, first);
  const bool held = !closed.eigenvalues.empty() &&
                    std::all_of(closed.eigenvalues.begin(), closed.eigenvalues.end(),
                                [&](const std::complex<double>& mode) { return mode.real() < rate / 2; });
  if (held || (!system_.is_jacobian_exact() && !grows_by_differences(t, x, group.states, rate))) {
    held_since_[first] = looked_;
    return let_go();
  }
  found_.push_back({t, group.states, least, in_relative ? least / size : 0});
  for (const std::size_t i : group.states) told_[i] = true;
}

}  // namespace oblique::solve
