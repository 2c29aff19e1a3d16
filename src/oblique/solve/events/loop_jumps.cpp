// SPDX-License-Identifier: MIT
#include <oblique/solve/events/loop_jumps.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/LU>

#include <oblique/network/program/program.h>
#include <oblique/solve/stability/amplifier_motion.h>
#include <oblique/text/even_point.h>

namespace oblique::solve {
namespace {

/// Larger loops are left to Newton's method.
constexpr std::size_t kMostUnknowns = 32;

/// Of 1 + |z|: a smooth way does not change by this in a moment.
constexpr double kJump = 1e-3;

/// The largest part, of 1 + |z|, by which one is off the other.
double part_between(const Eigen::VectorXd& from, const Eigen::VectorXd& to) {
  return ((to - from).array().abs() / (1 + from.array().abs())).maxCoeff();
}

/// Whether the elements of a loop come back to a solution, as far as one number tells: where the determinant
/// is below zero they run away, whatever their lags are; and it is the same for whichever of them are the
/// unknowns.
bool is_stable(const Eigen::MatrixXd& rates) {
  return rates.partialPivLu().determinant() > 0;
}

bool is_small(const network::Program& program, std::size_t loop) {
  return program.loops()[loop].unknowns.size() <= kMostUnknowns;
}

/// How the residual of each unknown of a loop moves it; empty where one is of an equation that says nothing
/// of that, or they are too many.
Eigen::VectorXd directions_of(const network::Program& program, std::size_t loop) {
  if (!is_small(program, loop)) return {};
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  Eigen::VectorXd directions(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t i = 0; i < unknowns.size(); ++i) {
    const network::Unknown& unknown = program.unknowns()[unknowns[i]];
    if (!unknown.torn && !unknown.held_by_amplifier) return {};
    directions[static_cast<Eigen::Index>(i)] = unknown.torn ? 1 : -1;
  }
  return directions;
}

/// What turns over with the unknowns of an algebraic loop, and acts on it, itself or by another (one sign
/// that reads another).
std::vector<std::uint32_t> switches_on(const network::Program& program, std::size_t loop) {
  const network::SwitchStructure& structure = program.switch_structure();
  const std::vector<bool> follows = structure.followers_of_loop(loop);
  const std::vector<bool> acts = structure.discrete_states_below_loop(loop);
  std::vector<bool> taken(follows.size());
  std::vector<std::uint32_t> found, left;  // `left`: those behind which others are still to be looked for
  const auto take = [&](std::uint32_t s) {
    if (taken[s] || !follows[s] || program.switches()[s].rate) return;
    taken[s] = true;
    found.push_back(s);
    left.push_back(s);
  };
  for (std::uint32_t s = 0; s < follows.size(); ++s) {
    const network::Switch& made = program.switches()[s];
    if (acts[made.moves_along ? program.events()[*made.moves_along].actions.front().index
                              : made.discrete_state])
      take(s);
  }
  while (!left.empty()) {
    const std::uint32_t last = left.back();
    left.pop_back();
    for (const std::uint32_t s : structure.positions_below(last)) take(s);
  }
  std::sort(found.begin(), found.end());
  return found;
}

/// Whether a switch is the limit of an element, or of an amplifier that holds an unknown of the loop.
bool is_limit(const network::Program& program, std::size_t loop, std::uint32_t s) {
  const network::Switch& made = program.switches()[s];
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  return made.turning == network::Turning::limits ||
         std::any_of(unknowns.begin(), unknowns.end(), [&](std::size_t u) {
           const network::Unknown& unknown = program.unknowns()[u];
           return unknown.held_by_amplifier &&
                  (unknown.name == made.block || unknown.name.starts_with(made.block + "."));
         });
}

}  // namespace

bool may_have_several(const network::Program& program, std::size_t loop) {
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  return std::all_of(unknowns.begin(), unknowns.end(),
                     [&](std::size_t u) { return program.unknowns()[u].torn; }) &&
         (!program.loop_is_linear(loop) || (is_small(program, loop) && !switches_on(program, loop).empty()));
}

std::vector<double> loop_point(const network::Program& program, std::size_t loop, int k) {
  std::vector<double> point = text::even_point(k, program.loops()[loop].unknowns.size());
  for (double& unknown : point) unknown = kLoopReach * (2 * unknown - 1);
  return point;
}

LoopJumps::LoopJumps(const network::Program& program, network::Workspace& workspace, const SlidingMode& slide,
                     const Thresholds& thresholds)
    : program_(program),
      workspace_(workspace),
      slide_(slide),
      thresholds_(thresholds),
      signals_(program.n_signals()) {
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    const std::vector<std::uint32_t> switches = switches_on(program, loop);
    std::vector<std::uint32_t> within;
    std::copy_if(switches.begin(), switches.end(), std::back_inserter(within),
                 [&](std::uint32_t s) { return !is_limit(program, loop, s); });
    Watched watched{loop, SwitchPlacing(program, switches), SwitchPlacing(program, within),
                    directions_of(program, loop)};
    if (watched.directions.size() == 0 && is_small(program, loop))
      equations_.push_back({loop, SwitchPlacing(program, watched.within.switches())});
    // Of linear equations that nothing changes on the way there is one solution.
    if (watched.directions.size() == 0 ||
        (program.loop_is_linear(loop) && watched.placing.switches().empty()))
      continue;
    watched.blind = watched.directions.minCoeff() > 0;
    watched.goes = watched.blind || !watched.placing.switches().empty();
    any_goes_ = any_goes_ || watched.goes;
    watched_.push_back(std::move(watched));
  }
}

