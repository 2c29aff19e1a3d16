// SPDX-License-Identifier: MIT
#include <oblique/solve/events/side_trials.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/position_limits.h>
#include <oblique/solve/events/self_consistent.h>
#include <oblique/solve/events/slide_sides.h>
#include <oblique/solve/events/sliding_mode.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostTrials = 3;  ///< of bends and others that follow each other

}  // namespace

SideTrials::SideTrials(const network::Program& program, network::Workspace& workspace,
                       const SlidingMode& slide, const Thresholds& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      span_(span),
      probe_(program, workspace, span),
      event_functions_(program.switches().size()) {}

void SideTrials::run(std::vector<std::uint32_t> units, Bends& bends, double t, std::span<const double> x) {
  units_ = std::move(units);
  before_.assign(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  unknowns_.clear();
  for (std::size_t u = 0; u < program_.unknowns().size(); ++u) unknowns_.push_back(workspace_.unknown(u));
  event_functions_before_.resize(event_functions_.size());
  if (!program_.event_functions(t, x.data(), event_functions_before_.data(), workspace_))
    event_functions_before_.assign(event_functions_.size(), 0);
  fastest_ = 0;
  trials_.clear();
  for (Combination sides = 0; sides < combinations(); ++sides) trials_.push_back(attempt(sides, bends, t, x));
  find_scales();
  find_broken();
}

void SideTrials::take_back() {
  workspace_.load_discrete_states(before_);
  for (std::size_t u = 0; u < unknowns_.size(); ++u) workspace_.set_unknown(u, unknowns_[u]);
}

/// Where an event function jumps with the position of another unit, or with those that follow its own, but by
/// nothing here, it is not broken by that: a level that a product with zero makes, say.
void SideTrials::find_broken() {
  const Breaks broken = find_breaks(program_, units_);
  broken_by_ = broken.by_others;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (broken.by_itself[u] || broken.by_followers[u]) broken_by_[u] |= std::uint64_t{1} << u;
  }
  double off = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const auto& trial : trials_) {
      if (trial) nearest = std::min(nearest, std::abs(trial->event_functions[u]));
    }
    off = std::max(off, nearest);
  }
  for (std::size_t u = 0; u < units_.size(); ++u) {
    for (std::size_t v = 0; v < units_.size(); ++v) {
      if ((u != v || !broken.by_itself[u]) && largest_jump(u, v) <= no_jump(off))
        broken_by_[u] &= ~(std::uint64_t{1} << v);
    }
  }
}

/// By how much the event function of a unit jumps at most with the position of another.
double SideTrials::largest_jump(std::size_t unit, std::size_t with) const {
  double largest = 0;
  for (Combination sides = 0; sides < combinations(); ++sides) {
    const auto &here = trials_[sides], &there = trials_[sides ^ (1U << with)];
    if (!here || !there) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::abs(here->event_functions[unit] - there->event_functions[unit]));
  }
  return largest;
}

double SideTrials::of_unit(const std::vector<double>& of_switches, std::size_t unit) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::uint32_t s = structure.members[units_[unit]].front();
  return structure.opposite[s] ? -of_switches[s] : of_switches[s];
}

std::optional<network::Evaluation> SideTrials::place(Combination sides, Bends& bends, double t,
                                                     std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  take_back();
  std::vector<bool> placed = slide_.taken();
  const auto put = [&](std::uint32_t s, double position) {
    placed[s] = true;
    workspace_.set_discrete_state(program_.switches()[s].discrete_state, position);
  };
  for (std::size_t u = 0; u < units_.size(); ++u) {
    for (const std::uint32_t s : structure.members[units_[u]])
      put(s, has(sides, u) != structure.opposite[s] ? 1 : 0);
  }
  for (const auto& [s, position] : bends.positions()) put(s, position);
  auto here = place_others(program_, workspace_, thresholds_, placed, t, x, event_functions_);
  if (here && lower_what_came_to_zero(placed))
    here = place_others(program_, workspace_, thresholds_, placed, t, x, event_functions_);
  if (!bends.any()) return here;
  // Within rounding the others may have gone where the bends have no reason to be: they begin anew by these.
  std::vector<double> bent, followed;
  const auto positions_of = [&](std::vector<double>& of_bends) {
    of_bends.clear();
    for (const auto& bend : bends.positions())
      of_bends.push_back(workspace_.discrete_state(program_.switches()[bend.first].discrete_state));
  };
  for (std::size_t round = 0; here; ++round) {
    positions_of(bent);
    here = bends.follow(*here, t, x, event_functions_);
    positions_of(followed);
    if (!here || followed == bent || round > kMostTrials) return here;
    for (std::uint32_t s = 0; s < placed.size(); ++s) {
      const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
      if (!placed[s]) workspace_.set_discrete_state(discrete_state, before_[discrete_state]);
    }
    here = place_others(program_, workspace_, thresholds_, placed, t, x, event_functions_);
  }
  return here;
}

