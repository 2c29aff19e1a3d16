// SPDX-License-Identifier: MIT
#include <oblique/solve/events/positions.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <oblique/solve/events/position_limits.h>

namespace oblique::solve {
namespace {

constexpr std::size_t kMostTogether = 12;  ///< switches of which `choose_any` tries all combinations

int sign_of(double value) {
  return value > 0 ? 1 : value < 0 ? -1 : 0;
}

bool has(std::uint32_t bits, std::size_t place) {
  return (bits >> place & 1U) != 0;
}

}  // namespace

Positions::Positions(const network::Program& program, network::Workspace& workspace, SlidingMode& slide,
                     const std::vector<double>& thresholds, double span)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      span_(span),
      bends_at_(program.switches().size(), false),
      first_rates_(program.switches().size()),
      surfaces_(program.switches().size()),
      rates_(program.switches().size()),
      slopes_(program.n_states()),
      moved_(program.n_states()) {}

double Positions::of_unit(const std::vector<double>& of_switches, std::size_t unit) const {
  const network::SwitchStructure& structure = program_.switch_structure();
  const std::uint32_t s = structure.members[units_[unit]].front();
  return structure.opposite[s] ? -of_switches[s] : of_switches[s];
}

std::vector<std::uint32_t> Positions::nearest_first(std::uint32_t to) const {
  std::vector<std::uint32_t> order(std::size_t{1} << units_.size());
  for (std::uint32_t bits = 0; bits < order.size(); ++bits) order[bits] = bits;
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::popcount(a ^ to) < std::popcount(b ^ to);
  });
  return order;
}

/// Puts the units on their sides, and every other switch where its surface then asks for it.
bool Positions::place(std::uint32_t bits, double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  workspace_.load_memories(before_);
  std::vector<bool> placed(surfaces_.size(), false);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    for (const std::uint32_t s : structure.members[units_[u]]) {
      placed[s] = true;
      workspace_.set_memory(program_.switches()[s].memory, has(bits, u) != structure.opposite[s] ? 1 : 0);
    }
  }
  for (const auto& [s, position] : bent_) {
    placed[s] = true;
    workspace_.set_memory(program_.switches()[s].memory, position);
  }
  return settle_others(placed, t, x) && (bends_.empty() || follow_bends(t, x));
}

/// Puts every switch but those that are placed where its surface asks for it.
bool Positions::settle_others(const std::vector<bool>& placed, double t, std::span<const double> x) {
  constexpr std::size_t kInOrder = 2;  // rounds before what is left goes in one
  bool turned = false;
  const auto settle = [&](std::size_t s, double surface) {
    if (placed[s] || program_.switches()[s].rate || std::abs(surface) <= thresholds_[s]) return;
    const std::uint32_t memory = program_.switches()[s].memory;
    const double position = surface > 0 ? 1 : 0;
    turned = turned || workspace_.memory(memory) != position;
    workspace_.set_memory(memory, position);
  };
  for (std::size_t round = 0; round <= 2 * surfaces_.size() + 1; ++round) {
    if (!program_.surfaces(t, x.data(), surfaces_.data(), workspace_)) return false;
    turned = false;
    for (std::size_t s = 0; s < surfaces_.size(); ++s) settle(s, surfaces_[s]);
    if (!turned) return true;
    if (round == kInOrder) {
      const std::vector<double> still(x.size(), 0.0);
      program_.decide_in_order(t, x.data(), still.data(), workspace_,
                               [&](std::uint32_t s, double surface, double /*rate*/) { settle(s, surface); });
    }
  }
  return false;
}

Positions::Trial Positions::attempt(std::uint32_t bits, double t, std::span<const double> x) {
  Trial trial;
  if (!place(bits, t, x)) return trial;
  const auto keep = [&](const std::vector<double>& of_switches) {
    std::vector<double> of_units(units_.size());
    for (std::size_t u = 0; u < of_units.size(); ++u) of_units[u] = of_unit(of_switches, u);
    return of_units;
  };
  trial.surfaces = keep(surfaces_);
  program_.last_derivatives(slopes_.data(), workspace_);
  program_.surface_rates(slopes_.data(), rates_.data(), workspace_);
  trial.rates = keep(rates_);
  double fastest = std::numeric_limits<double>::min();
  for (const double slope : slopes_) fastest = std::max(fastest, std::abs(slope));
  fastest_ = std::max(fastest_, fastest);
  const double step = std::min(kProbe / fastest, kProbe * span_);
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step * slopes_[i];
  if (!program_.surfaces(t + step, moved_.data(), surfaces_.data(), workspace_)) return trial;
  program_.last_derivatives(slopes_.data(), workspace_);
  program_.surface_rates(slopes_.data(), rates_.data(), workspace_);
  trial.later = keep(rates_);
  trial.valid = true;
  return trial;
}

