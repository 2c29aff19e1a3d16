// SPDX-License-Identifier: MIT
#include <oblique/solve/events/branch_end.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/network/program/program.h>
#include <oblique/solve/run_errors.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/amplifier_motion.h>

namespace oblique::solve {
namespace {

constexpr double kJump = 1e-3;  ///< of 1 + |z|: a smooth way does not change by this in a moment

bool held_by_amplifier(const network::Program& program, std::size_t unknown) {
  return program.unknowns()[unknown].held_by_amplifier;
}

std::string amplifier_names(const network::Program& program, std::size_t loop) {
  std::vector<std::string> names;
  for (const std::size_t u : program.loops()[loop].unknowns) {
    if (held_by_amplifier(program, u)) names.push_back(fmt::format("'{}'", program.unknowns()[u].name));
  }
  return shortened(names);
}

text::Diagnostic unstable_warning(const network::Program& program, const network::Workspace& workspace,
                                  std::size_t loop, AmplifierMotion motion, double t,
                                  const std::string& file) {
  const std::size_t first = program.loops()[loop].unknowns.front();
  return {
      {file, {}},
      fmt::format("from t = {:.6g} s on the equations of {} are solved where a machine would not settle: its "
                  "amplifiers {} {} = {:.6g}",
                  t, amplifier_names(program, loop),
                  motion == AmplifierMotion::swing ? "swing about" : "run away from",
                  program.unknowns()[first].name, workspace.unknown(first)),
      {},
      "reverse the signs at the amplifier's inputs, give it another 'initial', or a finite gain and "
      "bandwidth to see what a machine does"};
}

/// Whether a run looks at what the amplifiers of a loop do. (Of a large loop without branches `check` tells.)
bool is_judged(const network::Program& program, std::size_t loop) {
  constexpr std::size_t kMostUnknowns = 60;
  const std::vector<std::size_t>& unknowns = program.loops()[loop].unknowns;
  return program.loop_has_branches(loop) ||
         (unknowns.size() <= kMostUnknowns &&
          std::any_of(unknowns.begin(), unknowns.end(),
                      [&](std::size_t u) { return held_by_amplifier(program, u); }));
}

/// The largest change of an unknown of a loop, of 1 + |z|.
double change_of(const network::Program& program, const network::Workspace& workspace, std::size_t loop,
                 const std::vector<double>& before) {
  double change = 0;
  for (const std::size_t u : program.loops()[loop].unknowns)
    change = std::max(change, std::abs(workspace.unknown(u) - before[u]) / (1 + std::abs(before[u])));
  return change;
}

/// At least so often a loop that no derivative needs is looked at over a run, however few its rows are: where
/// its branch has ended it may have begun anew by the next.
constexpr int kFewestPlaces = 1000;

}  // namespace

BranchWatch::BranchWatch(const network::Program& program, network::Workspace& workspace, double begin,
                         const RunOptions& options, const std::string& file)
    : program_(program),
      workspace_(workspace),
      file_(file),
      span_(options.until - begin),
      apart_(span_ / std::max(kFewestPlaces, options.samples - 1)),
      resolution_(1e-10 * span_),
      stood_(program.unknowns().size()),
      judged_(program.loops().size()) {
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    told_.push_back(!is_judged(program, loop));
    if (program.loop_is_linear(loop)) continue;
    any_ = true;
    unseen_ = unseen_ || !program.derivatives_need(loop);
  }
}

std::optional<double> BranchWatch::find(double from, std::span<const double> times,
                                        const Interpolant& solution) {
  return unseen_ ? search(from, times, apart_, solution) : std::nullopt;
}

void BranchWatch::stand_at(double t) {
  reached_ = t;
  for (std::size_t u = 0; u < stood_.size(); ++u) stood_[u] = workspace_.unknown(u);
}

/// Whether the unknowns of loops that are not linear have gone so far from where the search stands that they
/// may have leapt to another branch, which the search for a solution does not notice where the inputs of the
/// loop have gone far, too. They are then put back.
bool BranchWatch::leaps() {
  constexpr double kFar = 0.25;  // of 1 + |z|: between the branches of a loop lies more, but near their ends
  bool leapt = false;
  for (std::size_t loop = 0; loop < program_.loops().size() && !leapt; ++loop)
    leapt = !program_.loop_is_linear(loop) && change_of(program_, workspace_, loop, stood_) > kFar;
  for (std::size_t u = 0; leapt && u < stood_.size(); ++u) workspace_.set_unknown(u, stood_[u]);
  return leapt;
}

std::optional<double> BranchWatch::search(double from, std::span<const double> times, double longest,
                                          const Interpolant& solution) {
  std::vector<double> states(program_.n_states()), signals(program_.n_signals());
  const auto has_value = [&](double t) {
    solution.states_at(t, states);
    return program_.signals(t, states.data(), signals.data(), workspace_).has_value();
  };
  double t = from, step = longest;
  bool stands = has_value(from);  // the unknowns may come from elsewhere
  if (!stands && from == reached_) {
    for (std::size_t u = 0; u < stood_.size(); ++u) workspace_.set_unknown(u, stood_[u]);
    stands = has_value(from);
  }
  for (auto next = times.begin(); next != times.end();) {
    if (!(*next > t)) {
      ++next;
      continue;
    }
    const double target = step < *next - t ? t + step : *next;
    stand_at(t);
    const bool known = has_value(target), leapt = known && stands && leaps();
    if (known && !leapt) {
      stands = true;
      t = target;
      step = std::min(2 * step, longest);
    } else if (target - t > resolution_) {
      step = (target - t) / 2;
    } else if (leapt || workspace_.trouble().failure == network::LoopFailure::lost) {
      return target;
    } else {
      break;  // whoever looks there next says what is wrong
    }
  }
  if (!times.empty() && t == times.back()) stand_at(t);
  return std::nullopt;
}

