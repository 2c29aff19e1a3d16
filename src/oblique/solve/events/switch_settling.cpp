// SPDX-License-Identifier: MIT
#include <oblique/solve/events/switch_settling.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/position_effects.h>
#include <oblique/solve/events/self_consistent.h>
#include <oblique/solve/events/time_resolution.h>

namespace oblique::solve {
namespace {

/// A switch that turns over without having left its place, by more than rounding or the errors of the states,
/// is restless after a few turns: its event function then counts as zero within those errors. After many it
/// chatters.
constexpr long kRestless = 5;
constexpr long kMostTurns = 1000;
/// Turns within the errors of the states after all of them have piled up.
constexpr long kMostBeyond = 20;

constexpr double kSamePlace =
    10;  ///< roundings: an event function that is no farther off has not left its place

bool has_unit(const std::vector<std::uint32_t>& units, std::uint32_t unit) {
  return std::find(units.begin(), units.end(), unit) != units.end();
}

}  // namespace

SwitchSettling::SwitchSettling(const network::Program& program, network::Workspace& workspace,
                               SlidingMode& slide, IndependentUnits& independent,
                               EventFunctions& event_functions, const Announced& announced, EventLog& log,
                               double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      independent_(independent),
      event_functions_(event_functions),
      announced_(announced),
      log_(log),
      span_(span),
      positions_(program, workspace, slide, event_functions.thresholds(), span),
      chained_(known_follow_from_others()),
      setters_(find_setters(program)),
      stays_(program.switches().size(), false),
      decided_(program.switch_structure().members.size(), false),
      rested_(program.switches().size(), false),
      before_instant_(program.switches().size()),
      rates_before_(program.switches().size()),
      derivatives_(program.n_states()),
      unrest_(program.switches().size()) {}

/// Then the time at which one comes tells nothing of where it goes before the others are known.
bool SwitchSettling::known_follow_from_others() const {
  for (std::size_t s = 0; s < program_.switches().size(); ++s) {
    if (event_functions_.is_known(s) && program_.is_ordered(s) &&
        !program_.switch_structure().positions_below(s).empty())
      return true;
  }
  return false;
}

/// Within this of zero an event function is where it was.
double SwitchSettling::place_size(std::size_t s) const {
  return std::max(kSamePlace * event_functions_.thresholds().rounding(s), event_functions_.last_errors()[s]);
}

/// Within this of zero an event function counts as zero: one that was slid along may have drifted off.
double SwitchSettling::near_size(std::size_t s) const {
  const std::uint32_t unit = program_.switch_structure().unit[s];
  const double threshold = event_functions_.thresholds()[s];
  const bool drifted = slide_.rests(s) || (!decided_[unit] && (rested_[s] || has_unit(slid_, unit)));
  const double near = drifted ? std::max(SlidingMode::drift(), threshold) : threshold;
  if (unrest_[s].beyond > 0) return std::max(near, kSamePlace * place_size(s));
  return unrest_[s].turns > kRestless ? std::max(near, place_size(s)) : near;
}

/// Whether an event function counts as zero, so that the solution decides. That of a switch that is announced
/// lies a little past it; one that rested beside a slide, and has left it by more than that drifts, does not
/// rest.
bool SwitchSettling::is_near(std::size_t s) const {
  const double near = near_size(s);
  return std::abs(event_functions_[s]) <= (announced_[s] ? std::max(near, SlidingMode::drift()) : near);
}

/// Whether an event function is at zero by the errors of the states, as that of a decay, moves so slowly that
/// it may stay there, and nothing at this instant at t has moved it: then the switch stays where it is until
/// it is announced. What crosses zero together with something else is not slow. So does one that is nearer to
/// zero than rounding of a machine unit, but known to be on its side: what decays to zero does not reach it.
bool SwitchSettling::waits(std::size_t s, double event_function, double t) {
  constexpr double kSlow = 1000;  // errors that no step damps, in the time since it turned over last
  const double rounding = event_functions_.thresholds().rounding(s), size = std::abs(event_function);
  const double may_be_near = unrest_[s].touch ? event_functions_.thresholds()[s] : rounding;
  if (starting_ || near_size(s) > may_be_near || is_announced(program_.switch_structure().unit[s]))
    return false;
  if (is_put_on_zero(s, event_function, t) || !(std::abs(event_function - before_instant_[s]) <= rounding))
    return false;
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  const double error = errors[s], undamped = errors.undamped(s);
  const double known_to = std::max(error, event_functions_.thresholds().resolution(s));
  const bool is_in_place = position(s) == (event_function > 0 ? 1 : 0);
  if (is_in_place && size <= rounding && size > known_to) return true;
  return size <= std::max(rounding, error) && rates_before_[s] * (t - unrest_[s].last) <= kSlow * undamped;
}

/// Whether something at this instant at t has put an event function on zero to rounding, which had not come
/// to it by itself (a counter that reaches what it is compared with): the switch does not hold there.
bool SwitchSettling::is_put_on_zero(std::size_t s, double event_function, double t) const {
  const double rounding = event_functions_.thresholds().rounding(s), before = before_instant_[s];
  if (is_announced(program_.switch_structure().unit[s]) || !(std::abs(event_function) <= rounding))
    return false;
  return unrest_[s].last == t || !(std::abs(event_function - before) <= rounding) ||
         (set_ && event_function == 0 && before != 0);
}

/// Whether any switch of a unit is.
bool SwitchSettling::is_announced(std::uint32_t unit) const {
  const auto& members = program_.switch_structure().members[unit];
  return std::any_of(members.begin(), members.end(),
                     [&](std::uint32_t m) { return announced_[m].has_value(); });
}

void SwitchSettling::turn(std::size_t s, double position, double t) {
  const network::Switch& made = program_.switches()[s];
  if (workspace_.discrete_state(made.discrete_state) == position) return;
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  workspace_.set_discrete_state(made.discrete_state, position);
  Thresholds& thresholds = event_functions_.thresholds();
  Unrest& unrest = unrest_[s];
  const bool known = event_functions_.is_known(s);
  // What is taken far away by others turns over and back at an instant, without an excursion between
  // instants.
  const bool taken_away = t > unrest.last && std::abs(event_functions_[s]) >= place_size(s);
  const bool same_place = known ? t <= unrest.last : thresholds.excursion(s) < place_size(s) && !taken_away;
  if (!same_place) unrest.turns = 0;
  if (!known) watch_pace(s, t);
  unrest.last = t;
  unrest.touch.reset();
  thresholds.forget(s);
  // An event function that is merely touched goes back and forth by the errors of the states.
  if (!known && is_announced(program_.switch_structure().unit[s]))
    thresholds.give_slack(s, errors.undamped(s));
  if (++unrest.turns > kMostTurns) throw log_.endless(made.block, made.comparison, t);
}

/// Turns that come ever faster end at a time at which infinitely many have come. What the errors of the
/// states make of them after that is no solution: what lies at zero within ten of these may slide, and the
/// run ends where nothing does.
void SwitchSettling::watch_pace(std::size_t s, double t) {
  constexpr double kWider = 100;  // than for events, of the run: errors hide the last turns
  constexpr double kRest = 1e-3;  // of the run: it has slid in between
  Unrest& unrest = unrest_[s];
  if (const auto zeno = unrest.pace.come(t, kWider * span_, std::numeric_limits<double>::infinity()))
    unrest.piles_up = zeno->at;
  const bool beyond = unrest.piles_up && t > *unrest.piles_up && t - unrest.last < kRest * span_ &&
                      event_functions_.thresholds().excursion(s) < kSamePlace * place_size(s);
  unrest.beyond = beyond ? unrest.beyond + 1 : 0;
  if (unrest.beyond <= kMostBeyond) return;
  const network::Switch& made = program_.switches()[s];
  throw log_.piled_up(made.block, made.comparison, *unrest.piles_up, t);
}

/// Where a switch goes that follows the time alone, by its event function and the rate of that as all others
/// stand now. At its level, where it rests (a ramp that ends, the difference of two counters), it does not
/// hold; what is due goes where its rate leads, unless something else has taken it elsewhere at this instant.
double SwitchSettling::known_position(std::size_t s, double event_function, double rate, double t) const {
  const double threshold = event_functions_.thresholds()[s];
  const double near = announced_[s] ? std::max(threshold, off_at_zero(t, rate)) : threshold;
  if (std::abs(event_function) > near) return event_function > 0 ? 1 : 0;
  return rate > 0 ? 1 : 0;
}

/// Turns every switch over whose event function asks for it, and collects the units that lie on their
/// switching surfaces and have not been decided yet. True where any turned over.
bool SwitchSettling::turn_by_event_functions(double t, std::span<const double> x, Units& at_zero,
                                             std::vector<std::uint32_t>& turned) {
  const network::SwitchStructure& structure = program_.switch_structure();
  at_zero.clear();
  turned.clear();
  std::vector<bool> listed = decided_;
  for (std::uint32_t s = 0; s < event_functions_.size(); ++s) {
    if (slide_.holds(s) || slide_.follows(s)) continue;
    const double before = position(s);
    double asked = before;
    if (event_functions_.is_known(s)) {
      if (chained_ && program_.is_ordered(s)) continue;  // is where it belongs
      asked = known_position(s, event_functions_[s], event_functions_.known_rate(s).value_or(0), t);
    } else if (waits(s, event_functions_[s], t)) {
      continue;
    } else if (is_near(s)) {
      const std::uint32_t unit = structure.unit[s];
      if (listed[unit]) continue;
      listed[unit] = true;
      const bool may_jump =
          announced_[s] && *announced_[s] != before && !has_unit(slid_, unit) && !slide_.active();
      if (!may_jump || !sets_off_a_jump(program_, workspace_, event_functions_.thresholds(), setters_[unit],
                                        announced_, s, t, x)) {
        at_zero.push_back(unit);
        continue;
      }
      decided_[unit] = true;
      for (const std::uint32_t member : structure.members[unit]) {
        if (!announced_[member] || position(member) == *announced_[member]) continue;
        turn(member, *announced_[member], t);
        turned.push_back(member);
      }
      continue;
    } else if (event_functions_.is_off_zero(s)) {
      asked = event_functions_[s] > 0 ? 1 : 0;
    }
    if (asked == before) continue;
    turn(s, asked, t);
    turned.push_back(s);
  }
  return !turned.empty();
}

/// Turns every switch over whose event function asks for it, each after those on whose positions its event
/// function depends: one after the other turns over in one go, however many there are. At its known time a
/// switch goes where its event function goes with the others as they then stand: it may merely touch.
void SwitchSettling::turn_in_order(double t, std::span<const double> x) {
  event_functions_.weigh_errors();
  const std::vector<double> still(x.size(), 0.0);  // what is known follows the time alone
  program_.decide_in_order(
      t, x.data(), still.data(), workspace_, [&](std::uint32_t s, double event_function, double rate) {
        const bool away = std::abs(event_function) > event_functions_.thresholds()[s];
        const bool due = announced_[s].has_value();
        if (event_functions_.is_known(s)) {
          if (!chained_) return;
          turn(s, known_position(s, event_function, rate, t), t);
          return;
        }
        const bool decided = due || slide_.holds(s) || slide_.follows(s) || slide_.rests(s) || rested_[s] ||
                             decided_[program_.switch_structure().unit[s]];
        if (!decided && away && !waits(s, event_function, t)) turn(s, event_function > 0 ? 1 : 0, t);
      });
}

/// Where the switches of a unit that lies on its switching surface are left where they may be on either side.
/// At zero none of them need hold, though their event functions be opposite.
void SwitchSettling::add_preferred(std::uint32_t unit, double t, std::vector<double>& preferred) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  for (const std::uint32_t s : structure.members[unit]) {
    preferred[s] = announced_position(structure, announced_, s).value_or(position(s));
    if (event_functions_[s] == 0 || is_put_on_zero(s, event_functions_[s], t)) preferred[s] = 0;
  }
}

/// Whether a unit lies at its level to what its time is known to, where it was announced, or to rounding.
bool SwitchSettling::is_at_level(std::uint32_t unit) const {
  const std::uint32_t s = program_.switch_structure().members[unit].front();
  const double near = is_announced(unit) ? SlidingMode::drift() : event_functions_.thresholds().rounding(s);
  return std::abs(event_functions_[s]) <= near;
}

/// Adds the corners that have come at this instant and were decided before: where a unit lies at zero behind
/// one, as what reads a dead zone at its edge, both decide each other.
void SwitchSettling::add_corners(Units& units) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  for (std::uint32_t s = 0; s < announced_.size(); ++s) {
    const std::uint32_t unit = structure.unit[s];
    if (!announced_[s] || !decided_[unit] || has_unit(units, unit) || slide_.holds(s) || !is_at_level(unit))
      continue;
    const auto& members = structure.members[unit];
    const bool only_bends = std::none_of(members.begin(), members.end(), [&](std::uint32_t member) {
      return program_.switches()[member].turning == network::Turning::jumps;
    });
    if (only_bends) units.push_back(unit);
  }
}

