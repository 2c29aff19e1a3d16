// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/ideal_amplifiers.h>

#include <algorithm>
#include <limits>
#include <set>
#include <string>

#include <oblique/network/assembly/network.h>
#include <oblique/report/atlas/equations.h>

namespace oblique::report {
namespace {

diagram::FlatDiagram idealised(diagram::FlatDiagram diagram, const std::set<std::string>& but) {
  constexpr double kIdeal = std::numeric_limits<double>::infinity();
  for (diagram::FlatBlock& block : diagram.blocks) {
    const bool solves = block.definition->role == diagram::Role::open_amplifier && !but.contains(block.path);
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
      const bool is_made_ideal = parameter.saturation || (solves && parameter.name == "gain");
      if (is_made_ideal && parameter.allows(kIdeal)) block.parameters[k] = kIdeal;
    }
    block.choose_behaviour();
  }
  return diagram;
}

/// The unknowns of equations in which they do not stand.
std::set<std::string> unsolvable(network::Network network) {
  std::set<std::string> names;
  for (const network::Loop& loop : network.loops) {
    if (loop.unknowns.size() != 1) continue;
    const network::Unknown& unknown = network.unknowns[loop.unknowns.front()];
    const auto slopes = network.graph.gradient(unknown.residual);
    const std::uint32_t variable = network.unknown_variable(loop.unknowns.front());
    if (std::none_of(slopes.begin(), slopes.end(),
                     [&](const auto& slope) { return slope.first == variable; }))
      names.insert(unknown.name);
  }
  return names;
}

}  // namespace

diagram::FlatDiagram with_ideal_amplifiers(const diagram::FlatDiagram& diagram) {
  diagram::FlatDiagram ideal = idealised(diagram, {});
  const std::set<std::string> idle = unsolvable(network::assemble(as_operated(ideal)));
  return idle.empty() ? ideal : idealised(diagram, idle);
}

}  // namespace oblique::report