BranchWatch::Ahead BranchWatch::look_ahead(double& t, double segment_end, std::vector<double>& states,
                                           const Interpolant& solution) {
  if (!any_ || workspace_.trouble().failure != network::LoopFailure::lost) return Ahead::nothing;
  std::vector<double> derivatives(states.size());
  // Next to the end dx/dt itself may have no value any more.
  if (!program_.derivatives(t, states.data(), derivatives.data(), workspace_))
    solution.rates_at(t, derivatives);
  const StraightLine ahead(t, states, derivatives);
  // Of the run: the square of the farther one, the error of a straight line, is below every tolerance.
  const bool twice = tried_ && t <= *tried_;
  tried_ = t;
  const double sight = (twice ? 1e-6 : 1e-9) * span_;
  const double far = std::min(t + sight, segment_end);
  const auto end = search(t, {&far, 1}, sight, ahead);
  if (!end) return twice ? Ahead::nothing : Ahead::not_yet;
  ahead.states_at(*end, states);
  t = *end;
  return Ahead::end;
}

void BranchWatch::pass(double t, const std::vector<double>& states,
                       const std::function<bool(std::size_t)>& go) {
  std::vector<double> before, signals(program_.n_signals());
  for (std::size_t u = 0; u < program_.unknowns().size(); ++u) before.push_back(workspace_.unknown(u));
  const std::size_t lost = workspace_.trouble().loop;
  const bool gone = go(lost);
  const auto here = program_.signals(t, states.data(), signals.data(), workspace_);
  if (!here) {
    network::Workspace::Trouble trouble = workspace_.trouble();
    if (!program_.loop_is_linear(trouble.loop)) trouble.failure = network::LoopFailure::lost;
    throw loop_error(program_, trouble, t, file_);
  }
  for (std::size_t loop = 0; loop < program_.loops().size(); ++loop) {
    if (program_.loop_is_linear(loop)) continue;
    const bool jumps = change_of(program_, workspace_, loop, before) > kJump;
    const bool is_held = program_.loop_has_branches(loop);
    const AmplifierMotion motion =
        is_held ? amplifier_motion(program_, loop, here->loop_jacobian(loop)) : AmplifierMotion::rest;
    if (is_held ? motion != AmplifierMotion::run_away : loop != lost || gone) {
      if (!jumps) continue;
      std::vector<std::string> ways;
      for (const std::size_t u : program_.loops()[loop].unknowns) {
        if (held_by_amplifier(program_, u) || !is_held)
          ways.push_back(fmt::format("{} from {:.6g} to {:.6g}", program_.unknowns()[u].name, before[u],
                                     workspace_.unknown(u)));
      }
      jumps_.push_back({t, "jumps where its branch ends: " + shortened(ways)});
    } else if (jumps) {
      const std::size_t first = program_.loops()[loop].unknowns.front();
      throw loop_error(program_, {loop, network::LoopFailure::lost, 0, before[first]}, t, file_);
    } else if (!told_[loop]) {
      told_[loop] = true;
      warnings_.push_back(unstable_warning(program_, workspace_, loop, motion, t, file_));
    }
  }
}

void BranchWatch::look(double t, const std::vector<double>& states, bool told,
                       const std::function<bool(std::size_t)>& mixes) {
  const bool all_told = std::find(told_.begin(), told_.end(), false) == told_.end();
  if (all_told) return;
  std::vector<double> signals(program_.n_signals());
  const auto here = program_.signals(t, states.data(), signals.data(), workspace_);
  if (!here) return;  // whoever looks there next says what is wrong
  for (std::size_t loop = 0; loop < told_.size(); ++loop) {
    if (told_[loop] || mixes(loop)) continue;
    Eigen::MatrixXd jacobian = here->loop_jacobian(loop);
    const bool first = judged_[loop].size() == 0;
    if (!first && jacobian == judged_[loop]) continue;  // of linear equations, at most events
    const AmplifierMotion motion = amplifier_motion(program_, loop, jacobian);
    judged_[loop] = std::move(jacobian);
    if (motion == AmplifierMotion::rest) continue;
    told_[loop] = true;
    if (!told) warnings_.push_back(unstable_warning(program_, workspace_, loop, motion, t, file_));
  }
}

std::vector<EventRecord> BranchWatch::merged_with(std::vector<EventRecord> events) const {
  const auto middle = static_cast<std::ptrdiff_t>(events.size());
  events.insert(events.end(), jumps_.begin(), jumps_.end());
  std::inplace_merge(events.begin(), events.begin() + middle, events.end(),
                     [](const EventRecord& a, const EventRecord& b) { return a.time < b.time; });
  return events;
}

std::vector<text::Diagnostic> unstable_branches(const network::Program& program,
                                                network::Workspace& workspace, double t,
                                                const std::vector<double>& states, const std::string& file) {
  std::vector<std::size_t> judged;
  for (std::size_t loop = 0; loop < program.loops().size(); ++loop) {
    if (is_judged(program, loop)) judged.push_back(loop);
  }
  std::vector<text::Diagnostic> warnings;
  if (judged.empty()) return warnings;
  std::vector<double> signals(program.n_signals());
  const auto here = program.signals(t, states.data(), signals.data(), workspace);
  if (!here) throw loop_error(program, workspace.trouble(), t, file);
  for (const std::size_t loop : judged) {
    const AmplifierMotion motion = amplifier_motion(program, loop, here->loop_jacobian(loop));
    if (motion != AmplifierMotion::rest)
      warnings.push_back(unstable_warning(program, workspace, loop, motion, t, file));
  }
  return warnings;
}

}  // namespace oblique::solve
