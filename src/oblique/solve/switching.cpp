// SPDX-License-Identifier: MIT
#include <oblique/solve/switching.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A switch that turns over without having left its surface by more than this, or than the errors of the
/// states, is restless after a few turns: its surface then counts as zero within those errors. After many it
/// chatters.
constexpr double kSamePlace = 10;  // roundings
constexpr long kRestless = 5;
constexpr long kMostTurns = 1000;

/// Events that come sooner and sooner, this often in a row, pile up where the times left to them, at the
/// present ratio, are together below this part of the run, and the ratio is not on its way to 1 (events that
/// crowd together and thin out again: two balls between a heavy one and a wall). That is seen over intervals
/// that become shorter by such a factor: 1 less the ratio is then no smaller than this part of what it was.
constexpr int kMostShorter = 10;
constexpr double kPilingUp = 1e-5;
constexpr double kSteadyOver = 4;
constexpr double kSteady = 0.75;

constexpr int kMostRounds = 1000;  ///< of events that set each other off at one instant
constexpr std::size_t kMostRecords = 1000;

bool contains(const std::vector<std::uint32_t>& units, std::uint32_t unit) {
  return std::find(units.begin(), units.end(), unit) != units.end();
}

/// Nearer than this no two times are told apart.
double resolution(double t) {
  return 4 * kEpsilon * std::abs(t);
}

}  // namespace

Switching::Switching(const Program& program, Workspace& workspace, double span, double tolerance,
                     double absolute_tolerance, const std::string& file)
    : program_(program),
      workspace_(workspace),
      span_(span),
      tolerance_(tolerance),
      absolute_tolerance_(absolute_tolerance),
      file_(file),
      slide_(program, workspace, span),
      thresholds_{std::vector<double>(program.switches().size(), 0.0),
                  std::vector<double>(program.switches().size(), 0.0)},
      search_(program, workspace, slide_, thresholds_, span, file),
      positions_(program, workspace, slide_, thresholds_.now, span),
      surfaces_(program.switches().size()),
      signals_(program.n_signals()),
      announced_(program.switches().size(), -1),
      errors_(program.switches().size(), 0),
      held_(program.events().size(), false),
      decided_(program.switch_structure().members.size(), false),
      rested_(program.switches().size(), false),
      unrest_(program.switches().size()),
      paces_(program.events().size()) {}

/// The surfaces, and how far from zero each counts as zero: one of time alone is known to rounding of the
/// time.
void Switching::evaluate(double t, std::span<const double> x) {
  states_.assign(x.begin(), x.end());
  weighed_ = false;
  const bool known = program_.surfaces(t, x.data(), surfaces_.data(), workspace_);
  if (!known) {
    workspace_.pass_failing_loops(true);
    program_.surfaces(t, x.data(), surfaces_.data(), workspace_);
    workspace_.pass_failing_loops(false);
  }
  for (std::size_t s = 0; s < thresholds_.now.size(); ++s) {
    if (is_known(s)) {
      const double size = program_.compared_size(s, workspace_);
      thresholds_.now[s] = 8 * kEpsilon * (std::isfinite(size) ? size : std::abs(t));
    } else {
      thresholds_.now[s] = std::max(search_.rounding(s), thresholds_.slack[s]);
    }
  }
  // An algebraic loop may have a solution only where the switches that are due have turned over.
  if (!known && !is_any_due()) throw loop_error(program_, workspace_.trouble(), t, file_);
}

/// Whether a switch is on the wrong side of its surface, or has not turned over though it was announced.
bool Switching::is_any_due() const {
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const double position = workspace_.memory(program_.switches()[s].memory);
    if (announced_[s] >= 0 ? announced_[s] != position
                           : (position == 1 ? -surfaces_[s] : surfaces_[s]) > thresholds_.now[s])
      return true;
  }
  return false;
}

/// Within this of zero a surface is where it was.
double Switching::place_size(std::size_t s) const {
  return std::max(kSamePlace * search_.rounding(s), errors_[s]);
}

