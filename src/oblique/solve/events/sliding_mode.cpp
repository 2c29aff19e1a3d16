// SPDX-License-Identifier: MIT
#include <oblique/solve/events/sliding_mode.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/kept_unknowns.h>
#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/slide_shares.h>

namespace oblique::solve {
namespace {

/// What integration lets an event function drift off is taken back at this rate, times the length of the run,
/// by no more than this part of what the sides do: the shares must not show it.
constexpr double kReturn = 100;
constexpr double kMostReturn = 1e-6;

/// How far beyond 0 and 1 the shares may be where a slide begins: a solution may run along a
/// switching surface by itself.
constexpr double kEdgeOfSlide = 2 * kMostReturn;

bool is_possible_share(double share) {
  return share >= -kEdgeOfSlide && share <= 1 + kEdgeOfSlide;
}

/// How far beyond 0 and 1 the share of a unit is put that both of its sides drive away alike.
constexpr double kOver = 1e-3;

/// How far the states are moved to see whether a slide lasts [machine unit].
constexpr double kSoon = 1e-6;

/// Of the drive of the other side.
constexpr double kDrives = 1e-3;

/// Of the firmest grip that a unit has had: below it the errors of the states, over the grip, move its end.
constexpr double kNoGrip = 1e-4;

constexpr std::size_t kMostUnits = 64;

}  // namespace

SlidingMode::SlidingMode(const network::Program& program, network::Workspace& workspace, EdgeValues& edges,
                         IndependentUnits& independent, double span)
    : program_(program),
      workspace_(workspace),
      edges_(edges),
      independent_(independent),
      span_(span),
      follows_(program.switches().size(), false),
      rests_(program.switches().size(), false),
      silent_(program.switches().size(), false),
      lifted_(program.switches().size(), false),
      sides_(program.switch_structure()),
      strongest_(program.switch_structure().members.size()),
      firmest_(strongest_.size()),
      scratch_(std::max(program.n_states(), program.jacobian_pattern().entries())),
      moved_(program.n_states()) {}

bool SlidingMode::holds(std::size_t s) const {
  return std::find(units_.begin(), units_.end(), program_.switch_structure().unit[s]) != units_.end();
}

std::vector<bool> SlidingMode::taken() const {
  std::vector<bool> taken = follows_;
  for (const std::uint32_t unit : units_) {
    for (const std::uint32_t s : program_.switch_structure().members[unit]) taken[s] = true;
  }
  return taken;
}

bool SlidingMode::mixes(std::size_t loop) const {
  if (!active()) return false;
  const std::vector<bool> below = program_.switch_structure().discrete_states_below_loop(loop);
  const std::vector<bool> taken_switches = taken();
  for (std::size_t s = 0; s < taken_switches.size(); ++s) {
    if (taken_switches[s] && below[program_.switches()[s].discrete_state]) return true;
  }
  return false;
}

void SlidingMode::find_followers() {
  std::fill(follows_.begin(), follows_.end(), false);
  followers_.clear();
  if (!active()) return;
  std::vector<bool> held(follows_.size());
  for (std::size_t s = 0; s < held.size(); ++s) held[s] = holds(s);
  follows_ = program_.switch_structure().followers_of(held);
  for (std::uint32_t s = 0; s < follows_.size(); ++s) {
    follows_[s] = follows_[s] && !held[s];
    if (follows_[s]) followers_.push_back(s);
  }
  segments_.clear();
  for (const std::uint32_t s : followers_) {
    if (const auto event = program_.switches()[s].moves_along)
      segments_.push_back(program_.events()[*event].actions.front().index);
  }
}

/// Whether an event function that has this value may be zero but for the drift of the states: what depends on
/// none, as the drive of an integrator, may be as small.
bool SlidingMode::is_within_drift(const network::Evaluation& here, std::uint32_t s,
                                  double event_function) const {
  constexpr double kLastDigits = 1e-15;  // of what is compared
  if (event_function == 0) return true;
  if (!(std::abs(event_function) <= drift())) return false;
  std::vector<double> off(program_.n_states(), 0.0), rates(program_.switches().size());
  here.event_function_rates(off.data(), rates.data());
  const double still = rates[s];
  double reach = kLastDigits * here.compared_size(s);
  for (std::size_t i = 0; i < off.size() && std::abs(event_function) > reach; ++i) {
    off[i] = drift();
    here.event_function_rates(off.data(), rates.data());
    off[i] = 0;
    reach += std::abs(rates[s] - still);
  }
  return std::abs(event_function) <= reach;
}

/// Puts the units on a side, and what follows them where its event functions then are. Of one that is at zero
/// on the switching surface, no further off than the states drift from that, none need hold unless it is
/// lifted.
bool SlidingMode::settle(SlideSide& side, double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  side.unknowns.clear();  // they may be those of before a jump
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const bool above = (side.bits >> u & 1U) != 0;
    for (const std::uint32_t s : structure.members[units_[u]])
      workspace_.set_discrete_state(program_.switches()[s].discrete_state,
                                    above != structure.opposite[s] && !silent_[s] ? 1 : 0);
  }
  side.event_functions.resize(program_.switches().size());
  const std::size_t most = 2 * followers_.size() + 2;
  bool settled = followers_.empty();
  for (std::size_t round = 0; !settled; ++round) {
    if (round > most) return false;
    const auto here = program_.event_functions(t, x.data(), side.event_functions.data(), workspace_);
    if (!here) return false;
    settled = true;
    side.follower_rests.clear();
    for (const std::uint32_t s : followers_)
      side.follower_rests.push_back(is_within_drift(*here, s, side.event_functions[s]));
    for (std::size_t f = 0; f < followers_.size(); ++f) {
      const std::uint32_t s = followers_[f];
      const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
      const bool holds = side.follower_rests[f] ? lifted_[s] : side.event_functions[s] > 0;
      const double position = holds ? 1 : 0;
      settled = settled && workspace_.discrete_state(discrete_state) == position;
      workspace_.set_discrete_state(discrete_state, position);
    }
    if (settled && !move_tables_along(t, x, settled)) return false;
  }
  side.positions.clear();
  const auto keep = [&](std::uint32_t s) {
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    side.positions.emplace_back(discrete_state, workspace_.discrete_state(discrete_state));
  };
  for (const std::uint32_t unit : units_) {
    for (const std::uint32_t s : structure.members[unit]) keep(s);
  }
  for (const std::uint32_t s : followers_) keep(s);
  for (const std::uint32_t segment : segments_)
    side.positions.emplace_back(segment, workspace_.discrete_state(segment));
  return true;
}

