// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/event_function_errors.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/driving_states.h>
#include <oblique/solve/readings/error_signs.h>

namespace oblique::solve {

EventFunctionErrors::EventFunctionErrors(const network::Program& program, double tolerance,
                                         double absolute_tolerance)
    : program_(program),
      tolerance_(tolerance),
      absolute_tolerance_(absolute_tolerance),
      errors_(program.switches().size(), 0.0),
      undamped_(errors_) {}

/// The absolute error that the solver leaves to a state.
double EventFunctionErrors::error_of_state(std::size_t i) const {
  const double own = program_.states()[i].tolerance;
  const double least = own > 0 ? own : absolute_tolerance_;
  return reach_.empty() || reach_[i] == 0 ? least : std::min(least, tolerance_ * reach_[i]);
}

/// By how much an event function that changes so for errors of the states is off.
double EventFunctionErrors::change(double rate, double still) const {
  const double error = std::abs(rate - still);
  return std::isfinite(error) ? error : tolerance_;
}

void EventFunctionErrors::weigh(const network::Evaluation& here, std::span<const double> states,
                                ErrorDamping* damping) {
  constexpr double kErrorOfClock = 1e-13;  // it is a straight line to any method
  constexpr double kDamped = 0.1;          // of them: what is damped by less is that of slow states
  std::vector<bool> clocks(program_.n_states(), false);
  for (std::size_t c = 0; c < program_.clocks(); ++c) clocks[program_.source_states()[c]] = true;
  std::vector<double> off(program_.n_states(), 0.0), rates(errors_.size()), still(errors_.size());
  here.event_function_rates(off.data(), still.data());
  std::fill(errors_.begin(), errors_.end(), 0.0);
  std::fill(undamped_.begin(), undamped_.end(), 0.0);
  for (std::uint64_t trial = 0; trial < ErrorSigns::kTrials; ++trial) {
    ErrorSigns signs(trial);
    for (std::size_t i = 0; i < off.size(); ++i) {
      const double size = std::abs(states[i]);
      const double error = clocks[i] ? kErrorOfClock * (1 + size) : tolerance_ * size + error_of_state(i);
      off[i] = trial == 0 ? error : signs.next() * error;
    }
    here.event_function_rates(off.data(), rates.data());
    for (std::size_t s = 0; s < errors_.size(); ++s)
      undamped_[s] = std::max(undamped_[s], change(rates[s], still[s]));
    if (damping == nullptr) continue;
    damping->apply(off);
    here.event_function_rates(off.data(), rates.data());
    for (std::size_t s = 0; s < errors_.size(); ++s)
      errors_[s] = std::max(errors_[s], change(rates[s], still[s]));
  }
  if (damping == nullptr) errors_ = undamped_;
  for (std::size_t s = 0; s < errors_.size(); ++s) {
    if (!(errors_[s] < kDamped * undamped_[s])) errors_[s] = undamped_[s];
  }
}

std::vector<std::size_t> EventFunctionErrors::states_behind(std::uint32_t s, const network::Evaluation& here,
                                                            std::span<const double> states) const {
  constexpr double kHardlyKnown = 1e4;  // errors
  constexpr double kPart = 1e-2;        // of the event function's error
  const std::size_t n = program_.n_states();
  std::vector<double> off(n, 0.0), rates(errors_.size());
  here.event_function_rates(off.data(), rates.data());
  const double still = rates[s];
  std::vector<bool> moves(n, false);
  for (std::size_t i = 0; i < n; ++i) {
    off[i] = error_of_state(i);
    here.event_function_rates(off.data(), rates.data());
    off[i] = 0;
    moves[i] = std::abs(rates[s] - still) > kPart * errors_[s];
  }
  const std::vector<bool> behind = with_driving_states(program_.jacobian_pattern(), std::move(moves));
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < n; ++i) {
    if (behind[i] && std::abs(states[i]) <= kHardlyKnown * error_of_state(i)) found.push_back(i);
  }
  return found;
}

}  // namespace oblique::solve
