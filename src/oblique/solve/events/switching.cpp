// SPDX-License-Identifier: MIT
#include <oblique/solve/events/switching.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <oblique/solve/solve_error.h>

namespace oblique::solve {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A switch that turns over without having left its place, by more than rounding or the errors of the states,
/// is restless after a few turns: its surface then counts as zero within those errors. After many it
/// chatters.
constexpr long kRestless = 5;
constexpr long kMostTurns = 1000;

constexpr std::size_t kMostRecords = 1000;

bool contains(const std::vector<std::uint32_t>& units, std::uint32_t unit) {
  return std::find(units.begin(), units.end(), unit) != units.end();
}

/// Nearer than this no two times are told apart.
double resolution(double t) {
  return 4 * kEpsilon * std::abs(t);
}

}  // namespace

Switching::Switching(const network::Program& program, network::Workspace& workspace, double span,
                     double tolerance, double absolute_tolerance, const std::string& file)
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
      faint_turns_(program, workspace, span),
      positions_(program, workspace, slide_, thresholds_.now, span),
      surfaces_(program.switches().size()),
      signals_(program.n_signals()),
      announced_(program.switches().size(), -1),
      errors_(program.switches().size(), 0),
      held_(program.events().size(), false),
      came_(program.events().size(), false),
      stays_(program.switches().size(), false),
      decided_(program.switch_structure().members.size(), false),
      rested_(program.switches().size(), false),
      unrest_(program.switches().size()),
      paces_(program.events().size()),
      chained_(known_follow_from_others()) {}

/// Then the time at which one comes tells nothing of where it goes before the others are known.
bool Switching::known_follow_from_others() const {
  for (std::size_t s = 0; s < program_.switches().size(); ++s) {
    if (is_known(s) && program_.is_ordered(s) && !program_.switch_structure().positions_below(s).empty())
      return true;
  }
  return false;
}

/// The surfaces, and how far from zero each counts as zero: one of time alone is known to rounding of the
/// time.
void Switching::evaluate(double t, std::span<const double> x) {
  interruption_.check();
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
  const network::Switch& made = program_.switches()[s];
  if (workspace_.memory(made.memory) == position) return;
  workspace_.set_memory(made.memory, position);
  if (!weighed_) weigh_errors();
  Unrest& unrest = unrest_[s];
  const bool same_place = is_known(s) ? t <= unrest.last : search_.excursion(s) < place_size(s);
  if (!same_place) unrest.turns = 0;
  unrest.last = t;
  search_.forget(s);
  // A surface that is merely touched goes back and forth by the errors of the states.
  const network::SwitchStructure& structure = program_.switch_structure();
  const auto& unit = structure.members[structure.unit[s]];
  const bool found =
      std::any_of(unit.begin(), unit.end(), [&](std::uint32_t m) { return announced_[m] >= 0; });
  if (!is_known(s) && found) thresholds_.slack[s] = errors_[s];
  if (++unrest.turns > kMostTurns) throw_chatter(made.block, made.comparison, t);
}