/// Moves the tables on whose ends followers stand to their next segments; `still` where there are none. False
/// where a loop has no solution.
bool SlidingMode::move_tables_along(double t, std::span<const double> x, bool& still) {
  std::vector<std::pair<std::uint32_t, double>> moved;
  for (const std::uint32_t s : followers_) {
    const network::Switch& follower = program_.switches()[s];
    if (!follower.moves_along || workspace_.discrete_state(follower.discrete_state) == 0) continue;
    signals_.resize(program_.n_signals());
    const auto here = program_.signals(t, x.data(), signals_.data(), workspace_);
    if (!here) return false;
    const auto segment = program_.events()[*follower.moves_along].actions.front().index;
    moved.emplace_back(segment, here->action_value(*follower.moves_along, 0));
  }
  for (const auto& [segment, to] : moved) workspace_.set_discrete_state(segment, to);
  still = moved.empty();
  return true;
}

void SlidingMode::load(const SlideSide& side) {
  for (const auto& [discrete_state, position] : side.positions)
    workspace_.set_discrete_state(discrete_state, position);
  for (std::size_t u = 0; u < side.unknowns.size(); ++u) workspace_.set_unknown(u, side.unknowns[u]);
}

void SlidingMode::load_base() {
  for (const auto& [discrete_state, position] : base_)
    workspace_.set_discrete_state(discrete_state, position);
}

void SlidingMode::put_at_rest(bool rests) {
  if (!active()) return;
  load_base();
  for (std::size_t u = 0; rests && u < units_.size(); ++u) {
    const auto above = rests_above(u);
    for (const std::uint32_t s : program_.switch_structure().members[units_[u]]) {
      if (above)
        workspace_.set_discrete_state(program_.switches()[s].discrete_state,
                                      *above != program_.switch_structure().opposite[s] ? 1 : 0);
    }
  }
}