/// How far the surfaces are off zero by the errors that the solver leaves to the states: the most for some
/// combinations of their signs, where the surfaces were evaluated last.
void Switching::weigh_errors() {
  constexpr std::uint64_t kTrials = 4;
  constexpr double kErrorOfClock = 1e-13;  // it is a straight line to any method
  std::vector<bool> clocks(program_.n_states(), false);
  for (std::size_t c = 0; c < program_.clocks(); ++c) clocks[program_.source_states()[c]] = true;
  std::vector<double> off(program_.n_states(), 0.0), rates(surfaces_.size()), still(surfaces_.size());
  program_.surface_rates(off.data(), still.data(), workspace_);
  std::fill(errors_.begin(), errors_.end(), 0.0);
  for (std::uint64_t trial = 0; trial < kTrials; ++trial) {
    std::uint64_t signs = 0x9E3779B97F4A7C15 * (trial + 1);
    for (std::size_t i = 0; i < off.size(); ++i) {
      const double own = program_.states()[i].tolerance;
      double least = own > 0 ? own : absolute_tolerance_;
      if (!reach_.empty() && reach_[i] > 0) least = std::min(least, tolerance_ * reach_[i]);
      const double size = std::abs(states_[i]);
      const double error = clocks[i] ? kErrorOfClock * (1 + size) : tolerance_ * size + least;
      off[i] = trial == 0 || (signs >> 63) != 0 ? error : -error;
      signs = 6364136223846793005 * signs + 1442695040888963407;
    }
    program_.surface_rates(off.data(), rates.data(), workspace_);
    for (std::size_t s = 0; s < errors_.size(); ++s) {
      const double error = std::abs(rates[s] - still[s]);
      errors_[s] = std::max(errors_[s], std::isfinite(error) ? error : tolerance_);
    }
  }
  weighed_ = true;
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

void Switching::throw_endless(double t) const {
  throw_chatter(records_.empty() ? "" : records_.back().what, "a comparison of the time is always due", t);
}

void Switching::turn(std::size_t s, double position, double t) {
  const Switch& made = program_.switches()[s];
  if (workspace_.memory(made.memory) == position) return;
  workspace_.set_memory(made.memory, position);
  if (!weighed_) weigh_errors();
  Unrest& unrest = unrest_[s];
  const bool same_place = is_known(s) ? t <= unrest.last : search_.excursion(s) < place_size(s);
  if (!same_place) unrest.turns = 0;
  unrest.last = t;
  search_.forget(s);
  // A surface that is merely touched goes back and forth by the errors of the states.
  const SwitchStructure& structure = program_.switch_structure();
  const auto& unit = structure.members[structure.unit[s]];
  const bool found =
      std::any_of(unit.begin(), unit.end(), [&](std::uint32_t m) { return announced_[m] >= 0; });
  if (!is_known(s) && found) thresholds_.slack[s] = errors_[s];
  if (++unrest.turns > kMostTurns) throw_chatter(made.block, made.comparison, t);
}

/// Turns every switch over whose surface asks for it, and collects the units that lie on their surfaces and
/// have not been decided yet. True where any turned over.
bool Switching::turn_by_surfaces(double t, Units& on_surface, std::vector<std::uint32_t>& turned) {
  const SwitchStructure& structure = program_.switch_structure();
  on_surface.clear();
  turned.clear();
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    if (slide_.holds(s) || slide_.follows(s)) continue;
    const double before = workspace_.memory(program_.switches()[s].memory);
    const std::uint32_t unit = structure.unit[s];
    const bool drifted = slide_.rests(s) || (!decided_[unit] && (rested_[s] || contains(slid_, unit)));
    double near = drifted ? std::max(SlidingMode::drift(), thresholds_.now[s]) : thresholds_.now[s];
    if (unrest_[s].turns > kRestless) near = std::max(near, place_size(s));
    double position = before;
    if (is_known(s)) {
      const double rate = program_.known_rate(s, workspace_).value_or(0);
      if (announced_[s] >= 0) {
        position = announced_[s];
      } else if (std::abs(surfaces_[s]) > thresholds_.now[s] || rate != 0) {
        position = (std::abs(surfaces_[s]) > thresholds_.now[s] ? surfaces_[s] : rate) > 0 ? 1 : 0;
      }
    } else if (announced_[s] >= 0 || std::abs(surfaces_[s]) <= near) {
      if (!decided_[unit] && !contains(on_surface, unit)) on_surface.push_back(unit);
    } else {
      position = surfaces_[s] > 0 ? 1 : 0;
    }
    if (position == before) continue;
    turn(s, position, t);
    turned.push_back(s);
  }
  return !turned.empty();
}