/// Turns every switch over whose surface asks for it, and collects the units that lie on their surfaces and
/// have not been decided yet. True where any turned over.
bool Switching::turn_by_surfaces(double t, Units& on_surface, std::vector<std::uint32_t>& turned) {
  const network::SwitchStructure& structure = program_.switch_structure();
  on_surface.clear();
  turned.clear();
  std::vector<bool> listed = decided_;
  for (std::uint32_t s = 0; s < surfaces_.size(); ++s) {
    if (slide_.holds(s) || slide_.follows(s)) continue;
    const double before = workspace_.memory(program_.switches()[s].memory);
    const std::uint32_t unit = structure.unit[s];
    const bool drifted = slide_.rests(s) || (!decided_[unit] && (rested_[s] || contains(slid_, unit)));
    double near = drifted ? std::max(SlidingMode::drift(), thresholds_.now[s]) : thresholds_.now[s];
    if (unrest_[s].turns > kRestless) near = std::max(near, place_size(s));
    double position = before;
    if (is_known(s)) {
      if (chained_ && program_.is_ordered(s)) continue;  // is where it belongs
      const double rate = program_.known_rate(s, workspace_).value_or(0);
      if (announced_[s] >= 0) {
        position = announced_[s];
      } else if (std::abs(surfaces_[s]) > thresholds_.now[s] || rate != 0) {
        position = (std::abs(surfaces_[s]) > thresholds_.now[s] ? surfaces_[s] : rate) > 0 ? 1 : 0;
      }
    } else if (announced_[s] >= 0 || std::abs(surfaces_[s]) <= near) {
      if (!listed[unit]) on_surface.push_back(unit);
      listed[unit] = true;
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
  const network::SwitchStructure& structure = program_.switch_structure();
  for (const std::uint32_t unit : slide_.units()) {
    if (!contains(units, unit)) units.push_back(unit);
  }
  slide_.end();
  std::vector<bool> preferred(units.size());
  std::vector<double> before;
  for (std::size_t u = 0; u < units.size(); ++u) {
    decided_[units[u]] = true;
    const std::uint32_t s = structure.members[units[u]].front();
    double position = workspace_.memory(program_.switches()[s].memory);
    if (set_ && surfaces_[s] == 0) position = 0;  // put on its level it is not above it
    for (const std::uint32_t member : structure.members[units[u]]) {
      if (announced_[member] >= 0)
        position =
            structure.opposite[member] == structure.opposite[s] ? announced_[member] : 1 - announced_[member];
    }
    preferred[u] = (position == 1) != structure.opposite[s];
  }
  for (const network::Switch& s : program_.switches()) before.push_back(workspace_.memory(s.memory));
  if (!positions_.choose(units, preferred, t, x)) {
    std::vector<std::uint32_t> members;
    for (const std::uint32_t unit : units)
      members.insert(members.end(), structure.members[unit].begin(), structure.members[unit].end());
    if (units.size() > Positions::kMostUnits || !positions_.choose_any(members, t, x)) {
      const network::Switch& first = program_.switches()[members.front()];
      throw_chatter(first.block, "no position of its switch agrees with the signals that follow from it", t);
    }
  }
  for (const std::uint32_t unit : positions_.resting()) {
    for (const std::uint32_t member : structure.members[unit]) stays_[member] = true;
  }
  for (const std::uint32_t unit : positions_.undecided()) {
    if (contains(slid_, unit)) continue;  // which is told apart
    const auto& members = structure.members[unit];
    const bool came =
        std::any_of(members.begin(), members.end(), [&](std::uint32_t m) { return announced_[m] >= 0; });
    if (!came) warn_of_no_side(unit, t);
  }
  for (std::size_t s = 0; s < before.size(); ++s) {  // those that turned over count
    const double position = workspace_.memory(program_.switches()[s].memory);
    workspace_.set_memory(program_.switches()[s].memory, before[s]);
    turn(s, position, t);
  }
}

/// Turns every switch over whose surface asks for it, each after those on whose positions its surface
/// depends: one after the other turns over in one go, however many there are. At its known time a switch goes
/// where its surface goes with the others as they then stand: it may merely touch.
void Switching::turn_in_order(double t, std::span<const double> x) {
  if (!weighed_) weigh_errors();
  std::vector<double> still(x.size(), 0.0);  // what is known follows the time alone
  program_.decide_in_order(
      t, x.data(), still.data(), workspace_, [&](std::uint32_t s, double surface, double rate) {
        const bool away = std::abs(surface) > thresholds_.now[s];
        if (is_known(s) && !chained_) return;
        if (is_known(s)) {
          const bool due = announced_[s] >= 0;
          const double position = away && !due ? (surface > 0 ? 1 : 0)
                                  : rate != 0  ? (rate > 0 ? 1 : 0)
                                  : due        ? announced_[s]
                                               : workspace_.memory(program_.switches()[s].memory);
          turn(s, position, t);
          return;
        }
        const bool decided = announced_[s] >= 0 || slide_.holds(s) || slide_.follows(s) || slide_.rests(s) ||
                             rested_[s] || decided_[program_.switch_structure().unit[s]];
        if (!decided && away) turn(s, surface > 0 ? 1 : 0, t);
      });
}

/// All switches and the algebra between them to a fixed point; true where any turned over.
bool Switching::settle_switches(double t, std::span<const double> x) {
  constexpr std::size_t kInOrder = 2;  // rounds before
  const std::size_t most = 2 * surfaces_.size() + 10;
  bool any = false;
  Units on_surface;
  std::vector<std::uint32_t> turned, restless;
  for (std::size_t round = 0;; ++round) {
    evaluate(t, x);
    if (chained_ || round == kInOrder) {
      const std::vector<double> before(workspace_.memories().begin(), workspace_.memories().end());
      turn_in_order(t, x);
      any = any || !std::equal(before.begin(), before.end(), workspace_.memories().begin());
      evaluate(t, x);
    }
    if (turn_by_surfaces(t, on_surface, turned)) {
      any = true;
      if (round <= most) continue;
      // These go on turning over: their surfaces depend on their own positions.
      restless.insert(restless.end(), turned.begin(), turned.end());
      if (round <= 2 * most) continue;
      if (!positions_.choose_any(restless, t, x)) {
        const network::Switch& first =
            program_.switches()[*std::min_element(restless.begin(), restless.end())];
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

/// What lies on its surface is decided anew, and what slides is looked at as if it came there now.
void Switching::begin_to_settle() {
  std::fill(decided_.begin(), decided_.end(), false);
  std::fill(stays_.begin(), stays_.end(), false);
  slid_ = slide_.units();
  for (std::size_t s = 0; s < rested_.size(); ++s) rested_[s] = resumed_ || slide_.rests(s);
  resumed_ = false;
  slide_.end();
}

/// A warning about a unit that is the same each time but for what follows `what`; once for each unit: it may
/// come back.
void Switching::warn_once(std::uint32_t unit, const char* what, const std::string& rest, const char* remedy) {
  const network::Switch& s = program_.switches()[program_.switch_structure().members[unit].front()];
  const std::string begin = fmt::format("'{}' ({}) {}", s.block, s.comparison, what);
  const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& warning) {
    return warning.what.starts_with(begin);
  });
  if (!told) warnings_.push_back({{file_, {}}, begin + rest, {}, remedy});
}

/// Tells that rounding decides where the solution goes.
void Switching::warn_of_repulsion(std::uint32_t unit, double t) {
  warn_once(unit, "leaves the surface that it slides along",
            fmt::format(" at t = {:.9g} s, since both of its sides drive away from it from then on: rounding "
                        "decides to which side it goes",
                        t),
            "end the run before, or add the disturbance that decides it on the machine");
}

/// Tells that nothing decides where the solution goes.
void Switching::warn_of_no_side(std::uint32_t unit, double t) {
  warn_once(
      unit, "stands on its surface",
      fmt::format(" at t = {:.9g} s, and both of its sides drive away from it: nothing decides to which "
                  "side it goes",
                  t),
      "begin a little to the side that is meant, or add the disturbance that decides it on the machine");
}

/// Tells which slides have begun and ended since `before`, and what they hide.
void Switching::note_slides(const Units& before, const Units& repelled, double t) {
  const network::SwitchStructure& structure = program_.switch_structure();
  const auto tell = [&](std::uint32_t unit, const char* what) {
    const network::Switch& s = program_.switches()[structure.members[unit].front()];
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
    const network::Switch& follower = program_.switches()[s];
    const std::string what = fmt::format(
        "'{}' ({}) depends on '{}', which slides along its surface from t = {:.9g} s: it switches "
        "without end, which is not counted and not stored",
        follower.block, follower.comparison,
        program_.switches()[structure.members[slide_.units().front()].front()].block, t);
    const bool told = std::any_of(warnings_.begin(), warnings_.end(), [&](const text::Diagnostic& warning) {
      return warning.what.substr(0, warning.what.find(" from t = ")) ==
             what.substr(0, what.find(" from t = "));
    });
    const bool acts = std::any_of(program_.events().begin(), program_.events().end(),
                                  [&](const network::Event& event) { return event.block == follower.block; });
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
  std::vector<FaintTurn> faint = faint_turns_at(t);
  if (!faint.empty() && !signals(t, x.data(), signals_.data())) faint.clear();
  const std::vector<double> signals_before = faint.empty() ? std::vector<double>() : signals_;
  std::fill(came_.begin(), came_.end(), false);
  set_ = false;
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
  if (faint.empty() || !signals(t, x.data(), signals_.data())) return;
  for (FaintTurn& turn : faint) {
    if (FaintTurns::jumps(signals_before, signals_, turn.error)) faint_.push_back(std::move(turn));
  }
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
  faint_turns_.approach(from, found->time, found->turned, solution);
  return found->time;
}

bool Switching::derivatives(double t, const double* x, double* dxdt) {
  return slide_.active() ? slide_.derivatives(t, x, dxdt) : program_.derivatives(t, x, dxdt, workspace_);
}

bool Switching::jacobian(double t, const double* x, double* values) {
  return slide_.active() ? slide_.jacobian(t, x, values) : program_.jacobian(t, x, values, workspace_);
}

bool Switching::signals(double t, const double* x, double* values) {
  interruption_.check();
  return slide_.active() ? slide_.signals(t, x, values) : program_.signals(t, x, values, workspace_);
}

}  // namespace oblique::solve