/// Lets the solution decide where the units go that lie on their switching surfaces, those together that are
/// not independent, with those that slide; what slides beside them slides on. One for which nothing agrees as
/// long as others have not settled comes after these; where none can be the first, all are decided together.
void SwitchSettling::decide(Units units, double t, std::span<const double> x) {
  add_corners(units);
  Units all = units, kept;
  for (const std::uint32_t unit : slide_.units()) {
    if (!has_unit(units, unit)) all.push_back(unit);
  }
  std::vector<Units> left;
  for (const std::vector<std::size_t>& part : independent_.parts_of(all)) {
    // The units to be decided stand before the others.
    Units& together = part.front() < units.size() ? left.emplace_back() : kept;
    for (const std::size_t place : part) together.push_back(all[place]);
  }
  slide_.keep(kept, t, x);
  while (!left.empty()) {
    const auto first = std::find_if(left.begin(), left.end(),
                                    [&](const Units& together) { return decide_together(together, t, x); });
    if (first != left.end()) {
      left.erase(first);
      continue;
    }
    Units together;
    for (const Units& part : left) together.insert(together.end(), part.begin(), part.end());
    if ((left.size() > 1 && decide_together(together, t, x)) || decide_in_order(together, t, x)) return;
    const std::uint32_t named = members_of(together).front();
    const auto jumping = std::count_if(together.begin(), together.end(), [&](std::uint32_t unit) {
      const auto& members = program_.switch_structure().members[unit];
      return std::any_of(members.begin(), members.end(), [&](std::uint32_t s) {
        return program_.switches()[s].turning == network::Turning::jumps;
      });
    });
    if (jumping > static_cast<std::ptrdiff_t>(Positions::kMostUnits))
      throw log_.too_many(program_.switches()[named].block, static_cast<std::size_t>(jumping),
                          Positions::kMostUnits, t);
    throw no_position(named, t);
  }
}

