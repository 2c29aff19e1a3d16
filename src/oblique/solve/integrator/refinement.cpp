// SPDX-License-Identifier: MIT
#include <oblique/network/program/program.h>
#include <oblique/solve/integrator/refinement.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace oblique::solve {
namespace {

/// The tolerance of a run is what its results are to be good to. The solver holds every single step to its
/// own tolerance, and the errors of all steps add up: on the catalogue of tests/solve/smooth_problems.py half
/// of the problems erred by more than 15 (Adams) and 120 (BDF) times that, Kepler's orbits by thousands.
/// Tightened so, the medians are 0.1 and 4, the worst 60 and 15, for 1.5 and 1.75 times the steps; BDF, of
/// order 5, pays more for a digit than Adams' formulas, of order 12.
///
/// Of Rodas5P the errors of nearly all of the problems are the same number of tolerances from 1e-5 to 1e-11:
/// with its tolerance as asked the medians are 1.8 and, of the stiff ones, 0.5, and the worst, a pendulum
/// that passes near its top, 580; tightened ten times 0.2, 0.06 and 57.
///
/// ARKODE's explicit Runge-Kutta methods were measured beside Adams on three of the problems: Fehlberg's of
/// order 8 takes a fifth to a half of the steps and 2 to 4 times the evaluations for the same digits, but its
/// interpolant, of degree 5, is 10 to 100 times less accurate than its steps, though events and rows are read
/// from it; that of Adams costs nothing and is as good as the steps.
constexpr double kTighterAdams = 100, kTighterBdf = 30, kTighterRodas = 10;

double times_tighter(diagram::IntegrationMethod method) {
  switch (method) {
    case diagram::IntegrationMethod::adams:
      return kTighterAdams;
    case diagram::IntegrationMethod::rodas:
      return kTighterRodas;
    default:
      return kTighterBdf;
  }
}

/// Below this, rounding in dx/dt decides about steps.
constexpr double kFinestTolerance = 1e-14;

/// Of the distance from an equilibrium that is not zero, as a part of the states: what the relative tolerance
/// is to be, so that what grows out of it is good to ten tolerances of the run or so.
constexpr double kOfDistance = 2;

/// Of the distance from an equilibrium out of which a state grew: the size down to which it is to be known.
/// The run that found the distance was itself wrong about how small it became.
constexpr double kFarBelow = 1e-8;
constexpr double kSmallest = 1e-290;  ///< [machine unit] of an absolute tolerance: its inverse is a weight

std::string quoted_names(const network::Program& program, const std::vector<std::size_t>& states) {
  std::string names;
  constexpr std::size_t kMostNamed = 3;
  for (std::size_t k = 0; k < std::min(states.size(), kMostNamed); ++k)
    names += fmt::format("{}'{}'", k == 0 ? "" : ", ", program.states()[states[k]].name);
  return states.size() > kMostNamed ? names + ", …" : names;
}

}  // namespace

void refine(const Unseen& unseen, std::size_t n_states, Refinement& refinement) {
  refinement.reach.resize(n_states, 0);
  const auto reach_to = [&](std::size_t i, double size) {
    double& reach = refinement.reach[i];
    reach = reach > 0 ? std::min(reach, size) : size;
  };
  for (const UnseenGrowth& growth : unseen.growth) {
    if (growth.relative > 0)
      refinement.nearest =
          refinement.nearest > 0 ? std::min(refinement.nearest, growth.relative) : growth.relative;
    // What fell below the size down to which it was to be known would do so again.
    for (const std::size_t i : growth.states)
      reach_to(i, growth.distance < refinement.reach[i] ? kSmallest : kFarBelow * growth.distance);
  }
  for (const SmallState& small : unseen.small) reach_to(small.state, kAbsoluteTolerance * small.size);
  // As small as a decay may become: where it was when it was lost says nothing.
  for (const FaintTurn& turn : unseen.faint) {
    for (const std::size_t state : turn.states) reach_to(state, kSmallest);
  }
  for (const std::size_t state : unseen.lost) reach_to(state, kSmallest);
}

