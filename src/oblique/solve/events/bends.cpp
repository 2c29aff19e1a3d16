// SPDX-License-Identifier: MIT
#include <oblique/solve/events/bends.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/network/program/program.h>
#include <oblique/solve/events/kept_unknowns.h>
#include <oblique/solve/events/position_limits.h>

namespace oblique::solve {

bool switch_only_bends(const network::Program& program, const network::Evaluation& here, std::uint32_t s) {
  return program.is_ordered(s) &&
         (program.switches()[s].turning != network::Turning::jumps || here.pieces_meet(s));
}

bool only_bends(const network::Program& program, const network::Evaluation& here, std::uint32_t unit) {
  const auto& members = program.switch_structure().members[unit];
  return std::all_of(members.begin(), members.end(),
                     [&](std::uint32_t s) { return switch_only_bends(program, here, s); });
}

Bends::Bends(const network::Program& program, network::Workspace& workspace, double span)
    : program_(program),
      workspace_(workspace),
      span_(span),
      is_one_(program.switches().size(), false),
      first_rates_(program.switches().size()),
      event_functions_(program.switches().size()),
      derivatives_(program.n_states()),
      moved_(program.n_states()),
      probe_(program, workspace, span) {}

void Bends::clear() {
  positions_.clear();
  resting_.clear();
  std::fill(is_one_.begin(), is_one_.end(), false);
}

void Bends::add(std::uint32_t unit, const std::vector<double>& preferred) {
  for (const std::uint32_t s : program_.switch_structure().members[unit]) {
    is_one_[s] = true;
    positions_.emplace_back(s, preferred[s]);
  }
}

std::optional<network::Evaluation> Bends::follow(const network::Evaluation& here, double t,
                                                 std::span<const double> x,
                                                 std::vector<double>& event_functions) {
  const network::SwitchStructure& structure = program_.switch_structure();
  resting_.clear();
  here.derivatives(derivatives_.data());
  const double fastest = fastest_of(derivatives_, std::numeric_limits<double>::min());
  probe_.begin(here, 0);
  {
    const KeptUnknowns kept(program_, workspace_);
    probe_.find_noise(t, x);
  }
  const auto moves = [&](double rate, double rounding) {
    return std::abs(rate) > rounding * fastest && leaves_rounding(rate, span_);
  };
  const auto is_noise = [&](std::uint32_t s, double rate) { return std::abs(rate) <= probe_.noise(s); };
  const auto go = [&](std::uint32_t s, double rate) {
    workspace_.set_discrete_state(program_.switches()[s].discrete_state, rate > 0 ? 1 : 0);
  };
  program_.decide_in_order(t, x.data(), derivatives_.data(), workspace_,
                           [&](std::uint32_t s, double /*event_function*/, double rate) {
                             if (!is_one_[s]) return;
                             first_rates_[s] = rate;
                             if (moves(rate, kRounding) && !is_noise(s, rate)) go(s, rate);
                           });
  // What stands still to first order, or is about to turn, goes where it goes a moment later.
  std::vector<bool> at_once(is_one_.size(), false), by_later(is_one_.size(), false);
  double step = std::min(kProbe / fastest, kProbe * span_);
  for (const auto& bend : positions_) step = std::min(step, probe_.straight(bend.first));
  for (std::size_t i = 0; i < x.size(); ++i) moved_[i] = x[i] + step * derivatives_[i];
  {
    const KeptUnknowns kept(program_, workspace_);
    if (const auto later =
            program_.event_functions(t + step, moved_.data(), event_functions_.data(), workspace_)) {
      later->derivatives(derivatives_.data());
      program_.decide_in_order(t + step, moved_.data(), derivatives_.data(), workspace_,
                               [&](std::uint32_t s, double /*event_function*/, double later_rate) {
                                 if (!is_one_[s]) return;
                                 const double rate = first_rates_[s];
                                 if (is_noise(s, rate) && is_noise(s, later_rate) && rate != 0) return;
                                 if (moves(rate, kRounding) && !is_about_to_turn(rate, later_rate, step)) {
                                   go(s, rate);
                                   at_once[s] = true;
                                 } else if (moves(later_rate, 10 * kRounding)) {
                                   go(s, later_rate);
                                   by_later[s] = true;
                                 } else if (s == structure.members[structure.unit[s]].front()) {
                                   resting_.push_back(structure.unit[s]);
                                 }
                               });
      keep_where_both_sides_lead_back(t + step, moved_, by_later);
    }
  }
  keep_where_both_sides_lead_back(t, x, at_once);
  return program_.event_functions(t, x.data(), event_functions.data(), workspace_);
}

/// Looks at those `decided` at (t, x) where they have gone: where that side leads back as well, the solution
/// goes along the switching event function within less than what can be told, and both sides are right to the
/// rounding of the event function. (What multiplies this rounding may change dx/dt.) Such a one takes the
/// side that it prefers.
void Bends::keep_where_both_sides_lead_back(double t, std::span<const double> x,
                                            const std::vector<bool>& decided) {
  if (std::find(decided.begin(), decided.end(), true) == decided.end()) return;
  const auto here = program_.event_functions(t, x.data(), event_functions_.data(), workspace_);
  if (!here) return;
  here->derivatives(derivatives_.data());
  std::vector<double> preferred(is_one_.size());
  for (const auto& [s, position] : positions_) preferred[s] = position;
  program_.decide_in_order(t, x.data(), derivatives_.data(), workspace_,
                           [&](std::uint32_t s, double /*event_function*/, double rate) {
                             const std::uint32_t discrete_state = program_.switches()[s].discrete_state;
                             const bool back =
                                 workspace_.discrete_state(discrete_state) == 1 ? rate < 0 : rate > 0;
                             if (decided[s] && back)
                               workspace_.set_discrete_state(discrete_state, preferred[s]);
                           });
}

bool Bends::rest_with(SlidingMode& slide, const std::vector<double>& rates, double fastest) const {
  return std::all_of(positions_.begin(), positions_.end(), [&](const auto& placed) {
    const std::uint32_t s = placed.first;
    if (slide.follows(s)) return true;  // placed on each side apart
    const double largest = std::max(kRounding * fastest, std::abs(first_rates_[s]));
    if (std::abs(rates[s]) > kNoLaterRate * largest)
      return (rates[s] > 0) == (workspace_.discrete_state(program_.switches()[s].discrete_state) == 1);
    slide.let_rest(s);
    return true;
  });
}

}  // namespace oblique::solve