/// Decides more units than can be tried together, those first that act on the others. False where they all
/// act on each other, or nothing agrees.
bool SwitchSettling::decide_in_order(const Units& units, double t, std::span<const double> x) {
  const std::vector<Units> groups = independent_.mutual_of(units);
  return units.size() > Positions::kMostUnits && groups.size() > 1 &&
         std::all_of(groups.begin(), groups.end(),
                     [&](const Units& group) { return decide_together(group, t, x); });
}

/// False, with nothing changed, where nothing agrees.
bool SwitchSettling::decide_together(const Units& units, double t, std::span<const double> x) {
  event_functions_.evaluate(t, x, announced_);
  std::vector<double> preferred(event_functions_.size());
  Units may_stop;
  for (const std::uint32_t unit : units) {
    decided_[unit] = true;
    add_preferred(unit, t, preferred);
    if (is_at_level(unit) && !has_unit(slid_, unit)) may_stop.push_back(unit);
  }
  std::vector<double> before;
  for (std::size_t s = 0; s < event_functions_.size(); ++s) before.push_back(position(s));
  event_functions_.weigh_errors();
  if (!positions_.choose(units, preferred, may_stop, event_functions_.here(), t, x) &&
      !choose_beside_slide(units, preferred, may_stop, t, x)) {
    if (units.size() > Positions::kMostUnits || !choose_restless(members_of(units), {}, t, x)) {
      for (std::size_t s = 0; s < before.size(); ++s)
        workspace_.set_discrete_state(program_.switches()[s].discrete_state, before[s]);
      return false;
    }
  }
  note_choice(t, x);
  for (std::size_t s = 0; s < before.size(); ++s) {  // those that turned over count
    const double chosen = position(s);
    workspace_.set_discrete_state(program_.switches()[s].discrete_state, before[s]);
    turn(s, chosen, t);
  }
  return true;
}

