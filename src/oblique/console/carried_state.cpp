// SPDX-License-Identifier: MIT
#include <oblique/console/carried_state.h>

#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace oblique::console {
namespace {

using Values = std::unordered_map<std::string_view, double>;

void add(const solve::RunState::Named& named, Values& values) {
  for (const auto& [name, value] : named) values.emplace(name, value);
}

/// Of each item the value of its name, or else that of `otherwise`.
template <class Items, class Otherwise>
solve::RunState::Named taken(const Items& items, const Values& values, const Otherwise& otherwise) {
  solve::RunState::Named named;
  named.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto found = values.find(items[i].name);
    named.emplace_back(items[i].name, found != values.end() ? found->second : otherwise(i));
  }
  return named;
}

/// Whether the condition of each event of `to` held: that of the event of `from` that is as many of its
/// block. One that there was not has not held.
std::vector<bool> conditions_by_block(const solve::RunState& state, const network::Program& from,
                                      const network::Program& to) {
  std::unordered_map<std::string_view, std::vector<bool>> of_block;
  for (std::size_t e = 0; e < from.events().size(); ++e)
    of_block[from.events()[e].block].push_back(state.conditions[e]);
  std::unordered_map<std::string_view, std::size_t> taken;
  std::vector<bool> held;
  for (const network::Event& event : to.events()) {
    const std::vector<bool>& before = of_block[event.block];
    const std::size_t number = taken[event.block]++;
    held.push_back(number < before.size() && before[number]);
  }
  return held;
}

}  // namespace

solve::RunState carried_state(const solve::RunState& state, const network::Program& from,
                              std::span<const double> signals, const network::Program& to) {
  Values continuous, discrete;
  add(state.states, continuous);
  add(state.unknowns, continuous);
  for (std::size_t s = 0; s < signals.size(); ++s) continuous.emplace(from.signal_names()[s], signals[s]);
  add(state.memories, discrete);

  const network::Workspace fresh(to);
  const std::vector<double> start = to.start();
  solve::RunState carried = state;
  carried.states = taken(to.states(), continuous, [&](std::size_t i) { return start[i]; });
  carried.unknowns = taken(to.unknowns(), continuous, [&](std::size_t i) { return fresh.unknown(i); });
  carried.memories =
      taken(to.discrete_states(), discrete, [&](std::size_t i) { return fresh.discrete_states()[i]; });
  carried.sliding.clear();
  carried.conditions = conditions_by_block(state, from, to);
  return carried;
}

}  // namespace oblique::console
