// SPDX-License-Identifier: MIT
#include <oblique/machine/signal_ranges.h>

#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

namespace oblique::machine {

std::vector<SignalRange> signal_ranges(diagram::FlatDiagram flat, const diagram::RunSettings& settings) {
  flat.outputs.clear();
  for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
    for (std::size_t k = 0; k < flat.blocks[b].definition->outputs.size(); ++k)
      flat.outputs.push_back({flat.signal_name({b, k}), {b, k}, 1, "machine unit", 0});
  }
  solve::RunOptions options = solve::options_of(settings);
  options.extremes = true;
  const solve::Run run = solve::run(network::Program(network::assemble(flat)), flat, options);
  std::vector<SignalRange> ranges;
  ranges.reserve(run.extremes.size());
  for (const solve::Extremes& of : run.extremes) ranges.push_back({of.minimum.value, of.maximum.value});
  return ranges;
}

}  // namespace oblique::machine