std::vector<std::uint32_t> SwitchSettling::members_of(const Units& units) const {
  std::vector<std::uint32_t> members;
  for (const std::uint32_t unit : units) {
    const auto& own = program_.switch_structure().members[unit];
    members.insert(members.end(), own.begin(), own.end());
  }
  return members;
}

/// Where no positions of these units agree: puts those that did not slide where they agree (an amplifier that
/// flips to its other limit), and lets the others slide on beside them. False where that is no way either.
bool SwitchSettling::choose_beside_slide(const Units& units, const std::vector<double>& preferred,
                                         const Units& may_stop, double t, std::span<const double> x) {
  Units slid, others;
  for (const std::uint32_t unit : units) (has_unit(slid_, unit) ? slid : others).push_back(unit);
  if (slid.empty() || others.empty() || others.size() > Positions::kMostUnits) return false;
  if (!choose_restless(members_of(others), members_of(slid), t, x)) return false;
  event_functions_.evaluate(t, x, announced_);
  event_functions_.weigh_errors();
  return positions_.choose(slid, preferred, may_stop, event_functions_.here(), t, x);
}

/// Puts switches that go on turning over where they and all others but those `left` agree, and tells where
/// that is not the only way; false where there is none.
bool SwitchSettling::choose_restless(const Units& switches, const Units& left, double t,
                                     std::span<const double> x) {
  const Agreement found =
      choose_any(program_, workspace_, slide_, event_functions_.thresholds(), span_, switches, left, t, x);
  if (!found.open.empty()) log_.warn_of_choice(found.open, workspace_, t);
  return found.any;
}

