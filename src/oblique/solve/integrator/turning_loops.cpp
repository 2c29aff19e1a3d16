// SPDX-License-Identifier: MIT
#include <oblique/solve/integrator/turning_loops.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <oblique/solve/events/time_resolution.h>

namespace oblique::solve {

TurningLoops::TurningLoops(const network::Program& program, network::Workspace& workspace,
                           Switching& switching)
    : program_(program),
      workspace_(workspace),
      switching_(switching),
      signals_(program.n_signals()),
      rates_(program.n_states()),
      beside_(program.n_states()) {
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    if (!program.loop_repeats(loop)) continue;
    const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
    unknowns_.insert(unknowns_.end(), unknowns.begin(), unknowns.end());
  }
}

bool TurningLoops::read(double t, std::span<const double> x, std::vector<double>& unknowns) {
  if (!switching_.signals(t, x.data(), signals_.data())) return false;
  unknowns.clear();
  for (const std::size_t u : unknowns_) unknowns.push_back(workspace_.unknown(u));
  return true;
}

double TurningLoops::longest_step(double t, std::span<const double> x, double inwards) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr double kMostTurn = 0.5;    // [rad]
  constexpr double kMoment = 1e-3;     // of the time to the other end
  constexpr double kSmallTurn = 0.05;  // [rad], in a moment
  constexpr double kShorter = 1e-3;
  double longest = kInfinity;
  for (double moment = kMoment * (inwards - t);; moment *= kShorter) {
    if (!(std::abs(moment) > time_resolution(t)) || !read(t, x, here_) ||
        !switching_.derivatives(t, x.data(), rates_.data()))
      break;
    for (std::size_t i = 0; i < x.size(); ++i) beside_[i] = x[i] + moment * rates_[i];
    if (!read(t + moment, beside_, there_)) break;
    double turn = 0;
    for (std::size_t u = 0; u < here_.size(); ++u) turn = std::max(turn, std::abs(there_[u] - here_[u]));
    if (turn > kSmallTurn) continue;
    longest = turn > 0 ? kMostTurn / turn * std::abs(moment) : kInfinity;
    break;
  }
  read(t, x, here_);  // where the loops were
  return longest;
}

}  // namespace oblique::solve