/// Lets the solution decide where the units go that lie on their surfaces.
void Switching::decide(Units units, double t, std::span<const double> x) {
  const SwitchStructure& structure = program_.switch_structure();
  for (const std::uint32_t unit : slide_.units()) {
    if (!contains(units, unit)) units.push_back(unit);
  }
  slide_.end();
  std::uint32_t preferred = 0;
  std::vector<double> before;
  for (std::size_t u = 0; u < units.size(); ++u) {
    decided_[units[u]] = true;
    const std::uint32_t s = structure.members[units[u]].front();
    double position = workspace_.memory(program_.switches()[s].memory);
    for (const std::uint32_t member : structure.members[units[u]]) {
      if (announced_[member] >= 0)
        position =
            structure.opposite[member] == structure.opposite[s] ? announced_[member] : 1 - announced_[member];
    }
    if ((position == 1) != structure.opposite[s] && u < Positions::kMostUnits) preferred |= 1U << u;
  }
  for (const Switch& s : program_.switches()) before.push_back(workspace_.memory(s.memory));
  if (!positions_.choose(units, preferred, t, x)) {
    std::vector<std::uint32_t> members;
    for (const std::uint32_t unit : units)
      members.insert(members.end(), structure.members[unit].begin(), structure.members[unit].end());
    if (units.size() > Positions::kMostUnits || !positions_.choose_any(members, t, x)) {
      const Switch& first = program_.switches()[members.front()];
      throw_chatter(first.block, "no position of its switch agrees with the signals that follow from it", t);
    }
  }
  for (std::size_t s = 0; s < before.size(); ++s) {  // those that turned over count
    const double position = workspace_.memory(program_.switches()[s].memory);
    workspace_.set_memory(program_.switches()[s].memory, before[s]);
    turn(s, position, t);
  }
}

/// All switches and the algebra between them to a fixed point; true where any turned over.
bool Switching::settle_switches(double t, std::span<const double> x) {
  const std::size_t most = 2 * surfaces_.size() + 10;
  bool any = false;
  Units on_surface;
  std::vector<std::uint32_t> turned, restless;
  for (std::size_t round = 0;; ++round) {
    evaluate(t, x);
    if (turn_by_surfaces(t, on_surface, turned)) {
      any = true;
      if (round <= most) continue;
      // These go on turning over: their surfaces depend on their own positions.
      restless.insert(restless.end(), turned.begin(), turned.end());
      if (round <= 2 * most) continue;
      if (!positions_.choose_any(restless, t, x)) {
        const Switch& first = program_.switches()[*std::min_element(restless.begin(), restless.end())];
        throw_chatter(first.block, "no position of its switch agrees with the signals that follow from it",
                      t);
      }
      return true;
    }
    if (on_surface.empty()) return any;
    const std::vector<double> before(workspace_.memories().begin(), workspace_.memories().end());
    decide(on_surface, t, x);
    any = any || slide_.units() != slid_ ||
          !std::equal(before.begin(), before.end(), workspace_.memories().begin());
  }
}

