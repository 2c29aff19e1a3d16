// SPDX-License-Identifier: MIT
#include <oblique/report/diagram_check_text.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/solve/operating_point/rest.h>

#include <oblique/network/program/program.h>
#include <oblique/report/component_list_text.h>
#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

constexpr std::size_t kMostNamed = 6;
constexpr std::size_t kMostRows = 40;

std::string number(double value) {
  return fmt::format("{:.3g}", value + 0.0);  // no "-0"
}

/// "a, b, c", shortened in the middle.
std::string names(std::vector<std::string> all) {
  if (all.size() > kMostNamed + 1) {
    const auto half = static_cast<std::ptrdiff_t>(kMostNamed / 2);
    all.erase(all.begin() + half, all.end() - half);
    all.insert(all.begin() + half, "…");
  }
  return fmt::format("{}", fmt::join(all, ", "));
}

std::string contents(const DiagramCheck& check) {
  const network::Program& program = check.program;
  std::string text = fmt::format("{}: a diagram, \"{}\"\n", check.file, check.diagram.title);
  text += fmt::format("  {}; flattened: {}\n", count(check.diagram.blocks.size(), "block", "blocks"),
                      count(check.flat.blocks.size(), "element", "elements"));
  text += fmt::format("  {}, {} of them servo amplifiers brought to rest at the start\n",
                      count(program.n_states(), "state", "states"), solve::rest_states(program).size());
  for (const network::Loop& loop : program.loops()) {
    text += fmt::format("  algebraic loop with {}: {}\n", count(loop.unknowns.size(), "unknown", "unknowns"),
                        fmt::join(loop.members, ", "));
  }
  if (program.loops().empty()) text += "  no algebraic loops\n";
  text += fmt::format("  {}\n", count(check.flat.outputs.size(), "output", "outputs"));
  return text + "ok: all names, wires, units and ranges are right\n";
}

std::string trial(const DiagramCheck& check) {
  const solve::Analysis& analysis = check.analysis;
  if (analysis.instants.empty())
    return "\ntrial run: it could not start, so nothing is known about its loops\n";
  if (analysis.failure) {
    return fmt::format("\ntrial run: failed at t = {:.6g} s; what follows is about {}\n",
                       analysis.failure->time(),
                       analysis.quasi_steady ? "the servo loops standing at rest, where they would not stay"
                                             : "the time before");
  }
  std::string text =
      fmt::format("\ntrial run: {:.6g} s, {}", check.diagram.run.until,
                  count(static_cast<std::size_t>(analysis.run->statistics.steps), "step", "steps"));
  if (check.program.n_states() > 0) {
    text += fmt::format(", method {}: {}", diagram::method_name(analysis.run->method.method),
                        analysis.run->method.reason);
  }
  return text + "\n";
}

std::string sign_text(const solve::LoopUnknown& unknown) {
  if (unknown.sign_changes.empty()) return unknown.sign > 0 ? "keeps +" : unknown.sign < 0 ? "keeps −" : "0";
  std::string text = "changes at t =";
  for (std::size_t k = 0; k < std::min<std::size_t>(unknown.sign_changes.size(), 3); ++k) {
    text += fmt::format("{} {}", k == 0 ? "" : ",", number(unknown.sign_changes[k]));
  }
  return text + (unknown.sign_changes.size() > 3 ? ", …" : "");
}

std::string loops(const std::vector<solve::LoopReport>& loops) {
  if (loops.empty()) return "\nloops: no servo loops and no algebraic ones\n";
  Table table({"unknown", "loop", "kind", "least gain", "at t [s]", "static error", "time constant [s]",
               "sign of derivative", "members"});
  for (const solve::LoopReport& loop : loops) {
    for (const solve::LoopUnknown& unknown : loop.unknowns) {
      const bool first = &unknown == &loop.unknowns.front();
      table.add({unknown.signal, loop.algebraic ? "algebraic" : "servo", std::string(kind_name(loop.kind)),
                 number(unknown.least_gain), number(unknown.least_time),
                 unknown.static_error ? number(*unknown.static_error) : "exact",
                 loop.time_constant ? number(*loop.time_constant) : "–", sign_text(unknown),
                 first ? names(loop.members) : "as above"});
    }
  }
  return "\nloops (gain with the rest of the loop closed; static error relative to the signal)\n" +
         table.text(3);
}

std::string mode_text(const char* whose, const std::optional<solve::WorstMode>& worst,
                      const network::Program& program) {
  if (!worst) return fmt::format("  no mode of {}\n", whose);
  const solve::Mode& mode = worst->mode;
  std::string text =
      fmt::format("  {}: {}, ω₀ = {} rad/s, ζ = {}, pole {}", whose, verdict_name(solve::verdict_on(*worst)),
                  number(mode.natural_frequency()), number(mode.damping_ratio()), number(mode.pole.real()));
  if (mode.pole.imag() != 0) text += fmt::format(" ± {}i", number(mode.pole.imag()));
  text += fmt::format(" 1/s at t = {} s\n    elements:", number(worst->time));
  constexpr double kLeastShare = 0.01;
  for (std::size_t k = 0; k < std::min(mode.participants.size(), kMostNamed); ++k) {
    const auto& [state, share] = mode.participants[k];
    if (share < kLeastShare) {
      if (k == 0) text += " many, each by less than 1 %";
      break;
    }
    text += fmt::format("{} {} {:.0f} %", k == 0 ? "" : ",", program.states()[state].name, 100 * share);
  }
  return text + "\n";
}