void SwitchSettling::tell_of_open(double t, std::span<const double> x) {
  const auto open = find_open(program_, workspace_, slide_, event_functions_.thresholds(), span_, t, x);
  if (open) log_.warn_of_choice({*open}, workspace_, t);
}

/// What the last choice of positions tells besides.
void SwitchSettling::note_choice(double t, std::span<const double> x) {
  for (const std::uint32_t unit : positions_.resting()) {
    const auto& members = program_.switch_structure().members[unit];
    for (const std::uint32_t member : members) stays_[member] = true;
    // Behind a corner, as in a dead zone, it is at zero exactly: no rounding decides.
    const bool halts = has_unit(slid_, unit) && !has_unit(positions_.flat(), unit);
    if (halts && changes_signals(program_, workspace_, unit, t, x)) log_.warn_of_halt(unit, t);
  }
  for (const std::uint32_t unit : positions_.stopped()) {
    event_functions_.keep_at_level(unit);
    log_.warn_of_stop(unit, t);
  }
  for (const std::uint32_t unit : positions_.undecided()) {
    if (has_unit(slid_, unit) || is_announced(unit)) continue;  // what slid is told of apart
    log_.warn_of_no_side(unit, t);
  }
}

SolveError SwitchSettling::no_position(std::uint32_t s, double t) const {
  return log_.endless(program_.switches()[s].block,
                      "no position of its switch agrees with the signals that follow from it", t);
}

