// SPDX-License-Identifier: MIT
#include <oblique/diagram/flat_diagram.h>

#include <limits>

#include <oblique/diagram/formula.h>

namespace oblique::diagram {

std::string FlatDiagram::signal_name(SignalRef signal) const {
  const FlatBlock& block = blocks[signal.block];
  if (block.definition->outputs.size() == 1) return block.path;
  return block.path + "." + block.definition->outputs[signal.output].name;
}

void FlatBlock::choose_behaviour() {
  behaviour = definition->choose_behaviour(parameters, polarity);
  if (formulas.empty()) return;
  own_behaviour = std::make_shared<const Behaviour>(with_formulas(*behaviour, formulas));
  behaviour = own_behaviour.get();
}

FlatDiagram without_saturation(FlatDiagram diagram) {
  for (FlatBlock& block : diagram.blocks) {
    if (!block.saturation) continue;
    block.parameters[*block.saturation] = std::numeric_limits<double>::infinity();
    block.choose_behaviour();
  }
  return diagram;
}

}  // namespace oblique::diagram
