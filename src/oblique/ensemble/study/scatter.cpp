// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/scatter.h>

namespace oblique::ensemble {

double DrawnElement::draw(const diagram::FlatDiagram& diagram, double nominal, DrawKey key) const {
  const double away =
      half_width *
      (2 * uniform(key, static_cast<std::uint32_t>(block), static_cast<std::uint32_t>(scatter)) - 1);
  const bool allowed = diagram.blocks[block].definition->parameters[parameter].allows(nominal + away);
  return allowed ? nominal + away : nominal - away;
}

std::vector<DrawnElement> drawn_elements(const diagram::FlatDiagram& diagram,
                                         const std::vector<diagram::BlockFigure>& scatters) {
  std::vector<DrawnElement> elements;
  for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
    for (std::size_t s = 0; s < scatters.size(); ++s) {
      if (const auto parameter = scatters[s].acts_on(*diagram.blocks[b].definition))
        elements.push_back({b, *parameter, s, scatters[s].value});
    }
  }
  return elements;
}

std::vector<Draw> draw(const diagram::FlatDiagram& diagram, const std::vector<diagram::BlockFigure>& scatters,
                       DrawKey key) {
  std::vector<Draw> draws;
  for (const DrawnElement& element : drawn_elements(diagram, scatters)) {
    const double nominal = diagram.blocks[element.block].parameters[element.parameter];
    draws.push_back({element.block, element.parameter, element.draw(diagram, nominal, key)});
  }
  return draws;
}

void apply_draws(const std::vector<Draw>& draws, diagram::FlatDiagram& diagram) {
  for (const Draw& drawn : draws) {
    diagram::FlatBlock& block = diagram.blocks[drawn.block];
    block.parameters[drawn.parameter] = drawn.value;
    block.choose_behaviour();
  }
}

std::vector<diagram::BlockFigure> scatters_of_tolerance(const diagram::BlockLibrary& library,
                                                        double tolerance) {
  std::vector<diagram::BlockFigure> scatters;
  for (const std::string& name : library.names()) {
    const diagram::BlockDefinition& definition = *library.find(name);
    if (definition.is_composite()) continue;
    for (const diagram::ParameterDefinition& parameter : definition.parameters) {
      const bool scattered = parameter.name == "tolerance" ||
                             (definition.role == diagram::Role::multiplier && parameter.name == "error");
      if (scattered) scatters.push_back({name, parameter.name, tolerance, "tolerance"});
    }
  }
  return scatters;
}

}  // namespace oblique::ensemble