Eigen::VectorXd LoopJumps::unknowns_of(const Watched& watched, const std::vector<double>& all) const {
  const std::vector<std::size_t>& unknowns = program_.loops()[watched.loop].unknowns;
  Eigen::VectorXd z(static_cast<Eigen::Index>(unknowns.size()));
  for (std::size_t i = 0; i < unknowns.size(); ++i) z[static_cast<Eigen::Index>(i)] = all[unknowns[i]];
  return z;
}

void LoopJumps::begin() {
  if (watched_.empty() && equations_.empty()) return;
  unknowns_.clear();
  for (std::size_t u = 0; u < program_.unknowns().size(); ++u) unknowns_.push_back(workspace_.unknown(u));
  discrete_states_.assign(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  for (Watched& watched : watched_) watched.stable = true;
}

std::vector<bool> LoopJumps::run_away(double t, std::span<const double> x) {
  std::vector<bool> found(program_.loops().size(), false);
  for (const Watched& watched : watched_) {
    const auto here = watched.goes ? pull(watched, t, x, workspace_) : std::nullopt;
    found[watched.loop] = here && !rests(watched, here->rates);
  }
  return found;
}

void LoopJumps::note(double t, std::span<const double> x) {
  if (!any_goes_) return;
  const std::vector<bool> runs_away = run_away(t, x);
  begin();
  for (Watched& watched : watched_) watched.stable = !runs_away[watched.loop];
}

void LoopJumps::expect(std::size_t discrete_state, double position) {
  if (any_goes_) discrete_states_[discrete_state] = position;
}

void LoopJumps::place(std::size_t loop, const std::vector<double>& unknowns, double t,
                      std::span<const double> x) {
  for (Watched& watched : watched_) {
    if (watched.loop == loop) place(loop, watched.placing, unknowns, t, x);
  }
}

void LoopJumps::place(std::size_t loop, SwitchPlacing& placing, const std::vector<double>& unknowns, double t,
                      std::span<const double> x) {
  std::vector<double> guesses;
  for (std::size_t u = 0; u < program_.unknowns().size(); ++u) guesses.push_back(workspace_.unknown(u));
  workspace_.hold_loop(loop, t, unknowns, true);
  placing.place(t, x.data(), workspace_, &thresholds_);
  workspace_.hold_loop(loop, std::numeric_limits<double>::quiet_NaN(), {}, false);
  // As the switches stood on the way, the other loops may have gone anywhere.
  for (std::size_t u = 0; u < guesses.size(); ++u) workspace_.set_unknown(u, guesses[u]);
}

void LoopJumps::place_near_guesses(double off, double t, std::span<const double> x) {
  const auto place_near = [&](std::size_t loop, SwitchPlacing& within) {
    std::vector<double> guesses;
    for (const std::size_t u : program_.loops()[loop].unknowns)
      guesses.push_back(workspace_.unknown(u) + off);
    place(loop, within, guesses, t, x);
  };
  for (Watched& watched : watched_) {
    if (!watched.blind || watched.placing.has_tables()) place_near(watched.loop, watched.within);
  }
  for (Equations& equations : equations_) place_near(equations.loop, equations.within);
}

bool LoopJumps::place_beside_guesses(double t, std::span<const double> x) {
  constexpr double kBeside = 1e-6;  // [machine unit]
  const std::vector<double> before(workspace_.discrete_states().begin(), workspace_.discrete_states().end());
  for (std::size_t u = 0; u < unknowns_.size(); ++u) workspace_.set_unknown(u, unknowns_[u]);
  place_near_guesses(kBeside, t, x);
  return !std::equal(before.begin(), before.end(), workspace_.discrete_states().begin());
}

void LoopJumps::place_at_guesses(double t, std::span<const double> x) {
  begin();
  place_near_guesses(0, t, x);
  for (Watched& watched : watched_) {
    // From line to line of a table, as no Newton's method goes.
    if (!watched.blind && watched.placing.has_tables()) go_from_before(watched, t, x);
  }
}

bool LoopJumps::settle(double t, std::span<const double> x, bool leaves) {
  bool any = false;
  for (Watched& watched : watched_) {
    const bool goes = watched.goes && !slide_.mixes(watched.loop);
    const auto here = goes ? pull(watched, t, x, workspace_) : std::nullopt;
    if (!here) continue;
    std::vector<double> now;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) now.push_back(workspace_.unknown(u));
    const bool jumps = part_between(unknowns_of(watched, unknowns_), unknowns_of(watched, now)) > kJump;
    const bool runs_away = !rests(watched, here->rates);
    if ((jumps || (watched.stable && runs_away)) &&
        (go_from_before(watched, t, x) || (leaves && runs_away && leave(watched, t, x))))
      any = true;
  }
  return any;
}