std::string growth_text(const solve::DisturbanceGrowth& growth) {
  return fmt::format(
      "a small disturbance of the start is {:.3g} times as large at the end, {:+.3g} 1/s in the "
      "second half",
      growth.factor, growth.exponent);
}

std::string stability(const solve::StabilityReport& report, const network::Program& program,
                      bool has_servo_loops) {
  std::string text = fmt::format("\nstability (worst modes of the frozen equations at {})\n",
                                 count(report.instants, "instant", "instants"));
  text += fmt::format("  verdict: {}\n", verdict_text(report));
  if (report.growing > 0)
    text += fmt::format("  right of the axis: {}\n", count(report.growing, "eigenvalue", "eigenvalues"));
  if (report.growth) text += fmt::format("  along the run: {}\n", growth_text(*report.growth));
  // Without loops around them what is left of amplifiers is the pole of each.
  const char* const servos = has_servo_loops ? "the servo amplifiers" : "the amplifiers by themselves";
  text += mode_text(servos, report.servo_mode, program);
  if (report.slowest_servo) {
    text += fmt::format("    largest real part of their eigenvalues: {:+.3g} 1/s at t = {} s\n",
                        report.slowest_servo->mode.pole.real(), number(report.slowest_servo->time));
  }
  if (report.grows_from) {
    text +=
        fmt::format("    no: the servo loops are unstable from t = {} s on\n", number(*report.grows_from));
  }
  text += mode_text("the problem itself", report.problem_mode, program);
  if (!report.margins.empty()) {
    Table table({"servo amplifier", "phase margin [°]", "crossover [rad/s]", "at t [s]"});
    for (const solve::ServoMargin& servo : report.margins) {
      const std::string& name = program.states()[servo.state].name;
      if (servo.margin) {
        table.add({name, fmt::format("{:.1f}", servo.margin->degrees), number(servo.margin->frequency),
                   number(servo.time)});
      } else {
        table.add({name, "∞", "–", "–"});
      }
    }
    text += table.text(1);
  }
  for (const std::string& what : report.left_out) text += fmt::format("  left out: {}\n", what);
  return text;
}

std::string overloads(const DiagramCheck& check, const text::Vocabulary& vocabulary) {
  const auto& found = check.in_full().run->overloads;
  if (found.empty()) return "\noverloads: none, every signal stays within ±1 machine unit\n";
  Table table({"signal", "first at t [s]", "peak", "at t [s]", "duration [s]", "suggested scale factor"});
  for (std::size_t k = 0; k < std::min(found.size(), kMostRows); ++k) {
    const solve::OverloadRecord& o = found[k];
    table.add({check.program.signal_names()[o.signal], short_number(o.first), short_number(o.peak.value),
               short_number(o.peak.time), short_number(o.duration), short_number(o.suggested_scale)});
  }
  std::string text =
      fmt::format("\noverloads{}\n",
                  check.unsaturated ? " (as far as signals would go if no amplifier saturated)" : "") +
      table.text(1);
  if (found.size() > kMostRows)
    text += fmt::format("({} more; {} lists all)\n", found.size() - kMostRows, vocabulary.setting({"json"}));
  return text;
}

std::string scaling(const DiagramCheck& check, const text::Vocabulary& vocabulary) {
  const ScalingProposal& proposal = *check.scaling;
  Table table({"signal", "peak", "at t [s]", "scale", "scaled peak"});
  std::size_t scaled = 0;
  for (std::size_t s = 0; s < proposal.signals.size(); ++s) {
    if (proposal.signals[s] == 1 || ++scaled > kMostRows) continue;
    const solve::Peak& peak = check.in_full().run->peaks[s];
    table.add({check.program.signal_names()[s], short_number(peak.value), short_number(peak.time),
               short_number(proposal.signals[s]), short_number(proposal.signals[s] * peak.value)});
  }
  std::string text = fmt::format("\nproposed scaling ({} writes it)\n", vocabulary.setting({"rescale"}));
  if (scaled > 0) text += table.text(1);
  if (scaled > kMostRows)
    text += fmt::format("({} more; {} lists all)\n", scaled - kMostRows, vocabulary.setting({"json"}));
  text += fmt::format("  {} as they are\n", count(proposal.signals.size() - scaled, "signal", "signals"));
  text +=
      fmt::format("  time scale: 1 s of the diagram in {} s of the machine\n", number(proposal.time_scale));
  return text;
}

}  // namespace