bool SlidingMode::settle_sides(double t, std::span<const double> x) {
  return std::all_of(sides_.begin(), sides_.end(), [&](SlideSide& side) { return settle(side, t, x); });
}

bool SlidingMode::begin(const std::vector<std::uint32_t>& units, const std::vector<std::uint32_t>& silent,
                        double t, std::span<const double> x) {
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  const Kept kept{units_, shares_, rests_, silent_};
  Kept going = kept;
  for (const std::uint32_t s : silent) going.silent[s] = true;
  std::vector<std::uint32_t> all = units_;
  all.insert(all.end(), units.begin(), units.end());
  bool begins = all.size() <= kMostUnits && make(all, going, t, x) && attracts(t, x);
  if (!begins && lift_followers()) {
    workspace_.load_discrete_states(before);
    begins = make(std::move(all), going, t, x) && attracts(t, x);
  }
  if (begins) {
    load_base();
    for (std::size_t u = 0; u < units_.size(); ++u) {
      if (const auto above = rests_above(u)) show(u, *above);
    }
    slides_on_.assign(units_.size(), true);
    return true;
  }
  end();
  workspace_.load_discrete_states(before);
  resume(kept, t, x);
  return false;
}

/// Whether an event reads a unit or what follows it.
bool SlidingMode::is_seen(std::size_t unit) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  const auto& members = structure.members[units_[unit]];
  return std::any_of(members.begin(), members.end(),
                     [&](std::uint32_t s) { return structure.read_by_events[s]; }) ||
         std::any_of(followers_.begin(), followers_.end(), [&](std::uint32_t s) {
           return structure.read_by_events[s] && followed_by(s) == units_[unit];
         });
}

void SlidingMode::show(std::size_t unit, bool above) {
  if (!is_seen(unit)) return;
  const auto &upper = upper_side(unit).positions, &lower = sides_[0].positions;
  for (std::size_t k = 0; k < upper.size(); ++k) {
    if (upper[k].second == lower[k].second) continue;  // of what this unit does not act on
    const auto shown = std::find_if(base_.begin(), base_.end(),
                                    [&](const auto& setting) { return setting.first == upper[k].first; });
    shown->second = (above ? upper : lower)[k].second;
  }
  load_base();
}

/// Makes the sides of these units and of what follows them, with the shares of those that slide already.
/// False where there are too many, or nothing agrees.
bool SlidingMode::make(std::vector<std::uint32_t> units, const Kept& kept, double t,
                       std::span<const double> x) {
  std::sort(units.begin(), units.end());
  units_ = std::move(units);
  parts_ = independent_.parts_of(units_);
  rests_ = kept.rests;
  silent_ = kept.silent;
  find_followers();
  sides_.make(units_, followers_.empty() ? std::vector<std::vector<std::size_t>>() : parts_);
  base_.clear();
  for (std::uint32_t s = 0; s < follows_.size(); ++s) {
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    if (holds(s) || follows_[s])
      base_.emplace_back(discrete_state, silent_[s] ? 0 : workspace_.discrete_state(discrete_state));
  }
  for (const std::uint32_t segment : segments_)
    base_.emplace_back(segment, workspace_.discrete_state(segment));
  const Breaks broken = find_breaks(program_, units_);
  bends_ = broken.by_followers;
  may_jump_.assign(units_.size(), false);
  slides_on_.assign(units_.size(), false);
  shares_.assign(units_.size(), 0.5);
  drives_of_coupled_.assign(units_.size(), 0.0);
  bool possible = sides_.are_all() && settle_sides(t, x);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    may_jump_[u] = broken.by_others[u] != 0 || bends_[u];
    possible = possible && !broken.by_itself[u];
    const auto before = std::find(kept.units.begin(), kept.units.end(), units_[u]);
    if (before == kept.units.end()) continue;
    slides_on_[u] = true;
    shares_[u] = kept.shares[static_cast<std::size_t>(before - kept.units.begin())];
  }
  return possible;
}

bool SlidingMode::goes_on() const {
  return std::all_of(shares_.begin(), shares_.end(), is_possible_share);
}