bool SwitchSettling::settle(double t, std::span<const double> x) {
  constexpr std::size_t kInOrder = 2;  // rounds before
  const std::size_t most = 2 * event_functions_.size() + 10;
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  Units at_zero;
  std::vector<std::uint32_t> turned, restless;
  for (std::size_t round = 0;; ++round) {
    event_functions_.evaluate(t, x, announced_);
    if (chained_ || round == kInOrder) {
      turn_in_order(t, x);
      event_functions_.evaluate(t, x, announced_);
    }
    if (turn_by_event_functions(t, x, at_zero, turned)) {
      if (round <= most) continue;
      // These go on turning over: their event functions depend on their own positions.
      restless.insert(restless.end(), turned.begin(), turned.end());
      if (round <= 2 * most) continue;
      // What lies on its switching surface is decided next.
      Units undecided;
      for (const std::uint32_t s : members_of(at_zero)) {
        if (std::find(restless.begin(), restless.end(), s) == restless.end()) undecided.push_back(s);
      }
      if (!choose_restless(restless, undecided, t, x))
        throw no_position(*std::min_element(restless.begin(), restless.end()), t);
      event_functions_.evaluate(t, x, announced_);
      return true;
    }
    if (at_zero.empty()) {
      return slide_.units() != slid_ ||
             !std::equal(before.begin(), before.end(), workspace_.discrete_states().begin());
    }
    decide(at_zero, t, x);
  }
}

void SwitchSettling::begin_instant() {
  set_ = false;
  starting_ = std::exchange(resumes_, false);
  for (std::size_t s = 0; s < before_instant_.size(); ++s) before_instant_[s] = event_functions_[s];
  event_functions_.here().derivatives(derivatives_.data());
  event_functions_.here().event_function_rates(derivatives_.data(), rates_before_.data());
  for (double& rate : rates_before_) rate = std::isfinite(rate) ? std::abs(rate) : 0;
}

void SwitchSettling::begin() {
  begin({}, 0, {});
}

/// The units `kept` slide on, and what rests along with them is decided.
void SwitchSettling::begin(const Units& kept, double t, std::span<const double> x) {
  decided_.assign(decided_.size(), false);
  if (!kept_.empty()) decided_.swap(kept_);
  kept_.clear();
  std::fill(stays_.begin(), stays_.end(), false);
  slid_ = slide_.units();
  for (std::size_t s = 0; s < rested_.size(); ++s)
    rested_[s] = slide_.rests(s) || (s < restored_.size() && restored_[s]);
  restored_.clear();
  slide_.keep(kept, t, x);
  for (std::size_t s = 0; s < rested_.size(); ++s) {
    if (slide_.rests(s)) decided_[program_.switch_structure().unit[s]] = true;
  }
}

void SwitchSettling::begin_beside_slides(double t, std::span<const double> x) {
  Units all, kept;
  for (std::uint32_t s = 0; s < announced_.size(); ++s) {
    const std::uint32_t unit = program_.switch_structure().unit[s];
    if (announced_[s] && !has_unit(all, unit)) all.push_back(unit);
  }
  const std::size_t due = all.size();
  for (const std::uint32_t unit : slide_.units()) {
    if (!has_unit(all, unit)) all.push_back(unit);
  }
  if (due > 0 && due < all.size()) {
    for (const std::vector<std::size_t>& part : independent_.parts_of(all)) {
      if (part.front() < due) continue;
      for (const std::size_t place : part) kept.push_back(all[place]);
    }
  }
  begin(kept, t, x);
}

