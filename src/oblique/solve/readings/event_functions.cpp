// SPDX-License-Identifier: MIT
#include <oblique/solve/readings/event_functions.h>

#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/readings/driven_states.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>

namespace oblique::solve {

std::optional<double> announced_position(const network::SwitchStructure& structure,
                                         const Announced& announced, std::size_t s) {
  std::optional<double> position;
  for (const std::uint32_t member : structure.members[structure.unit[s]]) {
    if (announced[member])
      position =
          structure.opposite[member] == structure.opposite[s] ? *announced[member] : 1 - *announced[member];
  }
  return position;
}

EventFunctions::EventFunctions(const network::Program& program, network::Workspace& workspace,
                               double tolerance, double absolute_tolerance, const std::string& file)
    : program_(program),
      workspace_(workspace),
      file_(file),
      thresholds_(program),
      errors_(program, tolerance, absolute_tolerance),
      damping_(program),
      damped_(program),
      values_(program.switches().size()),
      known_rates_(values_.size()) {}

void EventFunctions::evaluate(double t, std::span<const double> x, const Announced& announced) {
  interruption_.check();
  time_ = t;
  states_.assign(x.begin(), x.end());
  weighed_ = false;
  here_ = program_.event_functions(t, x.data(), values_.data(), workspace_);
  const bool known = here_.has_value();
  if (!known) {
    workspace_.pass_failing_loops(true);
    here_ = program_.event_functions(t, x.data(), values_.data(), workspace_);
    workspace_.pass_failing_loops(false);
  }
  thresholds_.update(t, here());
  for (std::size_t s = 0; s < known_rates_.size(); ++s) known_rates_[s] = here().known_rate(s);
  if (!known && !is_any_due(announced)) throw loop_error(program_, workspace_.trouble(), t, file_);
}

double EventFunctions::against(std::size_t s) const {
  return workspace_.discrete_state(program_.switches()[s].discrete_state) == 1 ? -values_[s] : values_[s];
}

void EventFunctions::keep_at_level(std::uint32_t unit) {
  for (const std::uint32_t s : program_.switch_structure().members[unit]) {
    const double off = 2 * std::abs(values_[s]);
    if (off > thresholds_[s]) thresholds_.widen(s, off);
  }
}

void EventFunctions::take_slack_since(std::span<const double> before) {
  for (std::size_t s = 0; s < values_.size(); ++s) {
    if (!(std::abs(values_[s] - before[s]) <= thresholds_.rounding(s))) thresholds_.take_slack(s);
  }
}

/// Whether a switch is on the wrong side of its switching surface, or has not turned over though it was
/// announced, or a table is still to be moved along.
bool EventFunctions::is_any_due(const Announced& announced) const {
  for (std::size_t e = 0; e < program_.events().size(); ++e) {
    if (program_.events()[e].repeats && here().condition(e)) return true;
  }
  for (std::size_t s = 0; s < values_.size(); ++s) {
    const double position = workspace_.discrete_state(program_.switches()[s].discrete_state);
    if (announced[s] ? *announced[s] != position : against(s) > thresholds_[s]) return true;
  }
  return false;
}

bool EventFunctions::is_any_fine() {
  constexpr double kNear = 1000;  // undamped errors
  const EventFunctionErrors& errors = weigh_errors();
  for (std::size_t s = 0; s < values_.size(); ++s) {
    const double undamped = errors.undamped(s);
    if (!is_known(s) && errors[s] < undamped && std::abs(values_[s]) < kNear * undamped) return true;
  }
  return false;
}

void EventFunctions::take_steps(double length, const std::vector<std::uint32_t>& sliding) {
  damping_.take_steps(length);
  if (sliding == sliding_) return;
  sliding_ = sliding;
  leaves_ = false;
}

void EventFunctions::leave_what_slides() {
  if (leaves_) return;
  std::vector<bool> left;
  if (!sliding_.empty()) left = driven_states(program_, sliding_, time_, states_, workspace_);
  damping_.leave(left);
  damped_.leave(std::move(left));
  leaves_ = true;
}

const Interpolant& EventFunctions::within_step(const Interpolant& solution) {
  const bool damps =
      is_any_fine() && damped_.begin(solution, damping_.step_length(), time_, states_, workspace_);
  return damps ? static_cast<const Interpolant&>(damped_) : solution;
}

const EventFunctionErrors& EventFunctions::weigh_errors() {
  if (!weighed_) {
    if (damping_.any()) leave_what_slides();
    const bool damped = damping_.any() && damping_.linearise(time_, states_, workspace_);
    errors_.weigh(here(), states_, damped ? &damping_ : nullptr);
  }
  weighed_ = true;
  return errors_;
}

}  // namespace oblique::solve
