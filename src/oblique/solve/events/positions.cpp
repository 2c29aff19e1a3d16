// SPDX-License-Identifier: MIT
#include <oblique/solve/events/positions.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/self_consistent.h>

namespace oblique::solve {
namespace {

/// The switch whose position says where a unit prefers to be: one that jumps, where the others only bend.
std::uint32_t deciding_member(const network::Program& program, const network::Evaluation& here,
                              std::uint32_t unit) {
  const auto& members = program.switch_structure().members[unit];
  const auto jumping = std::find_if(members.begin(), members.end(),
                                    [&](std::uint32_t s) { return !switch_only_bends(program, here, s); });
  return jumping != members.end() ? *jumping : members.front();
}

}  // namespace

Positions::Positions(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
                     const Thresholds& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      bends_(program, workspace, span),
      trials_(program, workspace, slide, thresholds, span),
      level_rest_(program, workspace, slide, thresholds, span) {}

/// Sets those apart that only bend where there are no others, or too many for trials. Together with a few
/// others they take part in the trials: they may rest while these slide. The others are left.
std::vector<std::uint32_t> Positions::set_bends_apart(const std::vector<std::uint32_t>& units,
                                                      const std::vector<double>& preferred,
                                                      const network::Evaluation& here) {
  bends_.clear();
  std::vector<bool> bends(units.size());
  for (std::size_t u = 0; u < units.size(); ++u) bends[u] = only_bends(program_, here, units[u]);
  const bool apart = units.size() > kMostUnits || std::find(bends.begin(), bends.end(), false) == bends.end();
  if (!apart) return units;
  std::vector<std::uint32_t> others;
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (bends[u]) {
      bends_.add(units[u], preferred);
    } else {
      others.push_back(units[u]);
    }
  }
  return others;
}

/// The sides on which units stand.
Combination Positions::present_sides(const std::vector<std::uint32_t>& units) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  Combination present = 0;
  for (std::size_t u = 0; u < units.size(); ++u) {
    const std::uint32_t s = structure.members[units[u]].front();
    const bool closed = workspace_.discrete_state(program_.switches()[s].discrete_state) == 1;
    if (closed != structure.opposite[s]) present |= 1U << u;
  }
  return present;
}

bool Positions::choose(const std::vector<std::uint32_t>& units,
                       const std::vector<double>& preferred_positions,
                       const std::vector<std::uint32_t>& may_stop, const network::Evaluation& here, double t,
                       std::span<const double> x) {
  undecided_.clear();
  resting_.clear();
  flat_.clear();
  stopped_.clear();
  const std::vector<std::uint32_t> tried = set_bends_apart(units, preferred_positions, here);
  if (tried.size() > kMostUnits) return false;
  Combination preferred = 0;
  for (std::size_t u = 0; u < tried.size(); ++u) {
    const std::uint32_t s = deciding_member(program_, here, tried[u]);
    if ((preferred_positions[s] == 1) != program_.switch_structure().opposite[s]) preferred |= 1U << u;
  }
  const Combination present = present_sides(tried);
  trials_.run(tried, bends_, t, x);
  auto sides = standing(preferred, true);
  if (!sides) {
    if (slide(present, t, x)) {
      lower_at_zero(t, x);
      return true;
    }
    trials_.take_back();
    sides = standing(preferred, false);
  }
  if (sides && take(*sides, preferred_positions, t, x)) {
    stop(*sides, may_stop, t, x);
    return true;
  }
  trials_.take_back();
  return false;
}

/// The first combination, by how near it is to the preferred one, from which the solution goes where the
/// units stand; with `keeping`, none that turns a unit over that stays at zero.
std::optional<Combination> Positions::standing(Combination preferred, bool keeping) const {
  const bool any_jump = trials_.any_jumps(trials_.combinations() - 1);
  const std::vector<Combination> nearest = nearest_first(preferred, trials_.units().size());
  for (const bool strictly : {true, false}) {
    if (!strictly && any_jump) continue;
    for (const Combination sides : nearest) {
      if ((!keeping || trials_.keeps(sides, preferred)) && trials_.stands(sides, strictly)) return sides;
    }
  }
  return std::nullopt;
}

