// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/small_states.h>

#include <algorithm>
#include <cmath>

#include <oblique/solve/stability/linear_factors.h>

namespace oblique::solve {
namespace {

/// Below this part of the size down to which the relative tolerance counts, a state is small.
constexpr double kSmall = 1e-2;

/// Of the solver's absolute tolerance: what its steps together leave to a state.
constexpr double kErrorOfState = 100;

/// Of the run's tolerance: an error of an output that is too much to say nothing of.
constexpr double kMuch = 1e4;
/// Of the largest magnitude of an event function: what moves its crossings. (Many are rates, and these move
/// by far more than what they are rates of.)
constexpr double kMuchOfEventFunction = 1e-2;

/// The same of an output that stands in small units beside larger states, times its own size.
constexpr double kMuchOfSmallOutput = 1e2;

/// A diagram that nowhere comes to so much stands in small units; less than the second is nothing in any
/// [machine unit].
constexpr double kSmallUnit = 1e-4, kStaysZero = 1e-13;

constexpr std::size_t kMostStates = 100;  ///< looked at one by one
constexpr double kRounding = 1e-15, kAboveRounding = 10;
constexpr double kErrorOfSteps = 10;  ///< of a tolerance: what the steps together leave to a state

}  // namespace

SmallStates::SmallStates(OdeSystem& system, const SolverSettings& settings, double tolerance, double span,
                         Readings readings, std::size_t n_readings, std::size_t n_relative)
    : system_(system),
      settings_(settings),
      tolerance_(tolerance),
      span_(span),
      readings_(std::move(readings)),
      n_relative_(n_relative),
      peaks_(system.size(), 0),
      noise_(system.size(), 0),
      left_by_others_(system.size(), 0),
      sizes_(n_readings, 0),
      values_(n_readings),
      moved_(n_readings),
      off_states_(system.size()),
      held_(system.size(), false) {}

bool SmallStates::is_small(std::size_t i) const {
  return peaks_[i] > 0 &&
         peaks_[i] < kSmall * settings_.absolute_tolerance_of(i) / settings_.relative_tolerance;
}

void SmallStates::advance(double t, std::span<const double> x) {
  for (std::size_t i = 0; i < x.size(); ++i) peaks_[i] = std::max(peaks_[i], std::abs(x[i]));
  system_.mark_held(t, x.data(), held_);
  if (steps_++ < next_look_) return;
  next_look_ = 2 * next_look_ + 1;
  look(t, x);
}

void SmallStates::look(double t, std::span<const double> x) {
  std::vector<std::size_t> small;
  for (std::size_t i = 0; i < x.size() && small.size() < kMostStates; ++i) {
    if (is_small(i)) small.push_back(i);
  }
  if (small.empty() || !readings_(t, x.data(), values_.data())) return;
  for (std::size_t k = 0; k < values_.size(); ++k) sizes_[k] = std::max(sizes_[k], std::abs(values_[k]));

  std::vector<double> rates(x.size()), rates_off(x.size());
  const bool known = system_.derivatives(t, x.data(), rates.data());
  const auto let_all_err_by = [&](double part, std::vector<double>& left, double part_of_held = 0) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double error = part * x[i] + (held_[i] ? part_of_held * settings_.absolute_tolerance_of(i) : 0);
      off_states_[i] = x[i] + (i % 2 == 0 ? error : -error);
    }
    if (!known || !system_.derivatives(t, off_states_.data(), rates_off.data())) return;
    for (const std::size_t i : small) left[i] = std::max(left[i], span_ * std::abs(rates_off[i] - rates[i]));
  };
  let_all_err_by(kRounding, noise_);
  let_all_err_by(kErrorOfSteps * settings_.relative_tolerance, left_by_others_, kErrorOfSteps);

  for (const std::size_t i : small) {
    std::vector<double> off(x.size(), 0.0);
    off[i] = kErrorOfState * settings_.absolute_tolerance_of(i);
    read(t, x, i, off);
  }
  const network::SparsePattern& pattern = system_.pattern();
  std::vector<double> jacobian(pattern.entries());
  if (!system_.jacobian(t, x.data(), jacobian.data())) return;
  const auto n = static_cast<Eigen::Index>(x.size());
  for (const double length : {1e-3 * span_, span_}) {
    std::vector<Eigen::Triplet<double>> entries;
    for (std::size_t column = 0; column < x.size(); ++column) {
      entries.emplace_back(column, column, 1);
      for (auto k = pattern.column_starts[column]; k < pattern.column_starts[column + 1]; ++k) {
        const auto entry = static_cast<std::size_t>(k);
        entries.emplace_back(pattern.rows[entry], column, -length * jacobian[entry]);
      }
    }
    const LinearFactors factors(n, entries);
    if (factors.sign() == 0) continue;
    for (const std::size_t i : small) {
      Eigen::VectorXd error = Eigen::VectorXd::Zero(n);
      error[static_cast<Eigen::Index>(i)] = kErrorOfState * settings_.absolute_tolerance_of(i);
      const Eigen::VectorXd off = factors.solve(error);
      read(t, x, i, {off.begin(), off.end()});
    }
  }
  readings_(t, x.data(), values_.data());  // leaves the solutions of algebraic loops where they were
}

/// Looks at the readings with the states off by so much.
void SmallStates::read(double t, std::span<const double> x, std::size_t state,
                       const std::vector<double>& off) {
  for (std::size_t i = 0; i < x.size(); ++i) off_states_[i] = x[i] + off[i];
  if (!readings_(t, off_states_.data(), moved_.data())) return;
  std::vector<double>& moves = moves_.try_emplace(state, values_.size(), 0.0).first->second;
  for (std::size_t k = 0; k < values_.size(); ++k)
    moves[k] = std::max(moves[k], std::abs(moved_[k] - values_[k]));
}

std::optional<std::size_t> SmallStates::reader_of(std::size_t state) const {
  const auto moves = moves_.find(state);
  if (moves == moves_.end()) return std::nullopt;
  const bool any_held = std::find(held_.begin(), held_.end(), true) != held_.end();
  for (std::size_t k = 0; k < sizes_.size(); ++k) {
    // An output that shows nothing larger is looked at beside its own size: but for what a slide may hold at
    // zero, and for what the errors of larger states leave where they cancel.
    const bool shows_small = !held_[state] && sizes_[k] > kStaysZero && sizes_[k] < kSmallUnit &&
                             peaks_[state] > left_by_others_[state];
    // Where something slides, others rest beside their switching surfaces by what rounding leaves of it.
    if (k >= n_relative_ && sizes_[k] < kStaysZero && any_held) continue;
    const double much = k >= n_relative_ ? kMuchOfEventFunction * sizes_[k]
                        : shows_small    ? kMuchOfSmallOutput * tolerance_ * sizes_[k]
                                         : kMuch * tolerance_ * std::max(1.0, sizes_[k]);
    if (much > 0 && moves->second[k] > much) return k;
  }
  return std::nullopt;
}

std::vector<SmallState> SmallStates::found() const {
  std::vector<SmallState> found;
  const bool small_units = n_relative_ > 0 && std::all_of(peaks_.begin(), peaks_.end(),
                                                          [](double peak) { return peak < kSmallUnit; });
  for (std::size_t i = 0; i < peaks_.size(); ++i) {
    if (!is_small(i) || peaks_[i] <= kAboveRounding * noise_[i]) continue;
    const auto reader = reader_of(i);
    if (reader || (small_units && !held_[i] && peaks_[i] > kStaysZero))
      found.push_back({i, peaks_[i], reader.value_or(0)});
  }
  return found;
}

}  // namespace oblique::solve