/// Whether the units that are about to slide do, now and a moment later.
bool SlidingMode::attracts(double t, std::span<const double> x) {
  if (!evaluate(t, x) || largest_jump().value_or(0) > 0) return false;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!slides_on_[u] && !is_possible_share(shares_[u])) return false;
  }
  if (!lasts(t, x)) return false;
  std::vector<double> mixed(follows_.size());
  mixed_rates(mixed);
  for (const std::uint32_t s : followers_) {
    if (lifted_[s] && !(mixed[s] > 0)) return false;
  }
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!slides_on_[u] && repulsion(u).value_or(0) > kNoRepulsion) return false;
  }
  return true;
}

/// Lifts the followers that are at zero on a side, where they do not hold, but which that side drives up;
/// whether there are any. There they have slid themselves, until what is to slide now has moved their level
/// away on its other side.
bool SlidingMode::lift_followers() {
  bool any = false;
  for (const SlideSide& side : sides_) {
    for (std::size_t f = 0; f < side.follower_rests.size() && !side.rates.empty(); ++f) {
      const std::uint32_t s = followers_[f];
      if (!side.follower_rests[f] || lifted_[s] || !(side.rates[s] > 0)) continue;
      lifted_[s] = true;
      any = true;
    }
  }
  return any;
}

void SlidingMode::end() {
  if (active()) load_base();
  units_.clear();
  parts_.clear();
  slides_on_.clear();
  may_jump_.clear();
  bends_.clear();
  followers_.clear();
  segments_.clear();
  std::fill(follows_.begin(), follows_.end(), false);
  std::fill(rests_.begin(), rests_.end(), false);
  std::fill(silent_.begin(), silent_.end(), false);
  std::fill(lifted_.begin(), lifted_.end(), false);
  sides_.clear();
  shares_.clear();
}

void SlidingMode::keep(const std::vector<std::uint32_t>& kept, double t, std::span<const double> x) {
  if (kept.size() == units_.size()) return;
  Kept going{kept, {}, rests_, silent_};
  for (const std::uint32_t unit : kept)
    going.shares.push_back(
        shares_[static_cast<std::size_t>(std::find(units_.begin(), units_.end(), unit) - units_.begin())]);
  for (std::size_t s = 0; s < rests_.size(); ++s) {
    const std::uint32_t unit = program_.switch_structure().unit[s];
    going.rests[s] = rests_[s] && std::any_of(kept.begin(), kept.end(), [&](std::uint32_t other) {
                       return !independent_.are(unit, other);
                     });
  }
  end();
  resume(going, t, x);
}

/// Slides on as it did; no more where nothing agrees.
void SlidingMode::resume(const Kept& kept, double t, std::span<const double> x) {
  if (kept.units.empty()) return;
  if (!make(kept.units, kept, t, x) || !evaluate(t, x)) end();
}

bool SlidingMode::evaluate(SlideSide& side, double t, std::span<const double> x) {
  load(side);
  side.dxdt.resize(program_.n_states());
  side.event_functions.resize(follows_.size());
  side.rates.resize(follows_.size());
  auto here = program_.event_functions(t, x.data(), side.event_functions.data(), workspace_);
  if (!here) return false;
  here->derivatives(side.dxdt.data());
  if (edges_.complete_derivatives(t, x.data(), side.dxdt))
    here = program_.event_functions(t, x.data(), side.event_functions.data(), workspace_);
  if (!here) return false;
  here->event_function_rates(side.dxdt.data(), side.rates.data());
  side.unknowns.resize(program_.unknowns().size());
  for (std::size_t u = 0; u < side.unknowns.size(); ++u) side.unknowns[u] = workspace_.unknown(u);
  return true;
}

/// Of event functions that bend at their own switching surface, by what follows (a signal that is let through
/// or not), the rates on all sides by the gradient of the first: of mixed ones the event function would not
/// stay.
bool SlidingMode::take_common_rates(double t, std::span<const double> x) {
  if (std::find(bends_.begin(), bends_.end(), true) == bends_.end()) return true;
  load(sides_[0]);
  std::vector<double> values(follows_.size()), rates(follows_.size());
  const auto here = program_.event_functions(t, x.data(), values.data(), workspace_);
  if (!here) return false;
  for (SlideSide& side : sides_) {
    here->event_function_rates(side.dxdt.data(), rates.data());
    for (std::size_t u = 0; u < units_.size(); ++u) {
      if (!bends_[u]) continue;
      for (const std::uint32_t s : program_.switch_structure().members[units_[u]]) side.rates[s] = rates[s];
    }
  }
  return true;
}

