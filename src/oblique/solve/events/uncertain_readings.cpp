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

void UncertainReadings::note_turns(std::span<const double> before) {
  for (std::uint32_t s = 0; s < program_.switches().size(); ++s) {
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    if (before[discrete_state] != workspace_.discrete_state(discrete_state))
      turned_.push_back({s, before[discrete_state]});
  }
}

/// Whether a switch is a comparison that the condition of an event is made of: then it is known as it is from
/// now on.
bool UncertainReadings::sets_off(std::uint32_t s, std::size_t event) const {
  const network::Event& what = program_.events()[event];
  if (program_.switches()[s].block != what.block) return false;
  const std::vector<std::uint32_t> own = program_.switch_structure().positions_in(what.condition);
  return std::binary_search(own.begin(), own.end(), s);
}

void UncertainReadings::look(std::span<const std::size_t> events, std::span<const double> values, double t,
                             std::span<const double> x) {
  if (std::all_of(events.begin(), events.end(), [&](std::size_t event) { return told_[event]; })) return;
  std::vector<Turned> others;
  std::copy_if(turned_.begin(), turned_.end(), std::back_inserter(others), [&](const Turned& turned) {
    return std::none_of(events.begin(), events.end(),
                        [&](std::size_t event) { return sets_off(turned.switch_index, event); });
  });
  if (!others.empty()) tell(events, values, values_with(others, events, t, x), t, {});
  for (const std::uint32_t unit : slide_.units()) {
    std::vector<Turned> flipped;
    for (const std::uint32_t s : program_.switch_structure().members[unit])
      flipped.push_back({s, 1 - workspace_.discrete_state(program_.switches()[s].discrete_state)});
    tell(events, values, values_with(flipped, events, t, x), t,
         program_.switches()[flipped.front().switch_index].block);
  }
}

std::vector<double> UncertainReadings::values_with(std::span<const Turned> positions,
                                                   std::span<const std::size_t> events, double t,
                                                   std::span<const double> x) {
  const std::vector<double> discrete_states(workspace_.discrete_states().begin(),
                                            workspace_.discrete_states().end());
  const KeptUnknowns kept(program_, workspace_);
  for (const auto& [s, position] : positions)
    workspace_.set_discrete_state(program_.switches()[s].discrete_state, position);
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