/// What the units' sides have put on zero is not above it, as in a slide; whether any was.
bool SideTrials::lower_what_came_to_zero(const std::vector<bool>& placed) {
  bool any = false;
  for (std::size_t s = 0; s < placed.size(); ++s) {
    const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
    const bool came =
        std::abs(event_functions_[s]) <= thresholds_[s] && event_functions_before_[s] > thresholds_[s];
    if (placed[s] || program_.switches()[s].rate || !came || workspace_.discrete_state(discrete_state) == 0)
      continue;
    workspace_.set_discrete_state(discrete_state, 0);
    any = true;
  }
  return any;
}

std::optional<SideTrials::Trial> SideTrials::attempt(Combination sides, Bends& bends, double t,
                                                     std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  const auto here = place(sides, bends, t, x);
  if (!here) return std::nullopt;
  std::vector<std::uint32_t> switches;
  for (const std::uint32_t unit : units_) switches.push_back(structure.members[unit].front());
  probe_.begin(*here, 0);
  fastest_ = std::max(fastest_, probe_.fastest());
  if (!probe_.look(switches, t, x)) return std::nullopt;
  Trial trial;
  for (const std::uint32_t s : switches) {
    const double sign = structure.opposite[s] ? -1 : 1;
    const ProbedRate probed = probe_[s];
    trial.event_functions.push_back(sign * event_functions_[s]);
    trial.rates.push_back({sign * probed.rate, sign * probed.later, probed.step, probed.noise});
  }
  return trial;
}

void SideTrials::find_scales() {
  scales_.assign(units_.size(), {kRounding * fastest_, 0, fastest_, span_});
  for (const auto& trial : trials_) {
    for (std::size_t u = 0; trial && u < units_.size(); ++u) {
      scales_[u].rate = std::max(scales_[u].rate, std::abs(trial->rates[u].rate));
      scales_[u].later = std::max(scales_[u].later, std::abs(trial->rates[u].later));
    }
  }
}

int SideTrials::off_zero(Combination sides, std::size_t unit) const {
  if (!trials_[sides]) return 0;
  const std::uint32_t s = program_.switch_structure().members[units_[unit]].front();
  const double event_function = trials_[sides]->event_functions[unit];
  const bool off = std::abs(event_function) > std::max(thresholds_[s], SlidingMode::drift());
  return !off ? 0 : event_function > 0 ? 1 : -1;
}

bool SideTrials::is_at_zero(Combination sides, std::size_t unit) const {
  const Combination other = sides ^ (1U << unit);
  return trials_[sides] && trials_[other] && off_zero(sides, unit) == 0 && off_zero(other, unit) == 0;
}

SideTrials::AtCorner SideTrials::at_corner(Combination sides, std::size_t unit, std::size_t corner) const {
  constexpr double kSame = 1e-9;  // of the rates: what follows the other alone moves with it in all trials
  bool above = false, below = false, flat = false;
  for (const bool upper : {false, true}) {
    const Combination there = upper ? sides | 1U << corner : sides & ~(1U << corner);
    if (!trials_[there] || !trials_[there ^ (1U << unit)]) return {};
    double moved = 0, slope = 0;
    for (Combination other = 0; other < combinations(); ++other) {
      if (((other >> corner & 1U) != 0) != upper || !trials_[other]) continue;
      const double rate = trials_[other]->rates[corner].rate;
      if (!(std::abs(rate) > moved)) continue;
      moved = std::abs(rate);
      slope = trials_[other]->rates[unit].rate / rate;
    }
    if (moved == 0) return {};
    for (Combination other = 0; other < combinations(); ++other) {
      if (((other >> corner & 1U) != 0) != upper || !trials_[other]) continue;
      const double own = trials_[other]->rates[unit].rate, with = slope * trials_[other]->rates[corner].rate;
      if (!(std::abs(own - with) <= kSame * std::max(std::abs(own), std::abs(slope) * moved))) return {};
    }
    above = above || (upper ? slope > 0 : slope < 0);
    below = below || (upper ? slope < 0 : slope > 0);
    flat = flat || slope == 0;
  }
  const network::SwitchStructure& structure = program_.switch_structure();
  AtCorner found{false, {}};
  for (const std::uint32_t s : structure.members[units_[unit]]) {
    const bool holds = structure.opposite[s] ? below : above, lets = structure.opposite[s] ? above : below;
    found.turns = found.turns || (holds && (lets || flat));
    if (!holds) found.silent.push_back(s);
  }
  return found;
}