bool SlidingMode::evaluate(double t, std::span<const double> x, bool takes_back) {
  bool valid = true;
  for (SlideSide& side : sides_) valid = valid && evaluate(side, t, x);
  valid = valid && take_common_rates(t, x) && find_shares(takes_back ? kMostReturn : 0);
  if (valid) find_drives_of_coupled();
  load_base();
  for (std::size_t u = 0; valid && u < units_.size(); ++u) {
    double& strongest = strongest_[units_[u]];
    double& firmest = firmest_[units_[u]];
    strongest = std::max(strongest, std::abs(drive_apart(u)));
    firmest = std::max(firmest, grip(u).value_or(0));
  }
  return valid;
}

double SlidingMode::Drives::weaker() const {
  return std::min(std::abs(above), std::abs(below));
}

double SlidingMode::Drives::stronger() const {
  return std::max(std::abs(above), std::abs(below));
}

/// The side on which this unit alone is above.
const SlideSide& SlidingMode::upper_side(std::size_t unit) const {
  return *std::find_if(sides_.begin(), sides_.end(),
                       [&](const SlideSide& side) { return side.bits == std::uint64_t{1} << unit; });
}

/// The same; nothing of one that is coupled.
const SlideSide* SlidingMode::upper_side_alone(std::size_t unit) const {
  return sides_.is_coupled(unit) ? nullptr : &upper_side(unit);
}

SlidingMode::Drives SlidingMode::drives(std::size_t unit) const {
  const SlideSide* const upper = upper_side_alone(unit);
  if (upper == nullptr) return {};
  return {sides_.of_unit(upper->rates, unit), sides_.of_unit(sides_[0].rates, unit)};
}

/// How much more the upper side of a unit drives up than its lower one, the others of one that is coupled
/// going along; nothing of one of which both drive alike: that decides where it goes.
double SlidingMode::drive_apart(std::size_t unit) const {
  if (sides_.is_coupled(unit)) return drives_of_coupled_[unit];
  const Drives sides = drives(unit);
  return std::abs(sides.apart()) > kDrives * sides.stronger() ? sides.apart() : 0;
}

/// How much the event function of a unit is moved by what its sides differ by, over the fastest state of
/// that; nothing of one that is coupled, or whose sides do not differ.
std::optional<double> SlidingMode::grip(std::size_t unit) const {
  const SlideSide* const upper = upper_side_alone(unit);
  if (upper == nullptr) return std::nullopt;
  double fastest = 0;
  for (std::size_t i = 0; i < upper->dxdt.size(); ++i)
    fastest = std::max(fastest, std::abs(upper->dxdt[i] - sides_[0].dxdt[i]));
  if (!(fastest > 0)) return std::nullopt;
  return std::abs(drives(unit).apart()) / fastest;
}

bool SlidingMode::is_held(std::size_t unit) const {
  const Drives sides = drives(unit);
  return sides.above < 0 && sides.below > 0 && sides.weaker() > kDrives * strongest_[units_[unit]];
}

std::optional<bool> SlidingMode::rests_above(std::size_t unit) const {
  const Drives sides = drives(unit);
  if (!(sides.weaker() <= kNoDrive * sides.stronger()) || sides.stronger() == 0) return std::nullopt;
  return std::abs(sides.above) < std::abs(sides.below);
}

bool SlidingMode::comes_back(std::size_t unit, std::size_t state, double t, std::span<const double> x) {
  constexpr double kBeside = 1e-6;  // [machine unit]
  const auto above = rests_above(unit);
  if (!above) return false;
  SlideSide side = *above ? upper_side(unit) : sides_[0];
  std::vector<double> beside(x.begin(), x.end());
  bool back = false;
  for (const double by : {kBeside, -kBeside}) {
    beside[state] = x[state] + by;
    if (!evaluate(side, t, beside)) continue;
    const double there = sides_.of_unit(side.event_functions, unit), rate = sides_.of_unit(side.rates, unit);
    back = back || (*above ? there > 0 && rate < 0 : there < 0 && rate > 0);
  }
  load_base();
  return back;
}

