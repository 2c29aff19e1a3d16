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

constexpr double kRoundingOfState = 1e-15;  ///< of it
/// Of the time in which what is fast answers: as long as this it goes straight on.
constexpr double kStraight = 0.1;

constexpr std::size_t kMostTrials = 3;  ///< of bends and others that follow each other

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

}  // namespace

SideTrials::SideTrials(const network::Program& program, network::Workspace& workspace,
                       const Thresholds& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      thresholds_(thresholds),
      span_(span),
      event_functions_(program.switches().size()),
      rates_(program.switches().size()),
      derivatives_(program.n_states()),
      moved_(program.n_states()) {}

void SideTrials::run(std::vector<std::uint32_t> units, Bends& bends, double t, std::span<const double> x) {
  units_ = std::move(units);
  before_.assign(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  fastest_ = 0;
  trials_.clear();
  for (Combination sides = 0; sides < combinations(); ++sides) trials_.push_back(attempt(sides, bends, t, x));
  find_broken();
}

/// Where an event function jumps with the position of another unit, but by nothing here, it is not broken by
/// that: a level that a product with zero makes, say.
void SideTrials::find_broken() {
  broken_by_ = broken_by(program_, units_);
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
      if (u != v && largest_jump(u, v) <= no_jump(off)) broken_by_[u] &= ~(std::uint64_t{1} << v);
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

std::vector<double> SideTrials::of_units(const std::vector<double>& of_switches) const {
  std::vector<double> values(units_.size());
  for (std::size_t u = 0; u < values.size(); ++u) values[u] = of_unit(of_switches, u);
  return values;
}

std::optional<network::Evaluation> SideTrials::place(Combination sides, Bends& bends, double t,
                                                     std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  take_back();
  std::vector<bool> placed(event_functions_.size(), false);
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

/// What the rounding of the states makes of the rates of units at (t, x): much, where something fast is
/// nearly in balance.
std::vector<double> SideTrials::noise_of(const std::vector<double>& rates, double t,
                                         std::span<const double> x) {
  std::vector<double> moved_derivatives(x.size());
  for (std::size_t i = 0; i < x.size(); ++i)
    moved_[i] = x[i] * (1 + (i % 2 == 0 ? 1 : -1) * kRoundingOfState);
  const auto moved = program_.event_functions(t, moved_.data(), event_functions_.data(), workspace_);
  if (!moved) return std::vector<double>(rates.size(), 0.0);
  moved->derivatives(moved_derivatives.data());
  moved->event_function_rates(moved_derivatives.data(), rates_.data());
  std::vector<double> noise = of_units(rates_);
  for (std::size_t u = 0; u < noise.size(); ++u)
    noise[u] = std::isfinite(noise[u]) ? std::abs(noise[u] - rates[u]) : 0;
  return noise;
}

std::optional<SideTrials::Trial> SideTrials::attempt(Combination sides, Bends& bends, double t,
                                                     std::span<const double> x) {
  const auto here = place(sides, bends, t, x);
  if (!here) return std::nullopt;
  Trial trial;
  trial.event_functions = of_units(event_functions_);
  here->derivatives(derivatives_.data());
  here->event_function_rates(derivatives_.data(), rates_.data());
  trial.rates = of_units(rates_);
  trial.noise = noise_of(trial.rates, t, x);
  const double fastest = fastest_of(derivatives_, std::numeric_limits<double>::min());
  fastest_ = std::max(fastest_, fastest);
  trial.step = std::min(kProbe / fastest, kProbe * span_);
  for (const double noise : trial.noise) {
    if (noise > 0) trial.step = std::min(trial.step, kStraight * kRoundingOfState / noise);
  }
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + trial.step * derivatives_[i];
  const auto later =
      program_.event_functions(t + trial.step, moved_.data(), event_functions_.data(), workspace_);
  if (!later) return std::nullopt;
  later->derivatives(derivatives_.data());
  later->event_function_rates(derivatives_.data(), rates_.data());
  trial.later = of_units(rates_);
  return trial;
}

double SideTrials::largest_rate(std::size_t unit) const {
  double largest = kRounding * fastest_;
  for (const auto& trial : trials_) {
    if (trial) largest = std::max(largest, std::abs(trial->rates[unit]));
  }
  return largest;
}

/// To which side the event function of a unit goes in a trial: 1, −1, or 0 where it stays at zero.
int SideTrials::direction(Combination sides, std::size_t unit) const {
  const auto& trial = trials_[sides];
  if (!trial) return 0;
  const std::uint32_t s = program_.switch_structure().members[units_[unit]].front();
  if (std::abs(trial->event_functions[unit]) > std::max(thresholds_[s], SlidingMode::drift()))
    return sign_of(trial->event_functions[unit]);
  const double rate = trial->rates[unit], later = trial->later[unit], noise = trial->noise[unit];
  if (!leaves_rounding(rate, span_) && !leaves_rounding(later, span_)) return 0;
  if (std::abs(rate) > noise && std::abs(rate) > kNoRate * largest_rate(unit) &&
      std::abs(rate) > kRounding * fastest_ && !is_about_to_turn(rate, later, trial->step))
    return sign_of(rate);
  double largest_later = 0;
  for (const auto& other : trials_) {
    if (other) largest_later = std::max(largest_later, std::abs(other->later[unit]));
  }
  const bool moves = std::abs(later) > noise && std::abs(later) > kNoLaterRate * largest_later &&
                     std::abs(later) > 10 * kRounding * fastest_ &&
                     largest_later > std::numeric_limits<double>::min();
  return moves ? sign_of(later) : 0;
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
    if (has(sides, u) != has(preferred, u) && rests(sides, u)) return false;
  }
  return true;
}

bool SideTrials::is_undecided(Combination sides, std::size_t unit) const {
  const Combination other = sides ^ (1U << unit);
  if (!jumps(unit) || !is_independent(1U << unit)) return false;
  const int side = has(sides, unit) ? 1 : -1;
  return direction(sides, unit) == side && direction(other, unit) == -side;
}

}  // namespace oblique::solve
