// SPDX-License-Identifier: MIT
#include <oblique/commission/judge.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/patch/triad_split.h>
#include <oblique/solve/operating_point/quasi_steady.h>
#include <oblique/solve/solve_error.h>
#include <oblique/solve/stability/loop_report.h>
#include <oblique/solve/stability/stability_report.h>

namespace oblique::commission {
namespace {

/// Four degrees of a crank's turn apart.
constexpr std::size_t kInstants = 91;
constexpr double kLeastShare = 0.05;  ///< of a servo amplifier in a mode that is worth a name

void find_largest_signal(const network::Program& program, const std::vector<solve::Instant>& instants,
                         Judgement& judgement) {
  network::Workspace workspace(program);
  std::vector<double> values(program.n_signals());
  for (const solve::Instant& instant : instants) {
    workspace.load_discrete_states(instant.discrete_states);
    const bool known =
        program.signals(instant.t, instant.states.data(), values.data(), workspace).has_value();
    for (std::size_t s = 0; known && s < values.size(); ++s) {
      if (std::abs(values[s]) <= judgement.largest) continue;
      judgement.largest = std::abs(values[s]);
      judgement.largest_signal = program.signal_names()[s];
    }
  }
}

std::vector<std::string> main_participants(const network::Program& program, const solve::Mode& mode) {
  std::vector<std::string> names;
  for (const solve::Participation& part : mode.participants) {
    if (part.share > kLeastShare) names.push_back(program.states()[part.state].name);
  }
  return names;
}

std::string name_some(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 3;
  const std::vector<std::string> shown(
      names.begin(), names.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, names.size())));
  return fmt::format("'{}'{}", fmt::join(shown, "', '"), names.size() > kMost ? " …" : "");
}

/// The settings in which the two differ.
text::Remedy difference(const patch::PatchOptions& from, const patch::PatchOptions& to) {
  text::Remedy settings;
  if (to.split != from.split)
    settings += {text::Setting{"split", fmt::format("{}", fmt::join(to.split, ","))}};
  if (to.slower == from.slower) return settings;
  if (!settings.empty()) settings += " ";
  settings += {text::Setting{"slower", fmt::format("{:g}", to.slower.value_or(patch::kUsualSlower))}};
  return settings;
}

/// Other ways to patch the same triad, in the order in which they are worth a trial: slower outer loops with
/// the split that is there, then other splits.
std::vector<patch::PatchOptions> other_ways(const mechanism::Mechanism& mechanism,
                                            const patch::PatchOptions& options) {
  std::vector<patch::PatchOptions> ways;
  const auto add = [&](const std::vector<std::string>& split, double slower) {
    patch::PatchOptions& way = ways.emplace_back(options);
    way.split = split;
    way.split_by_trial = options.split.empty();
    way.slower = slower;
  };
  const double usual = std::max(options.slower.value_or(0), patch::kUsualSlower);
  if (options.method == patch::PatchMethod::paper) {
    for (const double slower : {1.0, 10.0, 100.0}) add(options.split, slower * usual);
  }
  std::vector<std::vector<std::string>> splits = patch::useful_splits(mechanism);
  if (splits.empty()) splits.push_back(options.split);
  for (const double slower : {1.0, 10.0}) {
    for (const std::vector<std::string>& split : splits) add(split, slower * usual);
  }
  return ways;
}

/// Whether nobody asked for another way: the split of a triangle patch is free, and so is the speed of an
/// outer loop.
bool may_choose(const patch::PatchOptions& options, const patch::PatchOptions& way) {
  if (!options.split.empty() || options.slower) return false;
  return options.method == patch::PatchMethod::triangles || way.split.empty();
}

/// Lets the diagram start where the exact motion has it, and end about when what grows from the static error
/// of 1/μ fills the machine.
void show_the_fault(JudgedPatch& patched) {
  diagram::RunSettings& run = patched.diagram.run;
  const Judgement& judgement = patched.judgement;
  run.settle = false;
  if (!judgement.grows_from) return;
  run.until = std::min(run.until, *judgement.grows_from + std::log(patched.options.gain) / judgement.growth);
}

}  // namespace

std::string fault_of(const Judgement& judgement) {
  if (!judgement.no_rest.empty()) return fmt::format("its loops cannot follow: {}", judgement.no_rest);
  if (judgement.good()) {
    return fmt::format("it is badly damped: the loops {} oscillate for long before they settle (ζ = {:.2g})",
                       name_some(judgement.swinging), judgement.damping);
  }
  std::string text = fmt::format("it is unstable: the loops {} diverge, at {:.3g} 1/s at t = {:.6g} s",
                                 name_some(judgement.growing), judgement.slowest_pole, judgement.pole_time);
  if (!judgement.flips.empty()) {
    text += fmt::format("; the gain of '{}' changes its sign at t = {:.6g} s", judgement.flips.front().loop,
                        judgement.flips.front().time);
  }
  return text;
}

