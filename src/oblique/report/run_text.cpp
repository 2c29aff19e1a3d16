// SPDX-License-Identifier: MIT
#include <oblique/report/run_text.h>

#include <fmt/format.h>

namespace oblique::report {
namespace {

/// What lies in the middle of a long text, as the sum of a comparison, left out.
std::string without_middle(const std::string& text) {
  constexpr std::size_t kMost = 100, kAtEach = 45;  // bytes
  if (text.size() <= kMost) return text;
  const auto is_within = [&](std::size_t at) {
    return (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80U;
  };
  std::size_t head = kAtEach, tail = text.size() - kAtEach;
  while (head > 0 && is_within(head)) --head;
  while (tail < text.size() && is_within(tail)) ++tail;
  return text.substr(0, head) + " … " + text.substr(tail);
}

}  // namespace

Table rows_of(const solve::Trajectory& trajectory, std::size_t columns) {
  constexpr std::size_t kMostRows = 21;
  std::vector<std::string> header, units;
  for (std::size_t c = 0; c < columns; ++c) {
    header.push_back(trajectory.columns()[c].name);
    units.push_back("[" + trajectory.columns()[c].unit + "]");
  }
  Table table(header);
  table.add(units);
  for (const std::size_t row : spread_rows(trajectory.rows(), kMostRows)) {
    std::vector<std::string> cells;
    for (std::size_t c = 0; c < columns; ++c) cells.push_back(short_number(trajectory.at(row, c)));
    table.add(cells);
  }
  return table;
}

std::string events_text(const std::vector<solve::EventRecord>& events, long count) {
  Table table({"t [s]", "event"});
  for (const solve::EventRecord& event : events)
    table.add({fmt::format("{:.12g}", event.time), without_middle(event.what)});
  std::string text = table.text();
  if (count > static_cast<long>(events.size()))
    text += fmt::format("({} more)\n", count - static_cast<long>(events.size()));
  return text;
}

std::string static_test_text(const std::vector<solve::StaticReading>& readings) {
  Table table({"element", "", "output", "d/dt"});
  table.add({"", "", "[machine unit]", "[machine unit/s]"});
  for (const solve::StaticReading& reading : readings) {
    const char* const kind = !reading.derivative ? "" : reading.at_rest ? "brought to rest" : "state";
    table.add({reading.signal, kind, short_number(reading.output),
               reading.derivative ? short_number(*reading.derivative) : ""});
  }
  return table.text(2);
}

std::string solver_text(const network::Program& program, const solve::Run& run,
                        const solve::RunOptions& options) {
  std::string text = fmt::format("{}, {}; {} (relative tolerance {}), {:.3g} ms\n",
                                 count(program.n_states(), "state", "states"),
                                 count(program.loops().size(), "algebraic loop", "algebraic loops"),
                                 count(static_cast<std::size_t>(run.statistics.steps), "step", "steps"),
                                 options.tolerance, 1e3 * run.seconds);
  if (program.n_states() > 0)
    text += fmt::format("method {}: {}\n", diagram::method_name(run.method.method), run.method.reason);
  return text;
}

std::string warnings_text(const solve::Run& run, const text::Vocabulary& vocabulary) {
  std::string text;
  for (const text::Diagnostic& warning : run.warnings)
    text += "warning: " + text::to_string(warning, vocabulary) + "\n";
  return text;
}

std::string overloads_text(const network::Program& program, const solve::Run& run) {
  std::string text;
  for (const solve::OverloadRecord& o : run.overloads) {
    const std::string& name = program.signal_names()[o.signal];
    if (run.halted) {
      return fmt::format("overload: '{}' leaves ±1 machine unit at t = {:.10g} s; the run ends there\n", name,
                         o.first);
    }
    text +=
        fmt::format("overload: '{}' leaves ±1 machine unit at t = {:.6g} s, peak {:.6g}, {:.6g} s in all\n",
                    name, o.first, o.peak.value, o.duration);
  }
  return text;
}

std::string trust_text(const solve::Trust& trust) {
  if (trust.checks.empty())
    return fmt::format("trust: no estimate of the errors: {}\n",
                       trust.failure.empty() ? "interrupted" : trust.failure);
  std::string text = "trust: errors of the outputs, from";
  for (std::size_t k = 0; k < trust.checks.size(); ++k) {
    const solve::Trust::Check& check = trust.checks[k];
    text += fmt::format("{} a run at a tolerance of {:.3g} by {}", k == 0 ? "" : " and", check.tolerance,
                        diagram::method_name(check.method));
  }
  Table table({"output", "size", "largest error", "digits", "digits at the end", "no digit from [s]"});
  for (const solve::OutputError& output : trust.outputs) {
    table.add({output.name, short_number(output.size), fmt::format("{:.1e}", output.largest),
               fmt::format("{}", output.digits(output.largest)),
               fmt::format("{}", output.digits(output.at_end)),
               output.lost ? short_number(*output.lost) : ""});
  }
  text += "\n" + table.text();
  if (trust.event_shift > 0)
    text += fmt::format("trust: the times of events differ by {:.1e} s at most\n", trust.event_shift);
  if (trust.events_part) {
    text += fmt::format("warning: from t = {:.6g} s on the runs do not have the same events\n",
                        *trust.events_part);
  }
  if (!trust.has_states) {
    text +=
        "trust: the diagram integrates nothing, so that these runs round alike: what it makes of rounding, "
        "from "
        "event to event, is not in them\n";
  }
  if (!trust.failure.empty()) text += fmt::format("trust: one more run ended early: {}\n", trust.failure);
  return text;
}

}  // namespace oblique::report
