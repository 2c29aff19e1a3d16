// SPDX-License-Identifier: MIT
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/diagram_check.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>

namespace oblique::report {
namespace {

/// Where a signal leaves the machine unit and amplifiers saturate, what it would do if they did not: a peak
/// that is cut off tells no scale. Nothing where such a run fails.
std::optional<Unsaturated> analyse_unsaturated(const diagram::FlatDiagram& flat,
                                               const solve::Analysis& analysis,
                                               const solve::RunOptions& options) {
  const bool saturates =
      std::any_of(flat.blocks.begin(), flat.blocks.end(), [](const diagram::FlatBlock& block) {
        return block.saturation && std::isfinite(block.parameters[*block.saturation]);
      });
  if (!saturates || !analysis.run || analysis.run->overloads.empty()) return std::nullopt;
  const diagram::FlatDiagram free = diagram::without_saturation(flat);
  network::Program program(network::assemble(free));
  solve::Analysis found = solve::analyse(program, free, options);
  if (!found.run) return std::nullopt;
  return Unsaturated{std::move(program), std::move(found)};
}

ScalingProposal propose(const diagram::FlatDiagram& flat, const network::Program& program,
                        const solve::Analysis& analysis) {
  std::vector<double> peaks;
  for (const solve::Peak& peak : analysis.run->peaks) peaks.push_back(peak.value);
  ScalingProposal proposal;
  proposal.blocks = diagram::propose_scaling(flat, peaks);
  std::unordered_map<std::string_view, double> factors;
  for (const diagram::BlockScaling& block : proposal.blocks) {
    for (const double factor : block.outputs) {
      factors.emplace(program.signal_names()[proposal.signals.size()], factor);
      proposal.signals.push_back(factor);
    }
  }
  double fastest = 0;
  for (std::size_t i = 0; i < program.n_states(); ++i) {
    const network::State& state = program.states()[i];
    const auto factor = factors.find(state.name);
    if (state.at_rest || factor == factors.end()) continue;
    fastest = std::max(fastest, factor->second * analysis.fastest_derivatives[i]);
  }
  proposal.time_scale = 1 / diagram::scale_for_peak(fastest);
  return proposal;
}

/// The largest difference between the rows of two runs of the same columns, relative to the largest value of
/// the column.
double largest_difference(const solve::Trajectory& a, const solve::Trajectory& b) {
  double largest = 0;
  for (std::size_t c = 1; c < a.columns().size(); ++c) {
    double size = 0, difference = 0;
    for (std::size_t r = 0; r < a.rows(); ++r) {
      size = std::max(size, std::abs(a.at(r, c)));
      difference = std::max(difference, std::abs(a.at(r, c) - b.at(r, c)));
    }
    if (size > 0) largest = std::max(largest, difference / size);
  }
  return largest;
}

}  // namespace

DiagramCheck examine(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                     const network::Program& program, const std::function<void(double fraction)>& progress) {
  DiagramCheck check{diagram.file, diagram, flat, program, {}, {}, {}, {}};
  if (diagram.machine.profile != "ideal")
    check.components = machine::component_list_of(flat, *diagram::find_machine(diagram.machine.profile));
  solve::RunOptions options = solve::options_of(diagram.run);
  options.progress = progress;
  check.analysis = solve::analyse(program, flat, options);
  check.unsaturated = analyse_unsaturated(flat, check.analysis, options);
  if (check.unsaturated) {
    check.scaling = propose(flat, check.unsaturated->program, check.unsaturated->analysis);
  } else if (check.analysis.run) {
    check.scaling = propose(flat, program, check.analysis);
  }
  return check;
}

ScaledDiagram scaled_by(const DiagramCheck& check, const diagram::BlockLibrary& library) {
  ScaledDiagram scaled{diagram::rescale(check.diagram, check.flat, check.scaling->blocks, library), 0, 0};
  scaled.diagram.comment = fmt::format(
      "{} in scaled signals.\n"
      "Time is not scaled, so that the outputs are what they were; for integrators of k0 = 1/s slow it down "
      "{:.6g} times.",
      check.file, check.scaling->time_scale);
  const diagram::FlatDiagram flat = diagram::flatten(scaled.diagram, library);
  solve::RunOptions options = solve::options_of(scaled.diagram.run);
  options.watch_overloads = true;
  const solve::Run result = solve::run(network::Program(network::assemble(flat)), flat, options);
  scaled.difference = largest_difference(check.in_full().run->trajectory, result.trajectory);
  scaled.overloads = result.overloads.size();
  return scaled;
}

}  // namespace oblique::report