bool Judgement::well_damped() const {
  return good() && damping >= solve::kBadDamping;
}

namespace {

Judgement judge_at(const std::vector<solve::Instant>& instants, const diagram::FlatDiagram& flat,
                   const network::Program& program) {
  Judgement judgement;
  judgement.slowest_pole = -std::numeric_limits<double>::infinity();
  const solve::SignalFlow flow(flat, program);
  const solve::StabilityReport stability = solve::judge_stability(program, flow, instants, {}, false);
  if (stability.slowest_servo) {
    judgement.slowest_pole = stability.slowest_servo->mode.pole.real();
    judgement.pole_time = stability.slowest_servo->time;
  }
  if (stability.servo_mode) {
    judgement.damping = stability.servo_mode->mode.damping_ratio();
    judgement.swinging = main_participants(program, stability.servo_mode->mode);
  }
  judgement.grows_from = stability.grows_from;
  if (stability.grows_from) {
    const auto first = std::find_if(instants.begin(), instants.end(), [&](const solve::Instant& instant) {
      return instant.t == *stability.grows_from;
    });
    judgement.growth =
        solve::judge_stability(program, flow, {*first}, {}, false).slowest_servo->mode.pole.real();
    judgement.growing = main_participants(program, stability.slowest_servo->mode);
    for (const solve::LoopReport& loop : solve::explain_loops(program, flow, instants)) {
      for (const solve::LoopUnknown& unknown : loop.unknowns) {
        if (!unknown.sign_changes.empty())
          judgement.flips.push_back({unknown.signal, unknown.sign_changes.front()});
      }
    }
  }
  find_largest_signal(program, instants, judgement);
  return judgement;
}

/// At so many moments of its run with instant servos, the first one the start.
Judgement judge_moments(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                        std::size_t moments) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  std::vector<solve::Instant> instants;
  try {
    instants = solve::quasi_steady_instants(program, flat, solve::options_of(diagram.run), moments);
  } catch (const solve::SolveError& error) {
    Judgement judgement;
    judgement.slowest_pole = -std::numeric_limits<double>::infinity();
    judgement.no_rest = error.diagnostics().front().what;
    return judgement;
  }
  return judge_at(instants, flat, program);
}

}  // namespace

Judgement judge(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  return judge_moments(diagram, library, kInstants);
}

Judgement judge_start(diagram::Diagram diagram, const diagram::BlockLibrary& library) {
  constexpr double kMoment = 1e-9;  // of the run
  diagram.run.until *= kMoment;
  return judge_moments(diagram, library, 1);
}

Judgement judge_along_run(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  const network::Program program(network::assemble(flat));
  solve::RunOptions options = solve::options_of(diagram.run);
  std::vector<solve::Instant> instants;
  solve::collect_instants(options, kInstants, instants);
  solve::run(program, flat, options);
  return judge_at(instants, flat, program);
}

JudgedPatch judged_patch(const mechanism::Mechanism& mechanism, const diagram::BlockLibrary& library,
                         const patch::PatchOptions& options) {
  const auto attempt = [&](const patch::PatchOptions& way) {
    JudgedPatch result{patch::patch(mechanism, way), way, {}};
    result.diagram.file = mechanism.file;
    result.judgement = judge(result.diagram, library);
    return result;
  };
  JudgedPatch first = attempt(options);
  if (first.judgement.good()) return first;
  if (options.force) {
    show_the_fault(first);
    return first;
  }
  text::Remedy help;
  if (options.method != patch::PatchMethod::gradient) {
    for (const patch::PatchOptions& way : other_ways(patch::within_range(mechanism), options)) {
      JudgedPatch other = attempt(way);
      if (!other.judgement.good()) continue;
      if (may_choose(options, way)) return other;
      help = difference(options, way);
      help += " is stable; ";
      break;
    }
  }
  help += {text::Setting{"method", "gradient"}, " patches any mechanism"};
  throw patch::PatchError(
      text::Diagnostic{{mechanism.file, {}},
                       fmt::format("this patch would not run: {}", fault_of(first.judgement)),
                       "servo loops that settle everywhere along the motion",
                       help})
      .forcible();
}

}  // namespace oblique::commission
