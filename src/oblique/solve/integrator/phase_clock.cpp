// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/phase_clock.h>

#include <limits>

namespace oblique::solve {

PhaseClock::PhaseClock(const network::Program& program, const diagram::FlatTimeline& timeline,
                       network::Workspace& workspace, double t)
    : program_(program), timeline_(timeline), workspace_(workspace) {
  position_.begin = t;
  set_modes();
}

bool PhaseClock::is_last() const {
  return timeline_.phases.empty() ||
         (position_.phase + 1 == timeline_.phases.size() && position_.cycle + 1 >= timeline_.cycles);
}

double PhaseClock::end() const {
  if (is_last()) return std::numeric_limits<double>::infinity();
  return position_.begin + timeline_.phases[position_.phase].duration;
}

double PhaseClock::time_left(double t) const {
  if (is_last()) return std::numeric_limits<double>::infinity();
  return timeline_.phases[position_.phase].duration - (t - position_.begin);
}

bool PhaseClock::is_over(double t, const network::Evaluation& here) const {
  if (is_last()) return false;
  // Of one that is shorter than the time shows this is not its end yet.
  const bool begins = t == position_.begin && timeline_.phases[position_.phase].duration > 0;
  return (t >= end() && !begins) || here.phase_ends(position_.phase);
}

void PhaseClock::advance(double t) {
  position_.begin = t;
  if (++position_.phase == timeline_.phases.size()) {
    position_.phase = 0;
    ++position_.cycle;
  }
  set_modes();
}

void PhaseClock::restore(const Position& position) {
  position_ = position;
  set_modes();
}

void PhaseClock::set_modes() {
  if (timeline_.phases.empty()) return;
  const diagram::FlatPhase& phase = timeline_.phases[position_.phase];
  for (std::size_t g = 0; g < phase.modes.size(); ++g) {
    workspace_.set_discrete_state(program_.mode_states()[g], static_cast<double>(phase.modes[g]));
  }
}

}  // namespace oblique::solve