/// Whether an event piles up, so that the one that takes its place is to come. Throws SolveError where none
/// does.
bool Switching::piles_up(std::size_t event, double t) {
  Pace& pace = paces_[event];
  const double interval = t - pace.last;
  pace.shorter = interval > 0 && interval < pace.interval ? pace.shorter + 1 : 0;
  const double ratio = pace.interval > 0 ? interval / pace.interval : 1;
  const double left = interval * ratio / (1 - ratio);  // Σ interval · ratioᵏ
  if (pace.shorter == 0) {
    pace.steady = false;
    pace.longer = kInfinity;
  } else if (pace.longer == kInfinity || kSteadyOver * interval < pace.longer) {
    pace.steady = pace.longer < kInfinity && 1 - ratio > kSteady * pace.approach;
    pace.longer = interval;
    pace.approach = 1 - ratio;
  }
  if (pace.steady && pace.shorter >= kMostShorter && interval < kPilingUp * span_ &&
      left < kPilingUp * span_ && t + left < end_) {
    if (program_.events()[event].piling_up) return true;
    throw SolveError(
        SolveError::Kind::chatter, t,
        {{file_, {}},
         fmt::format("the events of '{}' come ever faster: at t = {:.9g} s again after {:.3g} s, and they "
                     "pile up at t = {:.9g} s",
                     program_.events()[event].block, t, interval, t + left),
         {},
         "end the run before, or tell the block what happens there: 'piling_up' beside 'set' in its "
         "[[events]]"});
  }
  pace.last = t;
  pace.interval = interval;
  return false;
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
  for (std::size_t e : served) {
    if (piles_up(e, t)) {
      e = *program_.events()[e].piling_up;
      record(t, program_.events()[e].block + ": its events pile up");
    } else {
      record(t, program_.events()[e].block);
    }
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
  begin_to_settle();
  if (jumps) {
    slid_.clear();
    std::fill(rested_.begin(), rested_.end(), false);
    std::fill(thresholds_.slack.begin(), thresholds_.slack.end(), 0.0);
  }
  // What was announced of surfaces that have moved away is past.
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (jumps || std::abs(surfaces_[s]) > thresholds_.now[s]) announced_[s] = -1;
  }
  return true;
}

/// What lies on its surface is decided anew, and what slides is looked at as if it came there now.
void Switching::begin_to_settle() {
  std::fill(decided_.begin(), decided_.end(), false);
  slid_ = slide_.units();
  for (std::size_t s = 0; s < rested_.size(); ++s) rested_[s] = resumed_ || slide_.rests(s);
  resumed_ = false;
  slide_.end();
}

/// Tells that rounding decides where the solution goes. Once for each unit: it may come back.
void Switching::warn_of_repulsion(std::uint32_t unit, double t) {
  const Switch& s = program_.switches()[program_.switch_structure().members[unit].front()];
  const std::string what =
      fmt::format("'{}' ({}) leaves the surface that it slides along", s.block, s.comparison);
  const bool told = std::any_of(warnings_.begin(), warnings_.end(),
                                [&](const Diagnostic& warning) { return warning.what.starts_with(what); });
  if (told) return;
  warnings_.push_back({{file_, {}},
                       what + fmt::format(" at t = {:.9g} s, since both of its sides drive away from it from "
                                          "then on: rounding decides to which side it goes",
                                          t),
                       {},
                       "end the run before, or add the disturbance that decides it on the machine"});
}

