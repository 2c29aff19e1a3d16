// SPDX-License-Identifier: MIT
#include <oblique/solve/events/self_consistent.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/combinations.h>
#include <oblique/solve/events/position_limits.h>

namespace oblique::solve {
namespace {

/// Whether every switch but those `left` stands where its event function asks for it, or goes to.
bool agrees(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
            const Thresholds& thresholds, double span, const std::vector<std::uint32_t>& left, double t,
            std::span<const double> x) {
  std::vector<double> event_functions(program.switches().size()), rates(event_functions.size()),
      derivatives(x.size());
  const auto here = program.event_functions(t, x.data(), event_functions.data(), workspace);
  if (!here) return false;
  here->derivatives(derivatives.data());
  here->event_function_rates(derivatives.data(), rates.data());
  const double fastest = fastest_of(derivatives, 0);
  for (std::size_t s = 0; s < event_functions.size(); ++s) {
    if (program.switches()[s].rate || slide.holds(s) || slide.follows(s)) continue;
    if (std::find(left.begin(), left.end(), s) != left.end()) continue;
    const bool closed = workspace.discrete_state(program.switches()[s].discrete_state) == 1;
    const auto goes_there = [&](double towards) { return closed ? towards > 0 : towards < 0; };
    if (std::abs(event_functions[s]) <= thresholds[s]) {
      const bool moves = leaves_rounding(rates[s], span) && std::abs(rates[s]) > kNoRate * fastest;
      if (moves && !goes_there(rates[s])) return false;
    } else if (!goes_there(event_functions[s])) {
      return false;
    }
  }
  return true;
}

/// Moves the tables along whose ends have been passed, whatever loops have no solution yet; whether any was.
bool move_tables(const network::Program& program, network::Workspace& workspace, double t,
                 std::span<const double> x) {
  std::vector<double> signals(program.n_signals());
  std::vector<std::pair<std::uint32_t, double>> moved;
  workspace.pass_failing_loops(true);
  if (const auto here = program.signals(t, x.data(), signals.data(), workspace)) {
    for (std::size_t e = 0; e < program.events().size(); ++e) {
      const network::Event& event = program.events()[e];
      if (event.repeats && here->condition(e))
        moved.emplace_back(event.actions.front().index, here->action_value(e, 0));
    }
  }
  workspace.pass_failing_loops(false);
  for (const auto& [segment, to] : moved) workspace.set_discrete_state(segment, to);
  return !moved.empty();
}

}  // namespace

std::optional<network::Evaluation> place_others(const network::Program& program,
                                                network::Workspace& workspace, const Thresholds& thresholds,
                                                const std::vector<bool>& placed, double t,
                                                std::span<const double> x,
                                                std::vector<double>& event_functions) {
  constexpr std::size_t kInOrder = 2;  // rounds before what is left goes in one
  bool turned = false;
  std::vector<bool> unknown(event_functions.size(), false);
  const auto settle = [&](std::size_t s, double event_function) {
    if (placed[s] || unknown[s] || program.switches()[s].rate || std::abs(event_function) <= thresholds[s])
      return;
    const std::uint32_t discrete_state = program.switches()[s].discrete_state;
    const double position = event_function > 0 ? 1 : 0;
    turned = turned || workspace.discrete_state(discrete_state) != position;
    workspace.set_discrete_state(discrete_state, position);
  };
  for (std::size_t round = 0; round <= 2 * event_functions.size() + 1; ++round) {
    auto here = program.event_functions(t, x.data(), event_functions.data(), workspace);
    const bool known = here.has_value();
    if (!known) {
      // A loop may have no solution until the switches before it stand where they belong: the root of a
      // magnitude whose argument has just changed its sign.
      unknown = program.switch_structure().followers_of_loop(workspace.trouble().loop);
      workspace.pass_failing_loops(true);
      program.event_functions(t, x.data(), event_functions.data(), workspace);
      workspace.pass_failing_loops(false);
    } else {
      unknown.assign(unknown.size(), false);
    }
    turned = false;
    for (std::size_t s = 0; s < event_functions.size(); ++s) settle(s, event_functions[s]);
    if (!turned && (known || !move_tables(program, workspace, t, x))) return here;
    if (known && round == kInOrder) {
      const std::vector<double> still(x.size(), 0.0);
      program.decide_in_order(
          t, x.data(), still.data(), workspace,
          [&](std::uint32_t s, double event_function, double /*rate*/) { settle(s, event_function); });
    }
  }
  return std::nullopt;
}

Agreement choose_any(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                     const Thresholds& thresholds, double span, std::vector<std::uint32_t> restless,
                     const std::vector<std::uint32_t>& left, double t, std::span<const double> x) {
  constexpr std::size_t kMostTogether = 12;  // switches of which all combinations are tried
  const network::SwitchStructure& structure = program.switch_structure();
  for (std::size_t k = 0; k < restless.size(); ++k) {
    for (const std::uint32_t other : structure.positions_below(restless[k])) {
      const bool mutual = structure.depends(other, restless[k]);
      if (mutual && std::find(restless.begin(), restless.end(), other) == restless.end())
        restless.push_back(other);
    }
  }
  std::sort(restless.begin(), restless.end());
  restless.erase(std::unique(restless.begin(), restless.end()), restless.end());
  if (restless.size() > kMostTogether) return {};
  const std::vector<double> before(workspace.discrete_states().begin(), workspace.discrete_states().end());
  Combination present = 0;
  std::vector<bool> placed = slide.taken();
  for (std::size_t k = 0; k < restless.size(); ++k) {
    placed[restless[k]] = true;
    if (workspace.discrete_state(program.switches()[restless[k]].discrete_state) == 1) present |= 1U << k;
  }
  for (const std::uint32_t s : left) placed[s] = true;
  std::vector<double> event_functions(program.switches().size()), chosen;
  Combination first = 0;
  for (const Combination sides : nearest_first(present, restless.size())) {
    if (!chosen.empty() && std::popcount(sides ^ present) > std::popcount(first ^ present)) break;
    workspace.load_discrete_states(before);
    for (std::size_t k = 0; k < restless.size(); ++k)
      workspace.set_discrete_state(program.switches()[restless[k]].discrete_state, has(sides, k) ? 1 : 0);
    if (!place_others(program, workspace, thresholds, placed, t, x, event_functions) ||
        !agrees(program, workspace, slide, thresholds, span, left, t, x))
      continue;
    if (!chosen.empty()) {
      workspace.load_discrete_states(chosen);
      Agreement several{true, {}};
      for (std::size_t k = 0; k < restless.size(); ++k) {
        if (has(sides, k) != has(first, k)) several.open.push_back(restless[k]);
      }
      return several;
    }
    first = sides;
    chosen.assign(workspace.discrete_states().begin(), workspace.discrete_states().end());
  }
  workspace.load_discrete_states(chosen.empty() ? before : chosen);
  return {!chosen.empty(), {}};
}

std::optional<std::uint32_t> find_open(const network::Program& program, const network::Workspace& workspace,
                                       const SlidingMode& slide, const Thresholds& thresholds, double span,
                                       double t, std::span<const double> x) {
  std::vector<double> event_functions(program.switches().size());
  std::vector<bool> in_loop(event_functions.size(), false);
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    const std::vector<bool> follows = program.switch_structure().followers_of_loop(loop);
    for (std::size_t s = 0; s < follows.size(); ++s) in_loop[s] = in_loop[s] || follows[s];
  }
  for (std::uint32_t s = 0; s < event_functions.size(); ++s) {
    const network::Switch& made = program.switches()[s];
    if (made.turning != network::Turning::jumps || made.rate || in_loop[s] || slide.holds(s) ||
        slide.follows(s))
      continue;
    std::vector<bool> itself(event_functions.size(), false);
    itself[s] = true;
    const bool feeds_itself = program.switch_structure().followers_of(itself)[s];  // by others, too
    if (!feeds_itself) continue;
    std::vector<bool> placed = slide.taken();
    placed[s] = true;
    network::Workspace trial = workspace;
    trial.set_discrete_state(made.discrete_state, 1 - workspace.discrete_state(made.discrete_state));
    if (!place_others(program, trial, thresholds, placed, t, x, event_functions)) continue;
    const bool is_at_level =
        std::abs(event_functions[s]) <= thresholds.rounding(s);  // where it does not hold
    if (!is_at_level && agrees(program, trial, slide, thresholds, span, {}, t, x)) return s;
  }
  return std::nullopt;
}

}  // namespace oblique::solve