std::string verdict_text(const solve::StabilityReport& report) {
  const auto pole = [](const solve::WorstMode& worst) {
    const solve::Mode& mode = worst.mode;
    return mode.pole.imag() == 0
               ? fmt::format("{:+.3g} 1/s", mode.pole.real())
               : fmt::format("{:+.3g} ± {}i 1/s", mode.pole.real(), number(mode.pole.imag()));
  };
  switch (report.verdict) {
    case solve::StabilityVerdict::no_feedback:
      return report.switches ? "no state acts back on itself between events; what switches and stores bring "
                               "back is not told"
                             : "no state acts back on itself, so that nothing grows or decays by itself";
    case solve::StabilityVerdict::stable:
      if (!report.proven) return "stable as far as was found: no mode that grows, which is no proof";
      return report.varies
                 ? "stable along this run: every frozen mode decays, and small disturbances do not grow"
                 : "stable: every mode of the closed system decays";
    case solve::StabilityVerdict::stable_when_frozen:
      return "every frozen mode decays; the equations vary along the run, and whether small disturbances "
             "grow "
             "on it is not known";
    case solve::StabilityVerdict::undamped:
      if (!report.proven) return "undamped as far as was found: no mode that grows, which is no proof";
      return "undamped: a mode neither decays nor grows, and none grows exponentially";
    case solve::StabilityVerdict::grows:
      if (report.rightmost && solve::verdict_on(*report.rightmost) == solve::ModeVerdict::grows) {
        const auto& ideal = report.rightmost->ideal_pole;
        const bool by_the_machine = ideal && ideal->real() < report.rightmost->mode.pole.real() / 2;
        if (!by_the_machine) return "the problem itself grows: " + pole(*report.rightmost);
        const std::complex<double> found = report.rightmost->mode.pole;
        const double turn = 2 * std::numbers::pi * found.real() / found.imag();
        return fmt::format(
            "the problem itself grows, a little, by the errors of the amplifiers: {}{}",
            pole(*report.rightmost),
            found.imag() == 0 ? "" : fmt::format(", by {:.2g} % a turn", 100 * std::expm1(turn)));
      }
      return "the problem itself grows along the run, although no frozen mode does";
    case solve::StabilityVerdict::grows_at_times:
      return fmt::format("a mode of the problem itself grows at times, {} at t = {} s, {}",
                         pole(*report.rightmost), number(report.rightmost->time),
                         !report.growth                   ? "and the growth along the run is not known"
                         : report.growth->does_not_grow() ? "and small disturbances do not grow along the run"
                                                          : "and hardly, or not for long, along the run");
    case solve::StabilityVerdict::servos_unstable:
      return fmt::format("unstable by the servo loops, not by the problem: {} at t = {} s",
                         pole(*report.slowest_servo), number(report.slowest_servo->time));
    case solve::StabilityVerdict::not_told:
      break;
  }
  return "not known from what was examined";
}

std::string_view verdict_name(solve::ModeVerdict verdict) {
  switch (verdict) {
    case solve::ModeVerdict::grows:
      return "grows";
    case solve::ModeVerdict::undamped:
      return "undamped";
    case solve::ModeVerdict::badly_damped:
      return "badly damped";
    case solve::ModeVerdict::well_damped:
      break;
  }
  return "well damped";
}

std::string_view verdict_name(solve::StabilityVerdict verdict) {
  switch (verdict) {
    case solve::StabilityVerdict::no_feedback:
      return "no feedback";
    case solve::StabilityVerdict::stable:
      return "stable";
    case solve::StabilityVerdict::stable_when_frozen:
      return "stable when frozen";
    case solve::StabilityVerdict::undamped:
      return "undamped";
    case solve::StabilityVerdict::grows:
      return "grows";
    case solve::StabilityVerdict::grows_at_times:
      return "grows at times";
    case solve::StabilityVerdict::servos_unstable:
      return "servo loops unstable";
    case solve::StabilityVerdict::not_told:
      break;
  }
  return "not told";
}

std::string_view kind_name(solve::LoopKind kind) {
  switch (kind) {
    case solve::LoopKind::linear:
      return "linear";
    case solve::LoopKind::varying:
      return "varying";
    case solve::LoopKind::non_linear:
      break;
  }
  return "non-linear";
}

std::string to_text(const DiagramCheck& check, const text::Vocabulary& vocabulary) {
  std::string text = contents(check);
  if (check.components) text += "\n" + to_text(*check.components);
  text += trial(check);
  if (!check.analysis.instants.empty()) {
    const std::vector<solve::LoopReport>& found = check.analysis.loops;
    const bool servos = std::any_of(found.begin(), found.end(),
                                    [](const solve::LoopReport& loop) { return !loop.algebraic; });
    text += loops(found) + stability(check.analysis.stability, check.program, servos);
  }
  if (check.analysis.run) text += overloads(check, vocabulary) + scaling(check, vocabulary);
  return text;
}

}  // namespace oblique::report
