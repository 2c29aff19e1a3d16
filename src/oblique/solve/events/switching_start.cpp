// SPDX-License-Identifier: MIT
// The part of Switching that starts a run.
#include <oblique/solve/events/switching.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

}  // namespace

/// Starts the states that start from signals. Those that start from each other in a circle begin where they
/// agree, which is not what integrators do that take their values by turns.
void Switching::take_starts(double t, std::vector<double>& x) {
  constexpr long kMostRoundsInCircle = 100;
  const long starts = std::count_if(program_.states().begin(), program_.states().end(),
                                    [](const network::State& state) { return state.start_node.has_value(); });
  std::vector<std::size_t> circle;
  bool changes = true, finite = true;
  for (long round = 0; changes && finite && round <= starts + kMostRoundsInCircle; ++round) {
    if (!program_.signals(t, x.data(), signals_.data(), workspace_))
      throw loop_error(program_, workspace_.trouble(), t, file_);
    changes = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto value = program_.start_value(i, workspace_);
      if (!value) continue;
      const bool same = std::abs(*value - x[i]) <= 4 * kEpsilon * (1 + std::abs(*value));
      if (same && std::isfinite(*value)) continue;
      changes = true;
      finite = finite && std::isfinite(*value);
      // A chain of starts is through after as many rounds as it is long.
      if (round > starts && std::find(circle.begin(), circle.end(), i) == circle.end()) circle.push_back(i);
      if (!finite && circle.empty()) {
        throw SolveError(SolveError::Kind::blow_up, t,
                         {{file_, {}},
                          fmt::format("'{}' would start at {}, which the signals at its start give",
                                      program_.states()[i].name, *value),
                          "a finite initial value",
                          "look for a division by zero or a logarithm of zero before it"});
      }
      x[i] = *value;
    }
  }
  if (circle.empty()) return;
  std::sort(circle.begin(), circle.end());
  std::vector<std::string> quoted;
  quoted.reserve(circle.size());
  for (const std::size_t i : circle) quoted.push_back(fmt::format("'{}'", program_.states()[i].name));
  const std::string told = fmt::format("the initial values of {} follow from each other in a circle",
                                       shortened(std::move(quoted)));
  constexpr const char* kCut =
      "give one of them a fixed 'initial', or cut the circle at the start with an electronic-switch";
  if (changes)
    throw SolveError(SolveError::Kind::no_rest, t, {{file_, {}}, told, "initial values that agree", kCut});
  const network::State& first = program_.states()[circle.front()];
  const std::string agreed =
      fmt::format("{}: the run begins where they agree, at {} = {:.6g}", told, first.name, x[circle.front()]);
  const bool is_told = std::any_of(warnings_.begin(), warnings_.end(),
                                   [&](const text::Diagnostic& warning) { return warning.what == agreed; });
  if (!is_told) warnings_.push_back({{file_, {}}, agreed, {}, kCut});
}

/// Brings servo loops to rest with all limits let loose, and tells whether they rest there, within them. An
/// amplifier's guess may be far off only because the elements in its loop have not settled yet; at a limit it
/// has no gain, and may stay there for good.
bool Switching::rests_within_limits(double t, std::vector<double>& x,
                                    const std::function<void()>& bring_to_rest) {
  const std::vector<double> states = x;
  const std::vector<double> memories(workspace_.memories().begin(), workspace_.memories().end());
  bool any = false;
  for (const network::Switch& made : program_.switches()) {
    if (made.turning != network::Turning::limits || workspace_.memory(made.memory) == 0) continue;
    workspace_.set_memory(made.memory, 0);
    any = true;
  }
  if (!any) return false;
  try {
    bring_to_rest();
    evaluate(t, x);
    bool within = true;
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      within = within && (program_.switches()[s].turning != network::Turning::limits ||
                          surfaces_[s] <= thresholds_.now[s]);
    if (within) return true;
  } catch (const SolveError&) {  // what lies between the limits has no rest; they may make one
  }
  x = states;
  for (std::size_t m = 0; m < memories.size(); ++m) workspace_.set_memory(m, memories[m]);
  return false;
}

void Switching::start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest) {
  bool any_start = false;
  for (const network::State& state : program_.states()) any_start = any_start || state.start_node.has_value();
  bool starting = true, first = true;
  for (int round = 0;; ++round) {
    if (round > kMostRounds)
      throw_chatter(records_.empty() ? "" : records_.back().what, "the start does not settle", t);
    begin_to_settle();
    if (starting && any_start) take_starts(t, x);
    if (active() && settle_switches(t, x) && starting && any_start) continue;
    if (!first || !rests_within_limits(t, x, bring_to_rest)) bring_to_rest();
    first = false;
    if (!active()) return;
    begin_to_settle();
    if (settle_switches(t, x)) continue;
    if (!serve_events(t, x, starting)) break;
    starting = false;
  }
  note_slides({}, {}, t);
  slid_.clear();
}

}  // namespace oblique::solve
