// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/event_assembly.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/names.h>
#include <oblique/network/assembly/mode_assembly.h>

namespace oblique::network {
namespace {

std::vector<Event::Action> actions_of(Assembly& a, std::size_t block,
                                      const std::vector<diagram::EventAction>& rules) {
  std::vector<Event::Action> actions;
  for (const diagram::EventAction& rule : rules) {
    Event::Action done;
    const auto discrete_state = a.diagram.blocks[block].definition->find_memory(rule.target);
    done.on_state = !discrete_state;
    done.index = discrete_state ? a.first_discrete_state[block] + static_cast<std::uint32_t>(*discrete_state)
                                : a.quantities[a.quantity_of(block, rule.target)].variable_index;
    done.value = a.built(block, rule.value, rule.place, "an event's '" + rule.target + "'");
    actions.push_back(done);
  }
  return actions;
}

/// Whether an event puts something somewhere because its group is in a mode, so that it may be put there
/// again: none that counts.
bool puts_by_mode(const Assembly& a, std::size_t block, const diagram::EventRule& rule) {
  if (rule.when.kind != text::Expression::Kind::name || !mode_node(a, block, rule.when.name)) return false;
  return std::none_of(rule.actions.begin(), rule.actions.end(), [](const diagram::EventAction& action) {
    const auto read = diagram::names_in(action.value);
    return std::any_of(read.begin(), read.end(),
                       [&](const text::Expression* name) { return name->name == action.target; });
  });
}

}  // namespace

void find_active_events(Assembly& a) {
  for (std::size_t b = 0; b < a.diagram.blocks.size(); ++b) {
    for (const diagram::EventRule& rule : a.diagram.blocks[b].definition->events) {
      if (rule.where && a.constant_value(b, *rule.where).value_or(0) == 0) continue;
      const auto always = a.constant_value(b, rule.when);
      if (always && (*always == 0 || !rule.at_start)) continue;
      a.active_events.emplace_back(b, &rule);
    }
  }
}

void make_discrete_states(Assembly& a) {
  a.first_discrete_state.assign(a.diagram.blocks.size(), kNone);
  std::vector<bool> set(a.diagram.blocks.size(), false);
  for (const auto& [block, rule] : a.active_events) set[block] = true;
  for (std::size_t b = 0; b < a.diagram.blocks.size(); ++b) {
    const diagram::FlatBlock& block = a.diagram.blocks[b];
    if (!set[b]) continue;
    a.first_discrete_state[b] = static_cast<std::uint32_t>(a.network.discrete_states.size());
    for (const diagram::MemoryRule& discrete_state : block.definition->memories) {
      const double start = a.constant_value(b, discrete_state.initial).value_or(0);
      if (!std::isfinite(start)) {
        a.diagnostics.add({block.place,
                           fmt::format("'{}.{}' would start at {}", block.path, discrete_state.name, start),
                           "a finite start value",
                           {}});
      }
      a.network.discrete_states.push_back({block.path + "." + discrete_state.name, start});
    }
  }
}

NodeId discrete_state_node(Assembly& a, std::size_t block, std::size_t discrete_state) {
  if (a.first_discrete_state[block] != kNone)
    return a.network.graph.discrete_state(a.first_discrete_state[block] +
                                          static_cast<std::uint32_t>(discrete_state));
  const text::Expression& initial = a.diagram.blocks[block].definition->memories[discrete_state].initial;
  return a.network.graph.constant(a.constant_value(block, initial).value_or(0));
}

void make_events(Assembly& a) {
  for (const auto& [block, rule] : a.active_events) {
    Event event;
    event.block = a.diagram.blocks[block].path;
    event.at_start = rule->at_start;
    event.before_start = rule->before_start;
    event.of_mode = puts_by_mode(a, block, *rule);
    event.condition = a.built(block, rule->when, rule->place, "an event's 'when'");
    event.actions = actions_of(a, block, rule->actions);
    if (!rule->piling_up.empty()) {
      event.piling_up = a.network.events.size();
      a.network.events.push_back({event.block, a.network.graph.constant(0), false, false, false,
                                  actions_of(a, block, rule->piling_up)});
    }
    a.network.events.push_back(std::move(event));
  }
}

}  // namespace oblique::network
