// SPDX-License-Identifier: MIT
#include <oblique/console/carried_state.h>

#include <algorithm>
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
solve::RunState::Named taken(const Items& items, const Values& values, const Renamed& renamed,
                             const Otherwise& otherwise) {
  solve::RunState::Named named;
  named.reserve(items.size());
  for (std::size_t i = 0; i < items.size(); ++i) {
    const auto found =
        renamed.empty() ? values.find(items[i].name) : values.find(path_before(items[i].name, renamed));
    named.emplace_back(items[i].name, found != values.end() ? found->second : otherwise(i));
  }
  return named;
}

/// Whether the condition of each event of `to` held: that of the event of `from` that is as many of its
/// block. One that there was not has not held.
std::vector<bool> conditions_by_block(const solve::RunState& state, const network::Program& from,
                                      const network::Program& to, const Renamed& renamed) {
  std::unordered_map<std::string_view, std::vector<bool>> of_block;
  for (std::size_t e = 0; e < from.events().size(); ++e)
    of_block[from.events()[e].block].push_back(state.conditions[e]);
  std::unordered_map<std::string_view, std::size_t> taken;
  std::vector<bool> held;
  for (const network::Event& event : to.events()) {
    const auto before = of_block.find(path_before(event.block, renamed));
    const std::size_t number = taken[event.block]++;
    held.push_back(before != of_block.end() && number < before->second.size() && before->second[number]);
  }
  return held;
}

}  // namespace

std::string path_before(std::string_view path, const Renamed& renamed) {
  const std::string_view block = path.substr(0, path.find('.'));
  for (const auto& [before, now] : renamed) {
    if (now == block) return before + std::string(path.substr(block.size()));
  }
  const bool is_another =
      std::any_of(renamed.begin(), renamed.end(), [&](const auto& names) { return names.first == block; });
  return is_another ? std::string() : std::string(path);
}

solve::RunState carried_state(const solve::RunState& state, const network::Program& from,
                              std::span<const double> signals, const network::Program& to,
                              const Renamed& renamed) {
  Values continuous, discrete;
  add(state.states, continuous);
  add(state.unknowns, continuous);
  for (std::size_t s = 0; s < signals.size(); ++s) continuous.emplace(from.signal_names()[s], signals[s]);
  add(state.memories, discrete);

  const network::Workspace fresh(to);
  const std::vector<double> start = to.start();
  solve::RunState carried = state;
  carried.states = taken(to.states(), continuous, renamed, [&](std::size_t i) { return start[i]; });
  carried.unknowns =
      taken(to.unknowns(), continuous, renamed, [&](std::size_t i) { return fresh.unknown(i); });
  carried.memories = taken(to.discrete_states(), discrete, renamed,
                           [&](std::size_t i) { return fresh.discrete_states()[i]; });
  carried.sliding.clear();
  carried.turned = true;
  carried.conditions = conditions_by_block(state, from, to, renamed);
  return carried;
}

}  // namespace oblique::console
