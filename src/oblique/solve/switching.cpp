// SPDX-License-Identifier: MIT
// The part of Switching that settles an instant: event_search.cpp finds it, sliding.cpp follows surfaces.
#include <oblique/solve/switching.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// Rounding of a surface in machine units: a switch turns over beyond it, and within it lies on its surface.
constexpr double kRounding = 1e-13;

/// A switch that turns over this often, each time within this part of the run, chatters.
constexpr long kMostTurns = 1000;
constexpr double kShortTime = 1e-7;

/// An event that comes again sooner and sooner, this often in a row and within this part of the run, piles
/// up.
constexpr int kMostShorter = 10;
constexpr double kPilingUp = 1e-5;

constexpr int kMostRounds = 1000;  ///< of events that set each other off at one instant
constexpr std::size_t kMostRecords = 1000;
constexpr std::size_t kMostTogether = 12;  ///< switches of which every combination is tried

}  // namespace

Switching::Switching(const Program& program, Workspace& workspace, double span, const std::string& file)
    : program_(program),
      workspace_(workspace),
      span_(span),
      file_(file),
      surfaces_(program.switches().size()),
      signals_(program.n_signals()),
      states_(program.n_states()),
      moved_(program.n_states()),
      slopes_(program.n_states()),
      slopes_there_(program.n_states()),
      announced_(program.switches().size(), -1),
      held_(program.events().size(), false),
      on_surface_(program.switches().size(), false),
      switch_windows_(program.switches().size()),
      paces_(program.events().size()) {}

bool Switching::is_known(std::size_t s) const {
  return program_.switches()[s].rate.has_value();
}

/// A surface of time alone is known to rounding of the time.
double Switching::tiny(std::size_t s, double t) const {
  if (!is_known(s)) return kRounding;
  const double rate = program_.known_rate(s, workspace_).value_or(1);
  return 8 * kEpsilon * std::abs(t) * std::abs(rate);
}

void Switching::evaluate(double t, std::span<const double> x) {
  if (!program_.surfaces(t, x.data(), surfaces_.data(), workspace_))
    throw loop_error(program_, workspace_.trouble(), t, file_);
}

void Switching::record(double t, std::string what) {
  ++count_;
  if (records_.size() < kMostRecords) records_.push_back({t, std::move(what)});
}

void Switching::throw_chatter(const std::string& block, const std::string& what, double t) const {
  throw SolveError(SolveError::Kind::chatter, t,
                   {{file_, {}},
                    fmt::format("'{}' switches without end at t = {:.9g} s ({})", block, t, what),
                    {},
                    "give the switch a hysteresis, or end what it repeats before it becomes endlessly fast"});
}

void Switching::turn(std::size_t s, double position, double t) {
  const Switch& made = program_.switches()[s];
  if (workspace_.memory(made.memory) == position) return;
  workspace_.set_memory(made.memory, position);
  Window& window = switch_windows_[s];
  if (t - window.begin > kShortTime * span_) window.turns = 0;
  window.begin = t;
  if (++window.turns > kMostTurns) throw_chatter(made.block, made.comparison, t);
}

/// Puts every switch into the position that its surface asks for; true where one turned over.
bool Switching::decide(double t, std::span<const double> x) {
  bool turned = false;
  std::vector<std::size_t> undecided;
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    if (sliding_ == s) continue;
    const double before = workspace_.memory(program_.switches()[s].memory);
    double position = before;
    if (announced_[s] >= 0) {
      position = announced_[s];
    } else if (std::abs(surfaces_[s]) > tiny(s, t)) {
      position = surfaces_[s] > 0 ? 1 : 0;
    } else if (!on_surface_[s]) {
      undecided.push_back(s);
    }
    turn(s, position, t);
    turned = turned || position != before;
  }
  if (turned) return true;
  return std::any_of(undecided.begin(), undecided.end(), [&](std::size_t s) {
    on_surface_[s] = true;
    return decide_on_surface(s, t, x);
  });
}

