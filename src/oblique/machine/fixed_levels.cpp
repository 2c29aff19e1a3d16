// SPDX-License-Identifier: MIT
#include <oblique/machine/fixed_levels.h>

#include <string>

#include <fmt/format.h>

#include <oblique/diagram/propose_scaling.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>

namespace oblique::machine {

bool has_fixed_level(const CircuitElement& element, std::size_t port) {
  if (element.logic) return element.logic->inputs[port];
  return element.role == Role::integrator && !element.definition->inputs[port].sum &&
         element.definition->inputs[port].name != "start";
}

bool has_fixed_level(const std::vector<CircuitElement>& elements, const diagram::SignalRef& signal) {
  const auto& logic = elements[signal.block].logic;
  return logic && logic->outputs[signal.output];
}

void check_levels(const Circuit& circuit, const std::vector<double>& peaks) {
  text::Diagnostics diagnostics;
  const auto check = [&](const CircuitElement& element, const std::string& port, diagram::SignalRef signal) {
    const CircuitElement& source = circuit.elements[signal.block];
    std::string why;
    if (is_product(source.role)) {
      why = "is a product, whose scale is that of its factors";
    } else if (peaks[signal.block] > 1 + diagram::kOverloadTolerance) {
      why = fmt::format("goes to {:.3g} machine units", peaks[signal.block]);
    } else {
      return;
    }
    diagnostics.add(
        {element.block->place,
         fmt::format("'{}' of '{}' is compared with a level that no scale moves, and '{}', which it "
                     "is fed with, {}",
                     port, element.path, source.path, why),
         "a level of 0 or 1, as a comparator gives it", "put a comparator before it"});
  };
  for (const CircuitElement& element : circuit.elements) {
    for (std::size_t port = 0; port < element.inputs.size(); ++port) {
      if (!has_fixed_level(element, port)) continue;
      for (const CircuitTerm& term : element.inputs[port].terms) {
        if (term.signal && !has_fixed_level(circuit.elements, *term.signal))
          check(element, element.definition->inputs[port].name, *term.signal);
      }
    }
  }
  diagnostics.throw_if_any<RealiseError>();
}

}  // namespace oblique::machine
