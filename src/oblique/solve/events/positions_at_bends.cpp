// SPDX-License-Identifier: MIT
// The part of Positions for switches at which the equations only bend. Wherever these stand, dx/dt at that
// instant is the same, so that they need no trials: each goes where its surface goes, in the order in which
// the slopes of the surfaces depend on their positions (lexicographic derivatives: Nesterov 2005).
#include <oblique/solve/events/positions.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/events/position_limits.h>

namespace oblique::solve {

bool Positions::only_bends(std::uint32_t unit) const {
  const auto& members = program_.switch_structure().members[unit];
  return std::all_of(members.begin(), members.end(), [&](std::uint32_t s) {
    return program_.is_ordered(s) &&
           (program_.switches()[s].turning != network::Turning::jumps || program_.pieces_meet(s, workspace_));
  });
}

/// Sets those apart that only bend where there are no others, or too many for trials. Together with a few
/// others they take part in the trials: they may rest while these slide.
void Positions::set_apart(const std::vector<std::uint32_t>& units, const std::vector<bool>& preferred) {
  const network::SwitchStructure& structure = program_.switch_structure();
  units_.clear();
  bends_.clear();
  bent_.clear();
  std::fill(bends_at_.begin(), bends_at_.end(), false);
  std::vector<bool> bends(units.size());
  for (std::size_t u = 0; u < units.size(); ++u) bends[u] = only_bends(units[u]);
  const bool apart =
      units.size() > kMostUnits || std::all_of(bends.begin(), bends.end(), [](bool only) { return only; });
  for (std::size_t u = 0; u < units.size(); ++u) {
    if (!apart || !bends[u]) {
      units_.push_back(units[u]);
      continue;
    }
    bends_.push_back(units[u]);
    for (const std::uint32_t s : structure.members[units[u]]) {
      bends_at_[s] = true;
      bent_.emplace_back(s, preferred[u] != structure.opposite[s] ? 1 : 0);
    }
  }
}

/// Turns those apart to where their surfaces go from (t, x), all others where they are. One that stays at
/// zero keeps its position.
bool Positions::follow_bends(double t, std::span<const double> x) {
  const network::SwitchStructure& structure = program_.switch_structure();
  resting_bends_.clear();
  program_.last_derivatives(slopes_.data(), workspace_);
  double fastest = std::numeric_limits<double>::min();
  for (const double slope : slopes_) fastest = std::max(fastest, std::abs(slope));
  const auto moves = [&](double rate, double rounding) {
    return std::abs(rate) > rounding * fastest && leaves_rounding(rate);
  };
  const auto follow = [&](std::uint32_t s, double rate) {
    workspace_.set_memory(program_.switches()[s].memory, rate > 0 ? 1 : 0);
  };
  program_.decide_in_order(t, x.data(), slopes_.data(), workspace_,
                           [&](std::uint32_t s, double /*surface*/, double rate) {
                             if (!bends_at_[s]) return;
                             first_rates_[s] = rate;
                             if (moves(rate, kRounding)) follow(s, rate);
                           });
  // What stands still to first order, or is about to turn, goes where it goes a moment later.
  std::vector<bool> at_once(bends_at_.size(), false), by_later(bends_at_.size(), false);
  const double step = std::min(kProbe / fastest, kProbe * span_);
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step * slopes_[i];
  if (program_.surfaces(t + step, moved_.data(), surfaces_.data(), workspace_)) {
    program_.last_derivatives(slopes_.data(), workspace_);
    program_.decide_in_order(
        t + step, moved_.data(), slopes_.data(), workspace_,
        [&](std::uint32_t s, double /*surface*/, double later) {
          if (!bends_at_[s]) return;
          const double rate = first_rates_[s];
          if (moves(rate, kRounding) && std::abs(rate) > kAboutToTurn * std::abs(later - rate)) {
            follow(s, rate);
            at_once[s] = true;
          } else if (moves(later, 10 * kRounding)) {
            follow(s, later);
            by_later[s] = true;
          } else if (s == structure.members[structure.unit[s]].front()) {
            resting_bends_.push_back(structure.unit[s]);
          }
        });
    keep_where_both_sides_lead_back(t + step, moved_, by_later);
    keep_where_both_sides_lead_back(t, x, at_once);
  }
  return program_.surfaces(t, x.data(), surfaces_.data(), workspace_);
}

/// Looks at those `decided` at (t, x) where they have gone: where that side leads back as well, the solution
/// goes along the surface within less than what can be told, and both sides are right to the rounding of the
/// surface. (What multiplies this rounding may change dx/dt.) Such a one takes the side that it prefers.
void Positions::keep_where_both_sides_lead_back(double t, std::span<const double> x,
                                                const std::vector<bool>& decided) {
  if (std::find(decided.begin(), decided.end(), true) == decided.end()) return;
  if (!program_.surfaces(t, x.data(), surfaces_.data(), workspace_)) return;
  program_.last_derivatives(slopes_.data(), workspace_);
  std::vector<double> preferred(bends_at_.size());
  for (const auto& [s, position] : bent_) preferred[s] = position;
  program_.decide_in_order(t, x.data(), slopes_.data(), workspace_,
                           [&](std::uint32_t s, double /*surface*/, double rate) {
                             const std::uint32_t memory = program_.switches()[s].memory;
                             const bool back = workspace_.memory(memory) == 1 ? rate < 0 : rate > 0;
                             if (decided[s] && back) workspace_.set_memory(memory, preferred[s]);
                           });
}

/// While a slide has begun, with the rates of its mixture in `rates_`: those whose surfaces stay at zero
/// along with it are let rest. False, with the slide ended, where one would go to the other side.
bool Positions::let_bends_rest() {
  const auto fits = [&](const std::pair<std::uint32_t, double>& bent) {
    const std::uint32_t s = bent.first;
    const double largest = std::max(kRounding * fastest_, std::abs(first_rates_[s]));
    if (std::abs(rates_[s]) > kNoLaterRate * largest)
      return (rates_[s] > 0) == (workspace_.memory(program_.switches()[s].memory) == 1);
    slide_.let_rest(s);
    return true;
  };
  if (std::all_of(bent_.begin(), bent_.end(), fits)) return true;
  slide_.end();
  return false;
}

}  // namespace oblique::solve