/// Tells which slides have begun and ended since `before`, and what they hide.
void Switching::note_slides(const Units& before, const Units& repelled, double t) {
  const SwitchStructure& structure = program_.switch_structure();
  const auto tell = [&](std::uint32_t unit, const char* what) {
    const Switch& s = program_.switches()[structure.members[unit].front()];
    record(t, fmt::format("{}: {} {} = 0", s.block, what, s.comparison));
  };
  for (const std::uint32_t unit : before) {
    if (contains(slide_.units(), unit)) continue;
    tell(unit, "leaves");
    if (contains(repelled, unit)) warn_of_repulsion(unit, t);
    // It may lie on the wrong side by what the integration let it drift off; after a jump it lies elsewhere.
    for (const std::uint32_t s : structure.members[unit]) {
      if (std::abs(surfaces_[s]) <= SlidingMode::drift()) thresholds_.slack[s] = 2 * std::abs(surfaces_[s]);
    }
  }
  for (const std::uint32_t unit : slide_.units()) {
    if (!contains(before, unit)) tell(unit, "slides along");
  }
  for (const std::uint32_t s : slide_.followers()) {
    if (!slide_.is_torn(s)) continue;
    const Switch& follower = program_.switches()[s];
    const std::string what = fmt::format(
        "'{}' ({}) depends on '{}', which slides along its surface from t = {:.9g} s: it switches "
        "without end, which is not counted and not stored",
        follower.block, follower.comparison,
        program_.switches()[structure.members[slide_.units().front()].front()].block, t);
    const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const Diagnostic& warning) {
      return warning.what.substr(0, warning.what.find(" from t = ")) ==
             what.substr(0, what.find(" from t = "));
    });
    const bool acts = std::any_of(program_.events().begin(), program_.events().end(),
                                  [&](const Event& event) { return event.block == follower.block; });
    if (acts && !told)
      warnings_.push_back({{file_, {}}, what, {}, "give the switch that slides a hysteresis"});
  }
}

void Switching::settle(double t, std::vector<double>& x) {
  const Units before = slide_.units();
  Units repelled;
  if (slide_.active() && slide_.evaluate(t, x)) {
    for (std::size_t u = 0; u < before.size(); ++u) {
      if (slide_.repulsion(u) > -SlidingMode::kNoDrive) repelled.push_back(before[u]);
    }
  }
  begin_to_settle();
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {  // the stretch may have ended before their time
    const double rate = program_.known_rate(s, workspace_).value_or(0);
    if (is_known(s) && std::abs(surfaces_[s]) > 8 * resolution(t) * std::abs(rate)) announced_[s] = -1;
  }
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (announced_[s] < 0) continue;
    record(t, fmt::format("{}: {} {}", program_.switches()[s].block, program_.switches()[s].comparison,
                          announced_[s] > 0 ? "from now on" : "no longer"));
  }
  for (int round = 0;; ++round) {
    settle_switches(t, x);
    if (!serve_events(t, x, false)) break;
    if (round > kMostRounds)
      throw_chatter(records_.empty() ? "" : records_.back().what, "events set each other off", t);
  }
  note_slides(before, repelled, t);
  slid_.clear();
  std::fill(announced_.begin(), announced_.end(), -1.0);
  evaluate(t, x);
  // Where a surface goes back at once it stays on the wrong side for a moment, which is no event of its own.
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    if (is_known(s) || slide_.holds(s) || slide_.follows(s)) continue;
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    const double wrong = closed ? -surfaces_[s] : surfaces_[s];
    if (wrong > thresholds_.now[s]) thresholds_.now[s] = thresholds_.slack[s] = 2 * wrong;
  }
}