/// Whether a rate takes a surface out of its rounding at all while the run lasts: where all is at rest there
/// is no faster state beside which to see that it is rounding.
bool Positions::leaves_rounding(double rate) const {
  return std::abs(rate) * span_ > kRounding;
}

/// To which side the surface of a unit goes in a trial: 1, −1, or 0 where it stays at zero.
int Positions::direction(std::uint32_t bits, std::size_t unit) const {
  const Trial& trial = trials_[bits];
  if (!trial.valid) return 0;
  const std::uint32_t s = program_.switch_structure().members[units_[unit]].front();
  if (std::abs(trial.surfaces[unit]) > std::max(thresholds_[s], SlidingMode::drift()))
    return sign_of(trial.surfaces[unit]);
  double largest = kRounding * fastest_, largest_later = 0;
  for (const Trial& other : trials_) {
    if (!other.valid) continue;
    largest = std::max(largest, std::abs(other.rates[unit]));
    largest_later = std::max(largest_later, std::abs(other.later[unit]));
  }
  const double rate = trial.rates[unit];
  if (!leaves_rounding(rate) && !leaves_rounding(trial.later[unit])) return 0;
  if (std::abs(rate) > kNoRate * largest && std::abs(rate) > kRounding * fastest_ &&
      std::abs(rate) > kAboutToTurn * std::abs(trial.later[unit] - rate))
    return sign_of(rate);
  const bool moves = std::abs(trial.later[unit]) > kNoLaterRate * largest_later &&
                     std::abs(trial.later[unit]) > 10 * kRounding * fastest_ &&
                     largest_later > std::numeric_limits<double>::min();
  return moves ? sign_of(trial.later[unit]) : 0;
}

/// Whether the equations jump with a unit.
bool Positions::jumps(std::size_t unit) const {
  const auto& members = program_.switch_structure().members[units_[unit]];
  return std::any_of(members.begin(), members.end(), [&](std::uint32_t s) {
    return program_.switches()[s].turning == network::Turning::jumps;
  });
}

bool Positions::any_of_them_jumps(std::uint32_t units) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(units, u) && jumps(u)) return true;
  }
  return false;
}

/// Whether the solution goes from every surface to the side that its unit stands on. Where the equations only
/// bend there, both sides are right to the rounding of the surface, unless it is asked for strictly.
bool Positions::stands(std::uint32_t bits, bool strictly) const {
  if (!trials_[bits].valid) return false;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (!strictly && !jumps(u) && is_independent(1U << u)) continue;
    const int side = has(bits, u) ? 1 : -1;
    const int goes = direction(bits, u);
    if (goes == side) continue;
    if (goes != 0) return false;
    const bool other_drives_here = direction(bits ^ (1U << u), u) == side;
    if (other_drives_here && jumps(u) && is_independent(1U << u)) return false;
  }
  return true;
}

/// Whether every unit whose surface stays at zero is where it was: nothing asks it to turn over.
bool Positions::keeps(std::uint32_t bits, std::uint32_t preferred) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(bits, u) != has(preferred, u) && direction(bits, u) == 0) return false;
  }
  return true;
}

/// Where both sides of a surface lead away from it, either is a solution.
void Positions::note_choice(std::uint32_t bits) {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (direction(bits, u) == 0) resting_.push_back(units_[u]);
    const std::uint32_t other = bits ^ (1U << u);
    if (!jumps(u) || !is_independent(1U << u) || !trials_[other].valid) continue;
    const int side = has(bits, u) ? 1 : -1;
    if (direction(bits, u) == side && direction(other, u) == -side) undecided_.push_back(units_[u]);
  }
}

/// Whether the surfaces of these units do not depend on their own positions.
bool Positions::is_independent(std::uint32_t sliding) const {
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(sliding, u) && (broken_by_[u] & sliding) != 0) return false;
  }
  return true;
}

/// Slides along some units with the others on the sides of `bits`.
bool Positions::try_slide(std::uint32_t sliding, std::uint32_t bits, double t, std::span<const double> x) {
  if (!place(bits, t, x)) return false;
  std::vector<std::uint32_t> units;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(sliding, u)) units.push_back(units_[u]);
  }
  if (!slide_.begin(std::move(units), t, x)) return false;
  slide_.mixed_rates(rates_);
  for (std::size_t u = 0; u < units_.size(); ++u) {
    if (has(sliding, u)) continue;
    double largest = kRounding * fastest_;
    for (const Trial& trial : trials_) {
      if (trial.valid) largest = std::max(largest, std::abs(trial.rates[u]));
    }
    const double rate = of_unit(rates_, u);
    if (std::abs(rate) <= kNoLaterRate * largest) {
      for (const std::uint32_t s : program_.switch_structure().members[units_[u]]) slide_.let_rest(s);
    } else if ((rate > 0) != has(bits, u)) {
      slide_.end();
      return false;
    }
  }
  return let_bends_rest();
}

