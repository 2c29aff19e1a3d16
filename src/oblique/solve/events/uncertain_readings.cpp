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

constexpr const char* kJumps = "by a signal that jumps at the same instant";
constexpr const char* kLetOneComeBefore = "let the one come a little before the other, as is meant";

/// Whether an event comes at a time of its own: whatever its condition compares follows the time alone.
bool is_of_time(const network::Program& program, const network::Event& event) {
  const std::vector<std::uint32_t> switches = program.switch_structure().positions_in(event.condition);
  return !event.of_mode && !switches.empty() &&
         std::all_of(switches.begin(), switches.end(),
                     [&](std::uint32_t s) { return program.switches()[s].rate.has_value(); });
}

}  // namespace

UncertainReadings::UncertainReadings(const network::Program& program, network::Workspace& workspace,
                                     const SlidingMode& slide, EventLog& log, const std::string& file)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      log_(log),
      file_(file),
      told_(program.events().size()),
      signals_(program.n_signals()) {
  for (const network::Event& event : program.events()) of_time_.push_back(is_of_time(program, event));
}

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

/// What events of the other blocks put at a time of their own (an edge of a pulse train): what comes at the
/// same instant does not read it yet.
std::vector<UncertainReadings::Put> UncertainReadings::as_after(std::span<const std::size_t> events,
                                                                std::span<const double> values,
                                                                const std::string& block) const {
  std::vector<Put> puts;
  std::size_t k = 0;
  for (const std::size_t e : events) {
    const network::Event& event = program_.events()[e];
    for (const network::Event::Action& action : event.actions) {
      const double value = values[k++];
      if (of_time_[e] && event.block != block && !action.on_state &&
          value != workspace_.discrete_state(action.index))
        puts.push_back({action.index, value});
    }
  }
  return puts;
}

/// These, and the comparisons that turn over by them.
std::vector<UncertainReadings::Put> UncertainReadings::led_to_by(std::vector<Put> puts, double t,
                                                                 std::span<const double> x) {
  std::vector<double> now(program_.switches().size()), then(now.size());
  const std::vector<double> discrete_states(workspace_.discrete_states().begin(),
                                            workspace_.discrete_states().end());
  const KeptUnknowns kept(program_, workspace_);
  if (!program_.event_functions(t, x.data(), now.data(), workspace_)) return puts;
  for (const auto& [discrete_state, value] : puts) workspace_.set_discrete_state(discrete_state, value);
  const bool is_there = program_.event_functions(t, x.data(), then.data(), workspace_).has_value();
  workspace_.load_discrete_states(discrete_states);
  for (std::uint32_t s = 0; is_there && s < now.size(); ++s) {
    if ((then[s] > 0) != (now[s] > 0))
      puts.push_back({program_.switches()[s].discrete_state, then[s] > 0 ? 1.0 : 0.0});
  }
  return puts;
}

void UncertainReadings::look(std::span<const std::size_t> events, std::span<const double> values, double t,
                             std::span<const double> x) {
  if (std::all_of(events.begin(), events.end(), [&](std::size_t event) { return told_[event]; })) return;
  const std::vector<Put> before = as_before(events);
  if (!before.empty()) {
    tell(events, values, values_with(before, events, t, x), t,
         {kJumps, "from after the jump; before it that was", kLetOneComeBefore});
  }
  std::size_t first = 0;
  for (const std::size_t event : events) {
    const std::size_t n = program_.events()[event].actions.size();
    const std::vector<Put> after = as_after(events, values, program_.events()[event].block);
    if (!after.empty()) {
      const std::size_t alone[] = {event};
      tell(alone, values.subspan(first, n), values_with(led_to_by(after, t, x), alone, t, x), t,
           {kJumps, "from before the jump; after it that is", kLetOneComeBefore});
    }
    first += n;
  }
  for (const std::uint32_t unit : slide_.units()) {
    std::vector<Put> flipped;
    const auto& members = program_.switch_structure().members[unit];
    for (const std::uint32_t s : members) {
      const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
      flipped.push_back({discrete_state, 1 - workspace_.discrete_state(discrete_state)});
    }
    tell(events, values, values_with(flipped, events, t, x), t,
         {fmt::format("by a signal of '{}', which slides along its switching surface",
                      program_.switches()[members.front()].block),
          "and as well it could be", "give the switch that slides a hysteresis, or smooth what is kept"});
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
                             std::span<const double> others, double t, const Doubt& doubt) {
  std::size_t k = 0;
  for (const std::size_t event : events) {
    const network::Event& what = program_.events()[event];
    for (std::size_t a = 0; a < what.actions.size(); ++a, ++k) {
      if (k >= others.size() || told_[event] || what.repeats) continue;
      const double value = values[k], other = others[k];
      if (!(std::abs(value - other) > kMatters * std::max({1.0, std::abs(value), std::abs(other)}))) continue;
      told_[event] = true;
      log_.warn({{file_, {}},
                 fmt::format("'{}' sets what it keeps {}: at t = {:.9g} s it takes {:.6g}, {} {:.6g}",
                             what.block, doubt.by, t, value, doubt.other, other),
                 {},
                 doubt.remedy});
    }
  }
}

}  // namespace oblique::solve
