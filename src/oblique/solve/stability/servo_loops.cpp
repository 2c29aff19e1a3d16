// SPDX-License-Identifier: MIT
#include <oblique/solve/stability/servo_loops.h>

#include <algorithm>
#include <cmath>

#include <oblique/network/program/program.h>
#include <oblique/solve/operating_point/rest.h>

namespace oblique::solve {
namespace {

/// Finds which lone amplifiers act on themselves, and which are open by themselves.
class LoneAmplifiers {
 public:
  LoneAmplifiers(const network::Program& program, const SignalFlow& flow)
      : program_(program),
        flow_(flow),
        closed_(program.n_states(), false),
        open_(program.n_states(), false) {}

  void look_at(const std::vector<Instant>& instants, const std::vector<std::size_t>& lone,
               const std::vector<std::size_t>& in_groups) {
    network::Workspace workspace(program_);
    std::vector<double> signals(program_.n_signals());
    std::optional<IdealMachine> ideal;
    // Whether an amplifier is open is its make; a gain may be zero at an instant.
    const std::size_t stride = std::max<std::size_t>(1, instants.size() / 4);
    for (std::size_t k = 0; k < instants.size(); ++k) {
      const Instant& instant = instants[k];
      workspace.load_discrete_states(instant.discrete_states);
      if (!program_.signals(instant.t, instant.states.data(), signals.data(), workspace)) continue;
      const auto linear = Linearisation::at(program_, workspace, instant);
      if (!linear) continue;
      const std::vector<double> largest = linear->largest_in_rows();
      bool all_known = true;
      for (const std::size_t i : lone) {
        if (!closed_[i]) closed_[i] = acts_on_itself(*linear, i, largest[i], instant.t, signals);
        all_known = all_known && closed_[i];
      }
      if (all_known) return;
      if (in_groups.empty() || k % stride != 0) continue;
      if (!ideal) ideal.emplace(flow_.diagram(), program_);
      if (!ideal->look_at(instant, workspace)) continue;
      for (const std::size_t i : ideal->open_amplifiers(in_groups)) open_[i] = true;
    }
  }

  bool closed(std::size_t state) const { return closed_[state]; }
  bool open(std::size_t state) const { return open_[state]; }

 private:
  /// Its gain with all others held is zero to the rounding of the differences of its own derivative.
  bool acts_on_itself(const Linearisation& linear, std::size_t state, double largest, double t,
                      std::span<const double> signals) const {
    const auto own = flow_.own_derivative(program_.states()[state].name, t, signals);
    if (!own) return false;
    constexpr double kRounding = 1e-9;
    const double fed_back = linear.block({state})(0, 0) - *own;
    return std::abs(fed_back) > kRounding * (std::abs(*own) + largest);
  }

  const network::Program& program_;
  const SignalFlow& flow_;
  std::vector<bool> closed_, open_;
};

}  // namespace

std::vector<ServoLoop> servo_loops(const network::Program& program, const SignalFlow& flow,
                                   const std::vector<Instant>& instants) {
  const auto groups = servo_groups(program);
  std::vector<std::vector<std::size_t>> around(program.n_states());
  std::vector<std::size_t> lone, in_groups;
  for (const auto& group : coupled_groups(program)) {
    for (const std::size_t i : group) around[i] = group;
  }
  for (const auto& group : groups) {
    if (group.size() > 1) continue;
    lone.push_back(group.front());
    if (around[group.front()].size() > 1) in_groups.push_back(group.front());
  }
  LoneAmplifiers amplifiers(program, flow);
  if (!lone.empty()) amplifiers.look_at(instants, lone, in_groups);

  std::vector<ServoLoop> loops;
  for (const auto& group : groups) {
    if (group.size() > 1 || amplifiers.closed(group.front())) loops.push_back({group, group});
  }
  const std::size_t n_fast = loops.size();
  for (const std::size_t i : in_groups) {
    if (amplifiers.closed(i) || !amplifiers.open(i)) continue;
    const auto same = std::find_if(loops.begin() + static_cast<std::ptrdiff_t>(n_fast), loops.end(),
                                   [&](const ServoLoop& loop) { return loop.states == around[i]; });
    if (same != loops.end()) {
      same->servos.push_back(i);
    } else {
      loops.push_back({{i}, around[i]});
    }
  }
  for (ServoLoop& loop : loops) {
    std::sort(loop.servos.begin(), loop.servos.end());
    std::sort(loop.states.begin(), loop.states.end());
  }
  return loops;
}

}  // namespace oblique::solve