SolverSettings solver_settings(const std::vector<network::State>& states, const RunOptions& options,
                               diagram::IntegrationMethod method, const Refinement& refinement) {
  SolverSettings settings;
  settings.method = method;
  settings.asked = options.tolerance;
  const double wanted = times_tighter(method);
  settings.relative_tolerance = std::max(kFinestTolerance, options.tolerance / wanted);
  if (refinement.nearest > 0)
    settings.relative_tolerance = std::clamp(kOfDistance * refinement.nearest * options.tolerance,
                                             kFinestTolerance, settings.relative_tolerance);
  const double tighter = options.tolerance / settings.relative_tolerance;
  settings.absolute_tolerance =
      options.absolute_tolerance.value_or(kAbsoluteTolerance * options.tolerance) / tighter;
  settings.max_steps = options.max_steps;
  settings.max_step = options.max_step;
  const bool refined = !refinement.reach.empty();
  if (refined ||
      std::any_of(states.begin(), states.end(), [](const network::State& s) { return s.tolerance > 0; })) {
    for (const network::State& state : states)
      settings.own_tolerances.push_back(state.tolerance > 0 ? state.tolerance / tighter
                                                            : settings.absolute_tolerance);
  }
  for (std::size_t i = 0; i < refinement.reach.size(); ++i) {
    if (refinement.reach[i] == 0) continue;
    double& own = settings.own_tolerances[i];
    own = std::clamp(settings.relative_tolerance * refinement.reach[i], kSmallest, own);
  }
  return settings;
}

std::vector<text::Diagnostic> warnings_of(const Unseen& unseen, const network::Program& program,
                                          const diagram::FlatDiagram& diagram, bool out_of_steps) {
  const std::string_view limit =
      out_of_steps ? "its tolerance, and a finer run takes too many steps" : "the finest tolerance";
  const std::string raise = out_of_steps ? "raise max_steps in [run], or " : "";
  std::vector<text::Diagnostic> warnings;
  for (const UnseenGrowth& growth : unseen.growth) {
    warnings.push_back(
        {{diagram.file, {}},
         fmt::format(
             "{} grew until t = {:.6g} s from within {:.2g} machine units of an unstable equilibrium: "
             "too near for {}, so that what follows may be wrong",
             quoted_names(program, growth.states), growth.time, growth.distance, limit),
         {},
         raise + "start farther from the equilibrium, or write the states as their distance from it"});
  }
  for (const SmallState& small : unseen.small) {
    const std::size_t beyond = small.reading - std::min(small.reading, diagram.outputs.size());
    const std::string reader = small.reading < diagram.outputs.size()
                                   ? fmt::format("output '{}'", diagram.outputs[small.reading].name)
                                   : fmt::format("'{}' ({})", program.switches()[beyond].block,
                                                 program.switches()[beyond].comparison);
    warnings.push_back({{diagram.file, {}},
                        fmt::format("'{}' stays within {:.2g} machine units, which is too small for {}, and "
                                    "{} depends on it: it may "
                                    "be wrong",
                                    program.states()[small.state].name, small.size, limit, reader),
                        {},
                        raise + "scale the state up, and down again what reads it"});
  }
  for (const FaintTurn& turn : unseen.faint) {
    const network::Switch& made = program.switches()[turn.number];
    warnings.push_back(
        {{diagram.file, {}},
         fmt::format("'{}' ({}) {} at t = {:.9g} s, where what it compares is equal to within {:.2g}, "
                     "which is its error: what follows may be wrong",
                     made.block, made.comparison, turn.turned ? "turns over" : "does not turn over",
                     turn.time, turn.error),
         {},
         "compare with a level that is passed, give the comparison a hysteresis, or end the run before"});
  }
  return warnings;
}

}  // namespace oblique::solve