/// Starts the states that start from signals. Those that start from each other in a circle begin where they
/// agree, which is not what integrators do that take their values by turns.
void Switching::take_starts(double t, std::vector<double>& x) {
  constexpr long kMostRoundsInCircle = 100;
  const long starts = std::count_if(program_.states().begin(), program_.states().end(),
                                    [](const State& state) { return state.start_node.has_value(); });
  std::vector<std::size_t> circle;
  bool changes = true, finite = true;
  for (long round = 0; changes && finite && round <= starts + kMostRoundsInCircle; ++round) {
    if (!program_.signals(t, x.data(), signals_.data(), workspace_))
      throw loop_error(program_, workspace_.trouble(), t, file_);
    changes = false;
    for (std::size_t i = 0; i < x.size(); ++i) {
      const auto value = program_.start_value(i, workspace_);
      if (!value || std::abs(*value - x[i]) <= 4 * kEpsilon * (1 + std::abs(*value))) continue;
      changes = true;
      finite = finite && std::isfinite(*value);
      // A chain of starts is through after as many rounds as it is long.
      if ((round > starts || !std::isfinite(*value)) &&
          std::find(circle.begin(), circle.end(), i) == circle.end())
        circle.push_back(i);
      x[i] = *value;
    }
  }
  if (circle.empty()) return;
  std::sort(circle.begin(), circle.end());
  std::vector<std::string> quoted;
  for (const std::size_t i : circle) quoted.push_back(fmt::format("'{}'", program_.states()[i].name));
  const std::string told = fmt::format("the initial values of {} follow from each other in a circle",
                                       shortened(std::move(quoted)));
  constexpr const char* kCut =
      "give one of them a fixed 'initial', or cut the circle at the start with an electronic-switch";
  if (changes)
    throw SolveError(SolveError::Kind::no_rest, t, {{file_, {}}, told, "initial values that agree", kCut});
  const State& first = program_.states()[circle.front()];
  const std::string agreed =
      fmt::format("{}: the run begins where they agree, at {} = {:.6g}", told, first.name, x[circle.front()]);
  const bool is_told = std::any_of(warnings_.begin(), warnings_.end(),
                                   [&](const Diagnostic& warning) { return warning.what == agreed; });
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
  for (const Switch& made : program_.switches()) {
    if (made.turning != Turning::limits || workspace_.memory(made.memory) == 0) continue;
    workspace_.set_memory(made.memory, 0);
    any = true;
  }
  if (!any) return false;
  try {
    bring_to_rest();
    evaluate(t, x);
    bool within = true;
    for (std::size_t s = 0; s < surfaces_.size(); ++s)
      within =
          within && (program_.switches()[s].turning != Turning::limits || surfaces_[s] <= thresholds_.now[s]);
    if (within) return true;
  } catch (const SolveError&) {  // what lies between the limits has no rest; they may make one
  }
  x = states;
  for (std::size_t m = 0; m < memories.size(); ++m) workspace_.set_memory(m, memories[m]);
  return false;
}

void Switching::start(double t, std::vector<double>& x, const std::function<void()>& bring_to_rest) {
  bool any_start = false;
  for (const State& state : program_.states()) any_start = any_start || state.start_node.has_value();
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

double Switching::known_wait(double t, std::span<const double> x) {
  if (announced_.empty()) return kInfinity;
  double next = kInfinity;
  std::vector<double> waits(announced_.size(), kInfinity);
  evaluate(t, x);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    const auto rate = program_.known_rate(s, workspace_);
    if (!rate) continue;
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    if (closed ? *rate >= 0 : *rate <= 0) continue;
    waits[s] = std::abs(surfaces_[s]) <= thresholds_.now[s] ? 0 : std::max(0.0, -surfaces_[s] / *rate);
    next = std::min(next, waits[s]);
  }
  std::fill(announced_.begin(), announced_.end(), -1.0);
  for (std::size_t s = 0; s < announced_.size(); ++s) {
    if (waits[s] < kInfinity && waits[s] <= next + resolution(t + next)) {
      announced_[s] = 1 - workspace_.memory(program_.switches()[s].memory);
    }
  }
  return next;
}

std::optional<double> Switching::search(double from, std::span<const double> looks,
                                        const Interpolant& solution) {
  const auto found = search_.search(from, looks, solution);
  if (!found) return std::nullopt;
  std::fill(announced_.begin(), announced_.end(), -1.0);
  for (const auto& [s, position] : found->turned) announced_[s] = position;
  return found->time;
}

bool Switching::derivatives(double t, const double* x, double* dxdt) {
  return slide_.active() ? slide_.derivatives(t, x, dxdt) : program_.derivatives(t, x, dxdt, workspace_);
}

bool Switching::jacobian(double t, const double* x, double* values) {
  return slide_.active() ? slide_.jacobian(t, x, values) : program_.jacobian(t, x, values, workspace_);
}

bool Switching::signals(double t, const double* x, double* values) {
  return slide_.active() ? slide_.signals(t, x, values) : program_.signals(t, x, values, workspace_);
}

}  // namespace oblique