bool LoopJumps::go(double t, std::span<const double> x) {
  return std::any_of(watched_.begin(), watched_.end(),
                     [&](Watched& watched) { return go_from_before(watched, t, x); });
}

bool LoopJumps::go_past_branch_end(std::size_t lost, double t, std::span<const double> x) {
  begin();
  return std::any_of(watched_.begin(), watched_.end(), [&](Watched& watched) {
    if (!watched.goes || (watched.blind && watched.loop != lost)) return false;
    return go_from_before(watched, t, x) || leave(watched, t, x);
  });
}

/// What moves the unknowns of a loop, as they are; nothing where some loop has no solution.
std::optional<LoopJumps::Pull> LoopJumps::pull(const Watched& watched, double t, std::span<const double> x,
                                               network::Workspace& workspace) {
  const auto here = program_.signals(t, x.data(), signals_.data(), workspace);
  if (!here) return std::nullopt;
  Pull found{watched.directions.cwiseProduct(here->loop_residuals(watched.loop)),
             -(watched.directions.asDiagonal() * here->loop_jacobian(watched.loop))};
  if (!found.residuals.allFinite() || !found.rates.allFinite()) return std::nullopt;
  return found;
}

/// The same with its unknowns at z, whether they solve it or not, and all that hangs on them in place.
std::optional<LoopJumps::Pull> LoopJumps::pull_at(Watched& watched, const Eigen::VectorXd& z, double t,
                                                  std::span<const double> x, network::Workspace& workspace) {
  workspace.hold_loop(watched.loop, t, {z.begin(), z.end()}, true);
  if (!watched.placing.place(t, x.data(), workspace, &thresholds_)) return std::nullopt;
  return pull(watched, t, x, workspace);
}

/// Whether the elements of a loop stay at a solution.
bool LoopJumps::rests(const Watched& watched, const Eigen::MatrixXd& rates) const {
  return watched.blind ? is_stable(rates)
                       : amplifier_motion(program_, watched.loop, rates) != AmplifierMotion::run_away;
}