/// All switches and the algebra between them to a fixed point; true where any turned over.
bool Switching::settle_switches(double t, std::span<const double> x) {
  const std::size_t most = 2 * surfaces_.size() + 10;
  std::vector<double> before;
  std::vector<std::size_t> restless;
  evaluate(t, x);
  std::size_t round = 0;
  for (; decide(t, x); ++round) {
    if (round > most) {  // these go on turning over: their surfaces depend on their own positions
      for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        if (before[s] != workspace_.memory(program_.switches()[s].memory)) restless.push_back(s);
      }
      if (round > 2 * most) {
        try_all_positions(t, x, restless);
        return true;
      }
    }
    before.resize(surfaces_.size());
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      before[s] = workspace_.memory(program_.switches()[s].memory);
    evaluate(t, x);
  }
  return round > 0;
}

/// An algebraic loop with switches in it is solved in each position of its switches; the one that agrees with
/// itself holds.
void Switching::try_all_positions(double t, std::span<const double> x,
                                  const std::vector<std::size_t>& found) {
  std::vector<std::size_t> restless = found;
  std::sort(restless.begin(), restless.end());
  restless.erase(std::unique(restless.begin(), restless.end()), restless.end());
  if (restless.size() <= kMostTogether) {
    for (std::uint32_t positions = 0; positions < (1U << restless.size()); ++positions) {
      for (std::size_t k = 0; k < restless.size(); ++k) {
        workspace_.set_memory(program_.switches()[restless[k]].memory, (positions >> k) & 1U);
      }
      if (!program_.surfaces(t, x.data(), surfaces_.data(), workspace_)) continue;
      bool agrees = true;
      for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        if (sliding_ == s) continue;
        const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
        agrees = agrees && (closed ? surfaces_[s] >= -kRounding : surfaces_[s] <= kRounding);
      }
      if (agrees) return;
    }
  }
  const Switch& first = program_.switches()[restless.front()];
  throw_chatter(first.block, "no position of its switch agrees with the signals that follow from it", t);
}

void Switching::keep_pace(std::size_t event, double t) {
  Pace& pace = paces_[event];
  const double interval = t - pace.last;
  pace.shorter = interval > 0 && interval < pace.interval ? pace.shorter + 1 : 0;
  if (pace.shorter >= kMostShorter && interval < kPilingUp * span_) {
    const double ratio = interval / pace.interval;
    throw SolveError(
        SolveError::Kind::chatter, t,
        {{file_, {}},
         fmt::format("the events of '{}' come ever faster: at t = {:.9g} s again after {:.3g} s, and they "
                     "pile up at t = {:.9g} s",
                     program_.events()[event].block, t, interval, t + interval * ratio / (1 - ratio)),
         {},
         "end the run before, or let the block come to rest below some height"});
  }
  pace.last = t;
  pace.interval = interval;
}

/// Serves all events whose conditions have become true; true where there were any.
bool Switching::serve_events(double t, std::vector<double>& x, bool starting) {
  std::vector<std::size_t> served;
  for (std::size_t e = 0; e < held_.size(); ++e) {
    const Event& event = program_.events()[e];
    const bool holds = program_.condition(e, workspace_);
    const bool comes = holds && (!held_[e] || event.repeats) && (!starting || event.at_start);
    held_[e] = holds;
    if (comes) served.push_back(e);
  }
  if (served.empty()) return false;
  if (!program_.signals(t, x.data(), signals_.data(), workspace_))
    throw loop_error(program_, workspace_.trouble(), t, file_);
  struct Change {
    const Event::Action* action;
    double value;
  };
  std::vector<Change> changes;
  for (const std::size_t e : served) {
    const Event& event = program_.events()[e];
    for (std::size_t a = 0; a < event.actions.size(); ++a) {
      const double value = program_.action_value(e, a, workspace_);
      if (!std::isfinite(value)) {
        throw SolveError(
            SolveError::Kind::blow_up, t,
            {{file_, {}},
             fmt::format("an event of '{}' would set a value that is no finite number at t = {:.6g} s",
                         event.block, t),
             {},
             {}});
      }
      changes.push_back({&event.actions[a], value});
    }
    record(t, event.block);
    keep_pace(e, t);
  }
  bool jumps = false;
  for (const Change& change : changes) {
    if (change.action->on_state) {
      jumps = jumps || x[change.action->index] != change.value;
      x[change.action->index] = change.value;
    } else {
      workspace_.set_memory(change.action->index, change.value);
    }
  }
  if (jumps && sliding_) leave_sliding(t, x);
  // What was announced of surfaces that have moved away is past.
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (jumps || std::abs(surfaces_[s]) > tiny(s, t)) announced_[s] = -1;
  }
  std::fill(on_surface_.begin(), on_surface_.end(), false);
  return true;
}