/// Places all as a combination has them, and notes what else it tells.
bool Positions::take(Combination sides, const std::vector<double>& preferred, double t,
                     std::span<const double> x) {
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    if (trials_.rests(sides, u)) resting_.push_back(trials_.units()[u]);
    if (trials_.is_flat(sides, u)) flat_.push_back(trials_.units()[u]);
    if (trials_.is_undecided(sides, u)) undecided_.push_back(trials_.units()[u]);
  }
  if (!trials_.place(sides, bends_, t, x)) return false;
  resting_.insert(resting_.end(), bends_.resting().begin(), bends_.resting().end());
  for (const std::uint32_t unit : resting_) prefer_where_nothing_changes(unit, preferred, t, x);
  return true;
}

/// Puts the switches of a unit that stays at zero where each prefers to be, which no side of it may be: at
/// zero exactly none of them need hold; what follows from them goes along. But only where nothing changes in
/// that it stays there.
void Positions::prefer_where_nothing_changes(std::uint32_t unit, const std::vector<double>& preferred,
                                             double t, std::span<const double> x) {
  const std::vector<double> positions(workspace_.discrete_states().begin(),
                                      workspace_.discrete_states().end());
  struct Surface {
    std::vector<double> event_functions, rates;
  };
  const auto evaluate = [&]() -> std::optional<Surface> {
    Surface found{std::vector<double>(preferred.size()), std::vector<double>(preferred.size())};
    std::vector<double> derivatives(program_.n_states());
    const auto here = program_.event_functions(t, x.data(), found.event_functions.data(), workspace_);
    if (!here) return std::nullopt;
    here->derivatives(derivatives.data());
    here->event_function_rates(derivatives.data(), found.rates.data());
    return found;
  };
  const auto before = evaluate();
  if (!before) return;
  const auto& members = program_.switch_structure().members[unit];
  for (const std::uint32_t s : members) {
    workspace_.set_discrete_state(program_.switches()[s].discrete_state,
                                  before->event_functions[s] == 0 ? 0 : preferred[s]);
  }
  std::vector<bool> placed = slide_.taken();
  for (const std::uint32_t other : trials_.units()) {
    for (const std::uint32_t s : program_.switch_structure().members[other]) placed[s] = true;
  }
  for (const auto& bend : bends_.positions()) placed[bend.first] = true;
  std::vector<double> event_functions(preferred.size());
  const bool agrees =
      place_others(program_, workspace_, thresholds_, placed, t, x, event_functions).has_value();
  const auto after = agrees ? evaluate() : std::nullopt;
  const bool stays =
      after && std::all_of(members.begin(), members.end(), [&](std::uint32_t s) {
        const double still = std::max(std::abs(before->rates[s]), kRounding * trials_.fastest());
        return after->event_functions[s] == before->event_functions[s] && std::abs(after->rates[s]) <= still;
      });
  if (!stays) workspace_.load_discrete_states(positions);
}

/// Puts the units that stay at zero exactly along with a slide, as what a dead zone gives, where none of
/// their comparisons holds: but not where that would end the slide.
void Positions::lower_at_zero(double t, std::span<const double> x) {
  std::vector<double> event_functions(program_.switches().size());
  if (!program_.event_functions(t, x.data(), event_functions.data(), workspace_)) return;
  const std::vector<double> none(event_functions.size(), 0.0);
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    const std::uint32_t unit = trials_.units()[u];
    const std::uint32_t s = program_.switch_structure().members[unit].front();
    if (!trials_.any_jumps(1U << u) || !slide_.rests(s) || event_functions[s] != 0) continue;
    const std::vector<double> positions(workspace_.discrete_states().begin(),
                                        workspace_.discrete_states().end());
    prefer_where_nothing_changes(unit, none, t, x);
    if (slide_.evaluate(t, x) && slide_.goes_on()) continue;
    workspace_.load_discrete_states(positions);
    slide_.evaluate(t, x);
  }
}