/// Lets the unknowns follow what the elements give until they rest: implicit Euler steps, short at first so
/// that they go where the elements go, then ever longer until they are Newton's method. False where they do
/// not come to rest.
bool LoopJumps::follow(Watched& watched, Eigen::VectorXd& z, double t, std::span<const double> x,
                       network::Workspace& workspace) {
  constexpr double kMostChange = 0.2;  // of 1 + |z|, in a step
  constexpr double kSmallChange = 0.02;
  constexpr double kLongest = 1e18, kShortest = 1e-9;  // of a step, in lags
  constexpr double kAtRest = 1e-12;
  constexpr double kFarAway = 1e6;  // [machine unit]
  constexpr int kMostSteps = 500;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(z.size(), z.size());
  auto here = pull_at(watched, z, t, x, workspace);
  double h = 0.01, last = 1;
  for (int step = 0; here && step < kMostSteps && h > kShortest; ++step) {
    const auto matrix = (one / h + here->rates).partialPivLu();
    if (!(matrix.determinant() > 0)) {
      h /= 4;
      continue;
    }
    const Eigen::VectorXd next = z + matrix.solve(here->residuals);
    const double change = part_between(z, next);
    if (!(change < kMostChange)) {
      h /= 4;
      continue;
    }
    z = next;
    if (h >= kLongest && change < kAtRest && change >= last) return rests(watched, here->rates);
    if (z.cwiseAbs().maxCoeff() > kFarAway) return false;
    here = pull_at(watched, z, t, x, workspace);
    last = change;
    if (h < kLongest && change < kSmallChange) {
      h *= 10;
    } else if (h < kLongest && change < kMostChange / 2) {
      h *= 2;
    }
  }
  return false;
}

/// Puts a loop of elements without memory that would run away from where it is, and that its elements, as far
/// as they are its unknowns, have led nowhere from where it was, at the solution nearest to that at which it
/// rests. It is sought from points that fill the machine's range evenly; false where there is none.
bool LoopJumps::leave(Watched& watched, double t, std::span<const double> x) {
  constexpr int kMostSearches = 8;
  if (!watched.blind || watched.searches >= kMostSearches) return false;
  const std::vector<std::size_t>& unknowns = program_.loops()[watched.loop].unknowns;
  const Eigen::VectorXd before = unknowns_of(watched, unknowns_);
  double nearest = std::numeric_limits<double>::infinity();
  std::optional<network::Workspace> found;
  for (int k = 1; k <= kLoopPoints; ++k) {
    network::Workspace trial = workspace_;
    const std::vector<double> z = loop_point(program_, watched.loop, k);
    trial.hold_loop(watched.loop, t, z, true);
    watched.placing.place(t, x.data(), trial, &thresholds_);
    trial.hold_loop(watched.loop, std::numeric_limits<double>::quiet_NaN(), {}, false);
    for (std::size_t i = 0; i < unknowns.size(); ++i) trial.set_unknown(unknowns[i], z[i]);
    const auto here = pull(watched, t, x, trial);
    if (!here || !rests(watched, here->rates)) continue;
    std::vector<double> there;
    for (std::size_t u = 0; u < unknowns_.size(); ++u) there.push_back(trial.unknown(u));
    const double distance = part_between(before, unknowns_of(watched, there));
    if (!(distance < nearest)) continue;
    nearest = distance;
    found = std::move(trial);
  }
  if (!found) {
    ++watched.searches;
    return false;
  }
  workspace_.load_discrete_states(found->discrete_states());
  for (const std::size_t u : unknowns) workspace_.set_unknown(u, found->unknown(u));
  return true;
}

/// Puts a loop where its elements take it from where it was; false where that leads nowhere, or where it is
/// there.
bool LoopJumps::go_from_before(Watched& watched, double t, std::span<const double> x) {
  network::Workspace trial = workspace_;
  for (const std::uint32_t d : watched.placing.discrete_states())
    trial.set_discrete_state(d, discrete_states_[d]);
  Eigen::VectorXd z = unknowns_of(watched, unknowns_);
  if (!follow(watched, z, t, x, trial)) return false;
  trial.hold_loop(watched.loop, std::numeric_limits<double>::quiet_NaN(), {}, false);
  if (!pull(watched, t, x, trial)) return false;
  std::vector<double> there, here;
  for (std::size_t u = 0; u < unknowns_.size(); ++u) {
    there.push_back(trial.unknown(u));
    here.push_back(workspace_.unknown(u));
  }
  if (part_between(z, unknowns_of(watched, there)) > kJump) return false;
  const bool same = std::equal(trial.discrete_states().begin(), trial.discrete_states().end(),
                               workspace_.discrete_states().begin()) &&
                    part_between(unknowns_of(watched, here), unknowns_of(watched, there)) <= kJump;
  if (same) return false;
  workspace_.load_discrete_states(trial.discrete_states());
  for (std::size_t u = 0; u < there.size(); ++u) workspace_.set_unknown(u, there[u]);
  return true;
}

}  // namespace oblique::solve