/// To which side the event function of a unit goes in a trial: 1, −1, or 0 where it stays at zero.
int SideTrials::direction(Combination sides, std::size_t unit) const {
  const auto& trial = trials_[sides];
  if (!trial) return 0;
  if (const int off = off_zero(sides, unit); off != 0) return off;
  return side_of(trial->rates[unit], scales_[unit]);
}

bool SideTrials::crosses(std::size_t unit) const {
  const int goes = direction(0, unit);
  for (Combination sides = 0; sides < combinations(); ++sides) {
    if (goes == 0 || direction(sides, unit) != goes) return false;
  }
  return true;
}

/// Whether the equations jump with a unit.
bool SideTrials::jumps(std::size_t unit) const {
  const auto& members = program_.switch_structure().members[units_[unit]];
  return std::any_of(members.begin(), members.end(), [&](std::uint32_t s) {
    return program_.switches()[s].turning == network::Turning::jumps;
  });
}

bool SideTrials::any_jumps(Combination units) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(units, u) && jumps(u)) return true;
  }
  return false;
}

bool SideTrials::is_independent(Combination units) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(units, u) && (broken_by_[u] & units) != 0) return false;
  }
  return true;
}

bool SideTrials::stands(Combination sides, bool strictly) const {
  if (!trials_[sides]) return false;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!strictly && !jumps(u) && is_independent(1U << u)) continue;
    const int side = has(sides, u) ? 1 : -1;
    const int goes = direction(sides, u);
    if (goes == side) continue;
    if (goes != 0) return false;
    const bool other_drives_here = direction(sides ^ (1U << u), u) == side;
    if (other_drives_here && jumps(u) && is_independent(1U << u)) return false;
  }
  return true;
}

bool SideTrials::keeps(Combination sides, Combination preferred) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!rests(sides, u)) continue;
    if (has(sides, u) != has(preferred, u) || drives_at_zero(sides, u)) return false;
  }
  return true;
}

bool SideTrials::drives_at_zero(Combination sides, std::size_t unit) const {
  const auto &here = trials_[sides], &there = trials_[sides ^ (1U << unit)];
  if (!here || !there || here->event_functions[unit] != 0) return false;
  if (here->rates[unit].rate != 0 || there->rates[unit].rate != 0) return false;
  const network::SwitchStructure& structure = program_.switch_structure();
  const auto& members = structure.members[units_[unit]];
  const bool holds = std::any_of(members.begin(), members.end(), [&](std::uint32_t s) {
    return has(sides, unit) != structure.opposite[s] &&
           program_.switches()[s].turning == network::Turning::jumps;
  });
  return holds && !std::equal(here->rates.begin(), here->rates.end(), there->rates.begin(),
                              [](const ProbedRate& a, const ProbedRate& b) { return a.rate == b.rate; });
}

bool SideTrials::is_flat(Combination sides, std::size_t unit) const {
  if (!trials_[sides] || !rests(sides, unit) || trials_[sides]->event_functions[unit] != 0) return false;
  for (std::size_t other = 0; other < units_.size(); ++other) {
    const auto& there = trials_[sides ^ (1U << other)];
    if (other != unit && there && there->rates[unit].rate != 0) return true;
  }
  return false;
}

bool SideTrials::is_undecided(Combination sides, std::size_t unit) const {
  const Combination other = sides ^ (1U << unit);
  if (!jumps(unit) || !is_independent(1U << unit)) return false;
  const int side = has(sides, unit) ? 1 : -1;
  return direction(sides, unit) == side && direction(other, unit) == -side;
}

}  // namespace oblique::solve
