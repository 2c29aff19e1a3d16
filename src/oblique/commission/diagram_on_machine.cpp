// SPDX-License-Identifier: MIT
#include <oblique/commission/diagram_on_machine.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>

namespace oblique::commission {
namespace {

/// With what lies half way between the rows as `extra`.
solve::Run run_on_ideal_elements(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  const diagram::FlatDiagram flat = diagram::flatten_on_ideal_elements(diagram, library);
  solve::RunOptions options = solve::options_of(diagram.run);
  for (int row = 0; row + 1 < options.samples; ++row)
    options.extra_times.push_back((row + 0.5) * options.until / (options.samples - 1));
  return solve::run(network::Program(network::assemble(flat)), flat, options);
}

/// Of each row whether it lies at an event, where what jumps has two values.
std::vector<bool> rows_at_events(const solve::Trajectory& rows,
                                 const std::vector<solve::EventRecord>& events) {
  constexpr double kBeside = 1e-3;  // of the way between two rows
  std::vector<bool> found(rows.rows(), false);
  if (rows.rows() < 2) return found;
  const double begin = rows.at(0, 0), step = rows.at(1, 0) - begin;
  for (const solve::EventRecord& event : events) {
    const double place = (event.time - begin) / step, row = std::round(place);
    if (std::abs(place - row) <= kBeside && row >= 0 && row < static_cast<double>(found.size()))
      found[static_cast<std::size_t>(row)] = true;
  }
  return found;
}

/// The largest difference between two runs of the same outputs in the rows, and half way between them, over
/// the largest value of the output; one that `made` never brings to a millionth of the machine unit is
/// nothing. Those at events do not count. Where phases follow each other, integrators jump: nor does a row
/// that lies a rounding before such a jump in one of them alone.
double difference_of(const solve::Run& one, const solve::Run& other, const diagram::Diagram& made) {
  constexpr double kNothing = 1e-6;
  const bool has_phases = !made.timeline.phases.empty();
  double largest = 0;
  for (std::size_t c = 1; c < one.trajectory.columns().size(); ++c) {
    double size = 0, difference = 0;
    for (const auto of : {&solve::Run::trajectory, &solve::Run::extra}) {
      const solve::Trajectory &a = one.*of, &b = other.*of;
      const std::vector<bool> at_event = rows_at_events(a, one.events),
                              at_other_event = rows_at_events(b, other.events);
      const std::size_t rows = std::min(a.rows(), b.rows());
      for (std::size_t r = 0; r < rows; ++r) {
        size = std::max(size, std::abs(a.at(r, c)));
        if (at_event[r] || at_other_event[r]) continue;
        double here = std::abs(a.at(r, c) - b.at(r, c));
        for (const std::size_t beside : {r - 1, r + 1}) {
          if (has_phases && beside < rows) here = std::min(here, std::abs(a.at(r, c) - b.at(beside, c)));
        }
        difference = std::max(difference, here);
      }
    }
    const double unit = c <= made.outputs.size() ? std::abs(made.outputs[c - 1].scale) : 0;
    if (size > kNothing * unit) largest = std::max(largest, difference / size);
  }
  return largest;
}

bool has_servos(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  return std::any_of(diagram.blocks.begin(), diagram.blocks.end(), [&](const diagram::BlockInstance& block) {
    return library.find(block.type)->role == diagram::Role::open_amplifier;
  });
}

constexpr int kDecades = 12;  ///< by which servo amplifiers may be slowed

/// Of a trial run on the machine's elements: one that takes more will not tell how far its signals go, since
/// its loops swing, or jump without end, by the errors of their elements.
constexpr std::int64_t kMostSteps = 200'000;

/// The speeds that servo amplifiers are tried at, each less than the one before.
std::vector<double> loop_speeds() {
  std::vector<double> speeds;
  for (int decade = 1; decade <= kDecades; ++decade) {
    for (const double step : {5.0, 2.0, 1.0}) speeds.push_back(step / std::pow(10.0, decade));
  }
  return speeds;
}

/// Where the errors of elements leave instant loops no rest, at the start perhaps alone, the run itself shows
/// how they fare.
Judgement judge_loops(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  diagram::Diagram limited = diagram;
  limited.run.max_steps = std::min(limited.run.max_steps, kMostSteps);
  Judgement at_rest = judge(limited, library);
  if (at_rest.no_rest.empty()) return at_rest;
  try {
    return judge_along_run(limited, library);
  } catch (const solve::SolveError&) {
    return at_rest;
  }
}

/// Slows the servo amplifiers where the machine's elements are slow beside their loops, by bisection: what is
/// slow enough is taken to stay so when slower. Where that finds nothing for loops that are stable, since
/// they can be too slow for what they follow as well, decade after decade is tried.
void fit_loops(const machine::MachineScaling& scaling, const diagram::BlockLibrary& library,
               DiagramOnMachine& result) {
  result.loops = judge_loops(result.made.diagram, library);
  if (result.loops->well_damped()) return;
  result.loop_fault = fault_of(*result.loops);
  const std::vector<double> speeds = loop_speeds();
  for (const auto is_fine : {&Judgement::well_damped, &Judgement::good}) {
    const auto takes = [&](double speed) {
      machine::ScaledRealisation slower = scaling.realise(speed);
      Judgement loops = judge_loops(slower.diagram, library);
      if (!(loops.*is_fine)()) return false;
      result.made = std::move(slower);
      result.loops = std::move(loops);
      result.loop_speed = speed;
      return true;
    };
    bool found = false;
    for (auto from = speeds.begin(), to = speeds.end(); from != to;) {
      const auto middle = from + (to - from) / 2;
      if (takes(*middle)) {
        to = middle;
        found = true;
      } else {
        from = middle + 1;
      }
    }
    if (found) return;
    if (!result.loops->good()) continue;
    for (int decade = 1; decade <= kDecades; ++decade) {
      if (takes(std::pow(10.0, -decade))) return;
    }
    return;
  }
}

void find_overloads(const diagram::FlatDiagram& flat, DiagramOnMachine& result) {
  const network::Program program(network::assemble(flat));
  solve::RunOptions options = solve::options_of(result.made.diagram.run);
  options.max_steps = std::min(options.max_steps, kMostSteps);
  options.watch_overloads = true;
  for (const solve::OverloadRecord& record : solve::run(program, flat, options).overloads)
    result.overloads.push_back({program.signal_names()[record.signal], std::abs(record.peak.value)});
  std::stable_sort(result.overloads.begin(), result.overloads.end(),
                   [](const auto& a, const auto& b) { return a.peak > b.peak; });
}

/// Gives room to what the machine's errors drive over the machine unit, a round for each thing that goes too
/// far after the one before. Where a signal is the smaller the more room it has, errors that stay as they are
/// may drive it the farther: of all rounds the one stays that leaves the machine unit least.
void fit_room(machine::MachineScaling& scaling, DiagramOnMachine& result) {
  constexpr int kRounds = 4;
  std::optional<machine::ScaledRealisation> best;
  double least = 0, before = 0;
  for (int round = 0; round <= kRounds; ++round) {
    double excess = 0;
    try {
      excess = scaling.make_room(result.made, kMostSteps);
    } catch (const solve::SolveError&) {
      if (!best) throw;
      break;
    }
    const bool no_more = excess == 0 || excess == before;
    if (!best || excess < least) {
      best = std::move(result.made);
      least = excess;
    }
    if (no_more) break;
    before = excess;
    result.made = scaling.realise(result.loop_speed);
  }
  result.made = std::move(*best);
}

/// What grows without bound on amplifiers that do not saturate stays within their limits on those that do.
void find_end(const solve::SolveError& unbounded, const diagram::BlockLibrary& library,
              DiagramOnMachine& result) {
  try {
    find_overloads(diagram::flatten(result.made.diagram, library), result);
  } catch (const solve::SolveError&) {
    result.failure = unbounded.diagnostics().front().what;
    return;
  }
  if (result.overloads.empty()) result.failure = unbounded.diagnostics().front().what;
}

}  // namespace

DiagramOnMachine put_on_machine(const diagram::Diagram& diagram, const diagram::BlockLibrary& library,
                                const diagram::MachineProfile& machine,
                                const machine::ScalingOptions& options) {
  machine::MachineScaling scaling(diagram, library, machine, options);
  DiagramOnMachine result;
  result.made = scaling.realise();
  if (has_servos(result.made.diagram, library)) fit_loops(scaling, library, result);
  try {
    fit_room(scaling, result);
    find_overloads(diagram::without_saturation(diagram::flatten(result.made.diagram, library)), result);
  } catch (const solve::SolveError& error) {
    result.given_up = error.kind() == solve::SolveError::Kind::step_budget;
    if (!result.given_up) find_end(error, library, result);
  }
  if (diagram.published) {
    const auto& values = diagram.published->values;
    result.published_left_out = static_cast<std::size_t>(
        std::count_if(values.begin(), values.end(),
                      [](const diagram::PublishedValue& value) { return !value.set.empty(); }));
  }
  result.difference = difference_of(run_on_ideal_elements(diagram, library),
                                    run_on_ideal_elements(result.made.diagram, library), result.made.diagram);
  return result;
}

}  // namespace oblique::commission