SlidingMode::Doubt SlidingMode::doubt(std::size_t unit) const {
  const Drives sides = drives(unit);
  const bool is_let_go = repulsion(unit).value_or(-1) > -kNoDrive;
  if (is_let_go && sides_.is_coupled(unit)) return Doubt::of_side;
  const bool other_drives = sides.weaker() > kDrives * sides.stronger();
  if (is_let_go && other_drives && !(sides.above < 0) && !(sides.below > 0)) return Doubt::of_side;
  const std::optional<double> firmness = grip(unit);
  if (firmness && *firmness < kNoGrip * firmest_[units_[unit]]) return Doubt::of_time;
  return is_let_go && !other_drives ? Doubt::of_whether : Doubt::none;
}

std::optional<double> SlidingMode::repulsion(std::size_t unit) const {
  const double strongest = strongest_[units_[unit]];
  if (!(strongest > 0)) return std::nullopt;
  const double apart = drive_apart(unit);
  if (apart == 0) return std::nullopt;
  const double part = apart / strongest;
  return part > kNoDrive ? part : std::min(part, 0.0);
}

/// The shares with which no event function moves, but on its way back by so much of what the sides do.
bool SlidingMode::find_shares(double most_back) {
  for (const std::vector<std::size_t>& part : parts_) {
    if (part.size() == 1) {
      if (!find_only_share(part.front(), most_back)) return false;
      continue;
    }
    auto found = shares_of_coupled(sides_, shares_, part, kReturn / span_, most_back);
    if (!found) return false;
    shares_ = std::move(*found);
  }
  sides_.weigh(shares_);
  return true;
}

void SlidingMode::find_drives_of_coupled() {
  drives_of_coupled_.assign(units_.size(), 0.0);
  for (const std::vector<std::size_t>& part : parts_) {
    if (!std::any_of(part.begin(), part.end(), [&](std::size_t u) { return sides_.is_coupled(u); })) continue;
    const std::vector<double> drives = drives_apart_of_coupled(sides_, shares_, part);
    for (std::size_t k = 0; k < part.size(); ++k) drives_of_coupled_[part[k]] = drives[k];
  }
}

/// That of a unit on which no other one acts.
bool SlidingMode::find_only_share(std::size_t unit, double most_back) {
  const double below = sides_.of_unit(sides_[0].rates, unit);
  const double above = sides_.of_unit(upper_side(unit).rates, unit);
  if (!std::isfinite(below - above)) return false;
  if (below == above) {  // none begins there
    // A slide stays as it was where its sides say nothing, and is over where both drive away.
    if (std::abs(below) > kNoDrive * strongest_[units_[unit]]) shares_[unit] = below > 0 ? 1 + kOver : -kOver;
    return slides_on_[unit];
  }
  shares_[unit] =
      (below + oblique::solve::way_back(sides_, unit, kReturn / span_, most_back * std::abs(below - above))) /
      (below - above);
  // Where the sides hardly drive any more the way back says nothing; what follows is told by `repulsion`.
  if (std::abs(below - above) < kNoDrive * strongest_[units_[unit]])
    shares_[unit] = std::clamp(shares_[unit], 0.0, 1.0);
  return true;
}

/// Whether the shares of what is about to slide are about the same a moment later: those of an event function
/// that merely stands still at this one instant are not, however short the moment is.
bool SlidingMode::lasts(double t, std::span<const double> x) {
  constexpr double kJump = 0.01, kShorter = 0.01;
  constexpr int kMoments = 4;
  const std::vector<double> now = shares_;
  std::vector<double> rates(x.size(), 0.0);
  double fastest = std::numeric_limits<double>::min();
  for (const SlideSide& side : sides_) {
    for (std::size_t i = 0; i < rates.size(); ++i) rates[i] += side.weight * side.dxdt[i];
  }
  for (const double rate : rates) fastest = std::max(fastest, std::abs(rate));
  std::vector<std::vector<double>> unknowns;
  for (const SlideSide& side : sides_) unknowns.push_back(side.unknowns);
  const auto stays = [&](double dt) {
    for (std::size_t i = 0; i < rates.size(); ++i) moved_[i] = x[i] + dt * rates[i];
    const KeptUnknowns kept(program_, workspace_);
    bool same = evaluate(t + dt, moved_) && !(largest_jump().value_or(0) > 0);
    for (std::size_t u = 0; same && u < now.size(); ++u)
      same = slides_on_[u] || std::abs(shares_[u] - now[u]) < kJump;
    shares_ = now;
    std::size_t number = 0;
    for (SlideSide& side : sides_) side.unknowns = unknowns[number++];
    return same;
  };
  // Where no state moves a moment is long beside what the time may drive.
  const bool at_rest = kSoon * span_ < kSoon / fastest;
  double dt = at_rest ? kSoon * span_ : kSoon / fastest;
  bool lasting = stays(dt);
  for (int k = 1; at_rest && !lasting && k < kMoments; ++k) lasting = stays(dt *= kShorter);
  return evaluate(t, x) && lasting;
}