void Switching::settle(double t, std::vector<double>& x) {
  std::fill(on_surface_.begin(), on_surface_.end(), false);
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {  // the stretch may have ended before their time
    if (is_known(s) && std::abs(surfaces_[s]) > 4 * tiny(s, t)) announced_[s] = -1;
  }
  std::vector<std::pair<std::size_t, double>> turned;
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (announced_[s] >= 0) turned.emplace_back(s, announced_[s]);
  }
  for (const auto& [s, position] : turned) {
    if (sliding_ == s) sliding_.reset();
    record(t, fmt::format("{}: {} {}", program_.switches()[s].block, program_.switches()[s].comparison,
                          position > 0 ? "from now on" : "no longer"));
  }
  for (int round = 0;; ++round) {
    settle_switches(t, x);
    if (!serve_events(t, x, false)) break;
    if (round > kMostRounds)
      throw_chatter(records_.empty() ? "" : records_.back().what, "events set each other off", t);
  }
  // A switch that has just turned over and is pushed back slides.
  for (const auto& [s, position] : turned) {
    const bool stands = workspace_.memory(program_.switches()[s].memory) == position;
    if (!stands || announced_[s] < 0 || is_known(s)) continue;
    if (drift(s, 1, t, x) < 0 && drift(s, 0, t, x) > 0) decide_on_surface(s, t, x);
  }
  std::fill(announced_.begin(), announced_.end(), -1.0);
}

void Switching::start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest) {
  constexpr int kMostStarts = 100;
  const auto take_starts = [&] {
    for (int round = 0;; ++round) {
      if (!program_.signals(t, x.data(), signals_.data(), workspace_))
        throw loop_error(program_, workspace_.trouble(), t, file_);
      double change = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        const auto value = program_.start_value(i, workspace_);
        if (!value) continue;
        change = std::max(change, std::abs(*value - x[i]) / (1 + std::abs(*value)));
        x[i] = *value;
      }
      if (!(change > 4 * kEpsilon)) return;
      if (round > kMostStarts) {
        throw SolveError(SolveError::Kind::no_rest, t,
                         {{file_, {}},
                          "the initial values that follow from signals depend on each other in a circle",
                          "an initial value that does not come back to itself",
                          "give one of the integrators a fixed 'initial'"});
      }
    }
  };
  bool any_start = false;
  for (const State& state : program_.states()) any_start = any_start || state.start_node.has_value();
  bool starting = true;
  for (int round = 0;; ++round) {
    if (round > kMostRounds)
      throw_chatter(records_.empty() ? "" : records_.back().what, "the start does not settle", t);
    std::fill(on_surface_.begin(), on_surface_.end(), false);
    if (starting && any_start) take_starts();
    if (active() && settle_switches(t, x) && starting && any_start) continue;
    bring_to_rest();
    if (!active()) return;
    std::fill(on_surface_.begin(), on_surface_.end(), false);
    if (settle_switches(t, x)) continue;
    if (!serve_events(t, x, starting)) return;
    starting = false;
  }
}

}  // namespace oblique
