// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/switched_system.h>

#include <oblique/network/program/flat_equations.h>

namespace oblique::solve {

bool SwitchedSystem::depends_on_time() const {
  if (switching_.slides()) return true;
  if (!by_time_) by_time_ = !network::flat_equations(program_, {}).by_time.empty();
  return *by_time_;
}

}  // namespace oblique::solve