std::optional<double> SlidingMode::largest_jump() const {
  if (std::find(may_jump_.begin(), may_jump_.end(), true) == may_jump_.end()) return std::nullopt;
  double off = 0, largest = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    double lowest = std::numeric_limits<double>::infinity(), highest = -lowest, nearest = lowest;
    for (const SlideSide& side : sides_) {
      const double value = sides_.of_unit(side.event_functions, u);
      lowest = std::min(lowest, value);
      highest = std::max(highest, value);
      nearest = std::min(nearest, std::abs(value));
    }
    off = std::max(off, nearest);
    if (may_jump_[u]) largest = std::max(largest, highest - lowest);
  }
  return largest - no_jump(off);
}

void SlidingMode::mixed_rates(std::span<double> rates) const {
  std::fill(rates.begin(), rates.end(), 0.0);
  for (const SlideSide& side : sides_) {
    for (std::size_t s = 0; s < rates.size(); ++s) rates[s] += side.weight * side.rates[s];
  }
}

bool SlidingMode::holds_still(std::size_t s, double part) const {
  double mixed = 0, largest = 0;
  for (const SlideSide& side : sides_) {
    mixed += side.weight * side.rates[s];
    largest = std::max(largest, std::abs(side.rates[s]));
  }
  return largest > 0 && std::abs(mixed) <= part * largest;
}

double SlidingMode::fastest() const {
  double largest = 0;
  for (std::size_t i = 0; i < program_.n_states(); ++i) {
    double rate = 0;
    for (const SlideSide& side : sides_) rate += side.weight * side.dxdt[i];
    largest = std::max(largest, std::abs(rate));
  }
  return largest;
}

double SlidingMode::crossed(std::size_t side, std::size_t follower) const {
  const SlideSide& at = sides_[side];
  const std::size_t s = followers_[follower];
  const std::size_t first = at.positions.size() - segments_.size() - followers_.size();
  const double position = at.positions[first + follower].second;
  const double against = position == 1 ? -at.event_functions[s] : at.event_functions[s];
  return at.follower_rests[follower] ? against - drift() : against;
}

bool SlidingMode::is_torn(std::size_t s) const {
  const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
  const auto position_on = [&](const SlideSide& side) {
    const auto found = std::find_if(side.positions.begin(), side.positions.end(),
                                    [&](const auto& setting) { return setting.first == discrete_state; });
    return found->second;
  };
  return std::any_of(sides_.begin(), sides_.end(),
                     [&](const SlideSide& side) { return position_on(side) != position_on(sides_[0]); });
}

std::uint32_t SlidingMode::followed_by(std::size_t s) const {
  const std::uint32_t follower = program_.switch_structure().unit[s];
  return *std::find_if(units_.begin(), units_.end(),
                       [&](std::uint32_t unit) { return independent_.acts(unit, follower); });
}