void SwitchSettling::begin_after_events(const std::vector<std::size_t>& events, bool set_states, bool jumped,
                                        double t, std::span<const double> x) {
  const auto is_acted_on = [&](std::uint32_t unit) {
    return std::any_of(events.begin(), events.end(),
                       [&](std::size_t event) { return independent_.acts(program_.events()[event], unit); });
  };
  const Units& slides = slide_.units();
  Units kept;
  for (const std::vector<std::size_t>& part : independent_.parts_of(slides)) {
    if (std::any_of(part.begin(), part.end(), [&](std::size_t place) { return is_acted_on(slides[place]); }))
      continue;
    for (const std::size_t place : part) kept.push_back(slides[place]);
  }
  begin(kept, t, x);
  // What rests beside a slide that goes on may be driven away.
  for (std::uint32_t s = 0; s < rested_.size(); ++s) {
    const std::uint32_t unit = program_.switch_structure().unit[s];
    if (slide_.rests(s) && is_acted_on(unit)) decided_[unit] = false;
  }
  set_ = set_ || set_states;
  if (!jumped) return;
  slid_ = slide_.units();
  for (std::size_t s = 0; s < rested_.size(); ++s) rested_[s] = slide_.rests(s);
}

void SwitchSettling::end(const std::vector<std::uint32_t>& slid) {
  slid_.clear();
  for (const std::uint32_t unit : slid) {
    if (has_unit(slide_.units(), unit)) continue;
    // It may lie on the wrong side by what the integration let it drift off; after a jump it lies elsewhere.
    for (const std::uint32_t s : program_.switch_structure().members[unit]) {
      const double off = std::abs(event_functions_[s]);
      if (off <= SlidingMode::drift()) event_functions_.thresholds().give_slack(s, 2 * off);
    }
  }
}

void SwitchSettling::watch_followers(double t) {
  constexpr double kPlace = 1e-6;   // [machine unit]
  constexpr double kMoment = 1e-6;  // of the run: turns that come no faster end with it
  if (slide_.followers().empty()) return;
  const double since = t - std::exchange(followers_turned_, t);
  const bool same_place = since < kMoment * span_ && since * slide_.fastest() < kPlace;
  followers_turns_ = same_place ? followers_turns_ + 1 : 0;
  if (followers_turns_ <= kMostTurns) return;
  const std::uint32_t s = slide_.followers().front();
  const network::Switch& follower = program_.switches()[s];
  const std::uint32_t first = program_.switch_structure().members[slide_.followed_by(s)].front();
  throw log_.endless(follower.block,
                     fmt::format("{}, which depends on '{}', which slides along its switching surface",
                                 follower.comparison, program_.switches()[first].block),
                     t);
}

void SwitchSettling::let_touch(std::size_t s) {
  const double error = std::min(event_functions_.last_errors().undamped(s), SlidingMode::drift());
  if (event_functions_.is_known(s) || !(std::abs(event_functions_[s]) <= error)) return;
  event_functions_.thresholds().forget(s);
  event_functions_.thresholds().widen(s, error);
  if (!unrest_[s].touch) unrest_[s].touch = std::abs(event_functions_[s]);
}

void SwitchSettling::restore(std::vector<bool> sliding) {
  resumes_ = true;
  restored_ = std::move(sliding);
  if (restored_.empty()) restored_.assign(event_functions_.size(), true);
}

void SwitchSettling::keep_positions_within_errors() {
  const EventFunctionErrors& errors = event_functions_.weigh_errors();
  kept_.assign(decided_.size(), false);
  for (std::size_t s = 0; s < event_functions_.size(); ++s) {
    const double error = std::min(errors[s], SlidingMode::drift());
    if (event_functions_.is_known(s) || restored_[s] || !(std::abs(event_functions_[s]) <= error)) continue;
    event_functions_.thresholds().widen(s, error);
    if (event_functions_.against(s) > 0) let_touch(s);  // as it has been let lie there
    kept_[program_.switch_structure().unit[s]] = true;
  }
}

}  // namespace oblique::solve
