// SPDX-License-Identifier: MIT
#include <oblique/commission/diagram_on_machine.h>

#include <algorithm>
#include <cmath>

#include <oblique/diagram/flatten.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/solve_error.h>

namespace oblique::commission {
namespace {

diagram::Diagram without_machine(diagram::Diagram diagram) {
  diagram.machine.profile = "ideal";
  return diagram;
}

/// The largest difference between two runs of the same outputs, over the largest value of the output.
double difference_of(const solve::Trajectory& a, const solve::Trajectory& b) {
  double largest = 0;
  for (std::size_t c = 1; c < a.columns().size(); ++c) {
    double size = 0, difference = 0;
    for (std::size_t r = 0; r < std::min(a.rows(), b.rows()); ++r) {
      size = std::max(size, std::abs(a.at(r, c)));
      difference = std::max(difference, std::abs(a.at(r, c) - b.at(r, c)));
    }
    if (size > 0) largest = std::max(largest, difference / size);
  }
  return largest;
}

bool has_servos(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  return std::any_of(diagram.blocks.begin(), diagram.blocks.end(), [&](const diagram::BlockInstance& block) {
    return library.find(block.type)->role == diagram::Role::open_amplifier;
  });
}

/// The speeds that servo amplifiers are tried at, each less than the one before.
std::vector<double> loop_speeds() {
  constexpr int kDecades = 6;
  std::vector<double> speeds;
  for (int decade = 1; decade <= kDecades; ++decade) {
    for (const double step : {5.0, 2.0, 1.0}) speeds.push_back(step / std::pow(10.0, decade));
  }
  return speeds;
}

/// Slows the servo amplifiers where the machine's elements are slow beside their loops, by bisection: what is
/// slow enough is taken to stay so when slower.
void fit_loops(const machine::MachineScaling& scaling, const diagram::BlockLibrary& library,
               DiagramOnMachine& result) {
  result.loops = judge(result.made.diagram, library);
  if (result.loops->well_damped()) return;
  result.loop_fault = fault_of(*result.loops);
  const std::vector<double> speeds = loop_speeds();
  for (const auto is_fine : {&Judgement::well_damped, &Judgement::good}) {
    bool found = false;
    for (auto from = speeds.begin(), to = speeds.end(); from != to;) {
      const auto middle = from + (to - from) / 2;
      machine::ScaledRealisation slower = scaling.realise(*middle);
      Judgement loops = judge(slower.diagram, library);
      if (!((loops.*is_fine)())) {
        from = middle + 1;
        continue;
      }
      result.made = std::move(slower);
      result.loops = std::move(loops);
      result.loop_speed = *middle;
      to = middle;
      found = true;
    }
    if (found || result.loops->good()) return;
  }
}

void find_overloads(const diagram::BlockLibrary& library, DiagramOnMachine& result) {
  const diagram::FlatDiagram flat =
      diagram::without_saturation(diagram::flatten(result.made.diagram, library));
  const network::Program program(network::assemble(flat));
  solve::RunOptions options = solve::options_of(result.made.diagram.run);
  options.watch_overloads = true;
  for (const solve::OverloadRecord& record : solve::run(program, flat, options).overloads)
    result.overloads.push_back({program.signal_names()[record.signal], std::abs(record.peak.value)});
  std::stable_sort(result.overloads.begin(), result.overloads.end(),
                   [](const auto& a, const auto& b) { return a.peak > b.peak; });
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
    constexpr int kRounds = 4;  // each gives room by what the one before went too far
    for (int round = 0; round < kRounds && scaling.make_room(result.made); ++round)
      result.made = scaling.realise(result.loop_speed);
    find_overloads(library, result);
  } catch (const solve::SolveError& error) {
    result.failure = error.diagnostics().front().what;
  }
  result.difference = difference_of(solve::run(without_machine(diagram), library).trajectory,
                                    solve::run(without_machine(result.made.diagram), library).trajectory);
  return result;
}

}  // namespace oblique::commission