std::optional<std::pair<std::uint32_t, std::uint32_t>> SlidingMode::act_together() const {
  constexpr double kSum = 1e-12;  // of dx/dt on the sides: what rounding leaves of a sum
  const auto at = [&](std::uint64_t bits) {
    return std::find_if(sides_.begin(), sides_.end(),
                        [&](const SlideSide& side) { return side.bits == bits; });
  };
  for (std::size_t u = 0; u < units_.size(); ++u) {
    for (std::size_t v = 0; v < u; ++v) {
      const std::uint64_t bit_u = std::uint64_t{1} << u, bit_v = std::uint64_t{1} << v;
      const auto both = at(bit_u | bit_v), one = at(bit_u), other = at(bit_v);
      if (both == sides_.end()) continue;
      for (std::size_t i = 0; i < program_.n_states(); ++i) {
        const double a = both->dxdt[i], b = sides_[0].dxdt[i], c = one->dxdt[i], d = other->dxdt[i];
        const double size = std::abs(a) + std::abs(b) + std::abs(c) + std::abs(d);
        if (std::abs(a + b - c - d) > kSum * size) return std::pair(units_[v], units_[u]);
      }
    }
  }
  return std::nullopt;
}

bool SlidingMode::turns_along(std::uint32_t s) const {
  constexpr double kStill = 1e-5;  // of what the sides do: ten times the way back of what slides
  if (!active() || !rests_[s] || holds(s) || follows_[s] ||
      program_.switches()[s].turning != network::Turning::jumps || !holds_still(s, kStill) ||
      is_masked(program_.switch_structure().masks[s], workspace_.discrete_states()))
    return false;
  const auto up = [s](const SlideSide& side) { return side.rates[s] > 0; };
  const auto down = [s](const SlideSide& side) { return side.rates[s] < 0; };
  return std::any_of(sides_.begin(), sides_.end(), up) && std::any_of(sides_.begin(), sides_.end(), down);
}

bool SlidingMode::derivatives(double t, const double* x, double* dxdt) {
  if (!evaluate(t, {x, program_.n_states()}, !leaves_)) return false;
  std::fill(dxdt, dxdt + program_.n_states(), 0.0);
  for (const SlideSide& side : sides_) {
    for (std::size_t i = 0; i < program_.n_states(); ++i) dxdt[i] += side.weight * side.dxdt[i];
  }
  return true;
}

bool SlidingMode::way_back(double t, const double* x, double h, double* change) {
  constexpr double kAnyRate = std::numeric_limits<double>::infinity();  // no shares show it
  if (!leaves_ || !evaluate(t, {x, program_.n_states()}, false)) return false;
  std::vector<double> weights;
  for (const SlideSide& side : sides_) weights.push_back(side.weight);
  if (!find_shares(kAnyRate)) return false;
  const double whole = std::min(h, span_ / kReturn);  // at most the whole way
  std::fill(change, change + program_.n_states(), 0.0);
  for (std::size_t k = 0; k < sides_.size(); ++k) {
    const SlideSide& side = sides_[k];
    for (std::size_t i = 0; i < program_.n_states(); ++i)
      change[i] += whole * (side.weight - weights[k]) * side.dxdt[i];
  }
  return true;
}

/// Of the mixture with its shares held: enough for Newton's method.
bool SlidingMode::jacobian(double t, const double* x, double* values) {
  if (!evaluate(t, {x, program_.n_states()})) return false;
  const std::size_t entries = program_.jacobian_pattern().entries();
  std::fill(values, values + entries, 0.0);
  bool valid = true;
  for (const SlideSide& side : sides_) {
    load(side);
    valid = valid && program_.jacobian(t, x, scratch_.data(), workspace_);
    if (valid) edges_.complete_jacobian(t, x, std::span(scratch_).first(entries));
    for (std::size_t k = 0; k < entries; ++k) values[k] += side.weight * scratch_[k];
  }
  load_base();
  return valid;
}

bool SlidingMode::signals(double t, const double* x, double* values) {
  if (!evaluate(t, {x, program_.n_states()})) return false;
  std::vector<double> shares = shares_;
  for (double& share : shares) share = std::clamp(share, 0.0, 1.0);
  sides_.weigh(shares);
  std::vector<double> of_side(program_.n_signals());
  std::fill(values, values + program_.n_signals(), 0.0);
  bool valid = true;
  for (const SlideSide& side : sides_) {
    load(side);
    valid = valid && program_.signals(t, x, of_side.data(), workspace_);
    if (valid) edges_.complete_signals(t, x, of_side);
    for (std::size_t i = 0; i < of_side.size(); ++i) values[i] += side.weight * of_side[i];
  }
  load_base();
  return valid;
}

}  // namespace oblique::solve