bool Positions::choose(const std::vector<std::uint32_t>& units, const std::vector<bool>& preferred_sides,
                       double t, std::span<const double> x) {
  undecided_.clear();
  resting_.clear();
  resting_bends_.clear();
  set_apart(units, preferred_sides);
  if (units_.size() > kMostUnits) return false;
  broken_by_ = SlidingMode::broken_by(program_, units_);
  std::uint32_t preferred = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const auto at = std::find(units.begin(), units.end(), units_[u]) - units.begin();
    if (preferred_sides[static_cast<std::size_t>(at)]) preferred |= 1U << u;
  }
  before_.assign(workspace_.memories().begin(), workspace_.memories().end());
  std::uint32_t present = 0;
  for (std::size_t u = 0; u < units_.size(); ++u) {
    const std::uint32_t s = program_.switch_structure().members[units_[u]].front();
    const bool closed = workspace_.memory(program_.switches()[s].memory) == 1;
    if (closed != program_.switch_structure().opposite[s]) present |= 1U << u;
  }
  fastest_ = 0;
  trials_.clear();
  const std::uint32_t combinations = 1U << units_.size();
  for (std::uint32_t bits = 0; bits < combinations; ++bits) trials_.push_back(attempt(bits, t, x));
  const bool any_jump = any_of_them_jumps(combinations - 1);
  const std::vector<std::uint32_t> nearest = nearest_first(preferred);
  for (const bool strictly : {true, false}) {
    if (!strictly && any_jump) continue;
    for (const bool keeping : {true, false}) {  // else the order of the units would decide
      for (const std::uint32_t bits : nearest) {
        if ((keeping && !keeps(bits, preferred)) || !stands(bits, strictly)) continue;
        note_choice(bits);
        if (!place(bits, t, x)) return false;
        resting_.insert(resting_.end(), resting_bends_.begin(), resting_bends_.end());
        return true;
      }
    }
  }
  // To events, what slides stays where it was.
  const std::vector<std::uint32_t> order = nearest_first(present);
  for (int size = 1; size <= static_cast<int>(units_.size()); ++size) {
    for (std::uint32_t sliding = 1; sliding < combinations; ++sliding) {
      if (std::popcount(sliding) != size || !is_independent(sliding) || !any_of_them_jumps(sliding)) continue;
      for (const std::uint32_t bits : order) {
        if (((bits ^ present) & sliding) == 0 && try_slide(sliding, bits, t, x)) return true;
      }
    }
  }
  workspace_.load_memories(before_);
  return false;
}

/// Whether every switch stands where its surface asks for it, or goes to.
bool Positions::agrees(double t, std::span<const double> x) {
  if (!program_.surfaces(t, x.data(), surfaces_.data(), workspace_)) return false;
  program_.last_derivatives(slopes_.data(), workspace_);
  program_.surface_rates(slopes_.data(), rates_.data(), workspace_);
  double fastest = 0;
  for (const double slope : slopes_) fastest = std::max(fastest, std::abs(slope));
  for (std::size_t s = 0; s < surfaces_.size(); ++s) {
    if (program_.switches()[s].rate || slide_.holds(s) || slide_.follows(s)) continue;
    const int side = workspace_.memory(program_.switches()[s].memory) == 1 ? 1 : -1;
    const bool on_surface = std::abs(surfaces_[s]) <= thresholds_[s];
    if (!on_surface && sign_of(surfaces_[s]) != side) return false;
    if (on_surface && leaves_rounding(rates_[s]) && std::abs(rates_[s]) > kNoRate * fastest &&
        sign_of(rates_[s]) != side)
      return false;
  }
  return true;
}

bool Positions::choose_any(std::vector<std::uint32_t> restless, double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  for (std::size_t k = 0; k < restless.size(); ++k) {
    for (const std::uint32_t other : structure.positions_below(restless[k])) {
      const bool mutual = structure.depends(other, restless[k]);
      if (mutual && std::find(restless.begin(), restless.end(), other) == restless.end())
        restless.push_back(other);
    }
  }
  std::sort(restless.begin(), restless.end());
  restless.erase(std::unique(restless.begin(), restless.end()), restless.end());
  if (restless.size() > kMostTogether) return false;
  before_.assign(workspace_.memories().begin(), workspace_.memories().end());
  std::uint32_t present = 0;
  for (std::size_t k = 0; k < restless.size(); ++k) {
    if (workspace_.memory(program_.switches()[restless[k]].memory) == 1) present |= 1U << k;
  }
  units_ = restless;  // for their number
  std::vector<bool> placed(surfaces_.size(), false);
  for (const std::uint32_t s : restless) placed[s] = true;
  for (const std::uint32_t bits : nearest_first(present)) {
    workspace_.load_memories(before_);
    for (std::size_t k = 0; k < restless.size(); ++k)
      workspace_.set_memory(program_.switches()[restless[k]].memory, has(bits, k) ? 1 : 0);
    if (settle_others(placed, t, x) && agrees(t, x)) return true;
  }
  workspace_.load_memories(before_);
  return false;
}

}  // namespace oblique::solve
