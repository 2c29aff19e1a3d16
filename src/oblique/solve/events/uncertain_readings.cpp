// SPDX-License-Identifier: MIT
#include <oblique/solve/events/uncertain_readings.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/solve/events/kept_unknowns.h>

namespace oblique::solve {
namespace {

/// What two values differ by at least, beside their size or a machine unit, where the order of things
/// matters.
constexpr double kMatters = 1e-6;

}  // namespace

UncertainReadings::UncertainReadings(const network::Program& program, network::Workspace& workspace,
                                     const SlidingMode& slide, EventLog& log, const std::string& file)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      log_(log),
      file_(file),
      told_(program.events().size()),
      signals_(program.n_signals()) {}

/// What has changed at this instant, as it was before: but the comparisons that the conditions of these
/// events are made of, and what their blocks keep, which are known as they are from now on.
std::vector<UncertainReadings::Put> UncertainReadings::as_before(std::span<const std::size_t> events) const {
  if (before_.empty()) return {};  // where the run starts
  std::vector<bool> own(before_.size());
  for (const std::size_t event : events) {
    const network::Event& what = program_.events()[event];
    for (const std::uint32_t s : program_.switch_structure().positions_in(what.condition)) {
      const network::Switch& made = program_.switches()[s];
      if (made.block == what.block) own[made.discrete_state] = true;
    }
    for (const network::Event& other : program_.events()) {
      if (other.block != what.block) continue;
      for (const network::Event::Action& action : other.actions) {
        if (!action.on_state) own[action.index] = true;
      }
    }
  }
  std::vector<Put> changed;
  for (std::uint32_t m = 0; m < before_.size(); ++m) {
    if (!own[m] && workspace_.discrete_state(m) != before_[m]) changed.push_back({m, before_[m]});
  }
  return changed;
}

void UncertainReadings::look(std::span<const std::size_t> events, std::span<const double> values, double t,
                             std::span<const double> x) {
  if (std::all_of(events.begin(), events.end(), [&](std::size_t event) { return told_[event]; })) return;
  const std::vector<Put> before = as_before(events);
  if (!before.empty()) tell(events, values, values_with(before, events, t, x), t, {});
  for (const std::uint32_t unit : slide_.units()) {
    std::vector<Put> flipped;
    const auto& members = program_.switch_structure().members[unit];
    for (const std::uint32_t s : members) {
      const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
      flipped.push_back({discrete_state, 1 - workspace_.discrete_state(discrete_state)});
    }
    tell(events, values, values_with(flipped, events, t, x), t, program_.switches()[members.front()].block);
  }
}

std::vector<double> UncertainReadings::values_with(std::span<const Put> others,
                                                   std::span<const std::size_t> events, double t,
                                                   std::span<const double> x) {
  const std::vector<double> discrete_states(workspace_.discrete_states().begin(),
                                            workspace_.discrete_states().end());
  const KeptUnknowns kept(program_, workspace_);
  for (const auto& [discrete_state, value] : others) workspace_.set_discrete_state(discrete_state, value);
  std::vector<double> values;
  if (const auto there = program_.signals(t, x.data(), signals_.data(), workspace_)) {
    for (const std::size_t event : events) {
      for (std::size_t a = 0; a < program_.events()[event].actions.size(); ++a)
        values.push_back(there->action_value(event, a));
    }
  }
  workspace_.load_discrete_states(discrete_states);
  return values;
}

void UncertainReadings::tell(std::span<const std::size_t> events, std::span<const double> values,
                             std::span<const double> others, double t, const std::string& sliding) {
  std::size_t k = 0;
  for (const std::size_t event : events) {
    const network::Event& what = program_.events()[event];
    for (std::size_t a = 0; a < what.actions.size(); ++a, ++k) {
      if (k >= others.size() || told_[event] || what.repeats) continue;
      const double value = values[k], other = others[k];
      if (!(std::abs(value - other) > kMatters * std::max({1.0, std::abs(value), std::abs(other)}))) continue;
      told_[event] = true;
      if (sliding.empty()) {
        log_.warn({{file_, {}},
                   fmt::format(
                       "'{}' sets what it keeps by a signal that jumps at the same instant: at t = {:.9g} s "
                       "it takes {:.6g}, from after the jump; before it that was {:.6g}",
                       what.block, t, value, other),
                   {},
                   "let the one come a little before the other, as is meant"});
      } else {
        log_.warn(
            {{file_, {}},
             fmt::format("'{}' sets what it keeps by a signal of '{}', which slides along its switching "
                         "surface: at t = {:.9g} s it takes {:.6g}, and as well it could be {:.6g}",
                         what.block, sliding, t, value, other),
             {},
             "give the switch that slides a hysteresis, or smooth what is kept"});
      }
    }
  }
}

}  // namespace oblique::solve