/// Leaves units where they are that move on either side, but stay as long as no comparison holds.
void Positions::stop(Combination sides, const std::vector<std::uint32_t>& may_stop, double t,
                     std::span<const double> x) {
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    const std::uint32_t unit = trials_.units()[u];
    const bool may = std::find(may_stop.begin(), may_stop.end(), unit) != may_stop.end();
    if (!may || trials_.rests(sides, u) || !level_rest_.is_third_position(unit)) continue;
    if (level_rest_.take(unit, trials_.units(), trials_.fastest(), t, x)) stopped_.push_back(unit);
  }
  resting_.insert(resting_.end(), stopped_.begin(), stopped_.end());
}

/// Slides along as few units as possible. To events, what slides stays where it was.
bool Positions::slide(Combination present, double t, std::span<const double> x) {
  const int n = static_cast<int>(trials_.units().size());
  const std::vector<Combination> order = nearest_first(present, trials_.units().size());
  Combination crossing = 0;
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    if (trials_.crosses(u)) crossing |= 1U << u;
  }
  for (int size = 1; size <= n; ++size) {
    for (Combination sliding = 1; sliding < trials_.combinations(); ++sliding) {
      if (std::popcount(sliding) != size || (sliding & crossing) != 0 || !trials_.is_independent(sliding) ||
          !trials_.any_jumps(sliding))
        continue;
      for (const Combination sides : order) {
        if (((sides ^ present) & sliding) == 0 && try_slide(sliding, sides, t, x)) return true;
      }
    }
  }
  return false;
}

/// Slides along some units with the others on their sides.
bool Positions::try_slide(Combination sliding, Combination sides, double t, std::span<const double> x) {
  if (!trials_.place(sides, bends_, t, x)) return false;
  const std::vector<std::uint32_t> before = slide_.units();
  std::vector<std::uint32_t> units, silent;
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    if (!has(sliding, u)) continue;
    if (!trials_.is_at_zero(sides, u)) return false;  // the others have moved its level away
    for (std::size_t corner = 0; corner < trials_.units().size(); ++corner) {
      if (corner == u) continue;
      const SideTrials::AtCorner at = trials_.at_corner(sides, u, corner);
      if (!at.turns) return false;
      silent.insert(silent.end(), at.silent.begin(), at.silent.end());
    }
    units.push_back(trials_.units()[u]);
  }
  if (!slide_.begin(units, silent, t, x)) return false;
  if (fits_slide(sliding, sides)) {
    let_others_rest(t, x);
    return true;
  }
  slide_.keep(before, t, x);
  return false;
}

/// Lets those rest along with a slide that has begun which are at zero with it, though they were decided
/// before: the corner of what a comparator reads.
void Positions::let_others_rest(double t, std::span<const double> x) {
  std::vector<double> event_functions(program_.switches().size());
  if (!program_.event_functions(t, x.data(), event_functions.data(), workspace_)) return;
  for (std::uint32_t s = 0; s < event_functions.size(); ++s) {
    if (slide_.holds(s) || slide_.follows(s) || program_.switches()[s].rate) continue;
    const double near = std::max(thresholds_[s], SlidingMode::drift());
    if (std::abs(event_functions[s]) <= near && slide_.holds_still(s, kNoLaterRate)) slide_.let_rest(s);
  }
}

/// Whether all other units go to their sides while a slide has begun, or stay at zero along with it: these
/// are let rest.
bool Positions::fits_slide(Combination sliding, Combination sides) {
  std::vector<double> rates(program_.switches().size());
  slide_.mixed_rates(rates);
  for (std::size_t u = 0; u < trials_.units().size(); ++u) {
    if (has(sliding, u) || slide_.follows(program_.switch_structure().members[trials_.units()[u]].front()))
      continue;  // placed on each side apart
    if (const int off = trials_.off_zero(sides, u); off != 0) {
      if ((off > 0) != has(sides, u)) return false;
      continue;
    }
    const double rate = trials_.of_unit(rates, u);
    if (std::abs(rate) <= kNoLaterRate * trials_.largest_rate(u)) {
      if (trials_.drives_at_zero(sides, u)) return false;
      for (const std::uint32_t s : program_.switch_structure().members[trials_.units()[u]])
        slide_.let_rest(s);
    } else if ((rate > 0) != has(sides, u)) {
      return false;
    }
  }
  return bends_.rest_with(slide_, rates, trials_.fastest());
}

}  // namespace oblique::solve
