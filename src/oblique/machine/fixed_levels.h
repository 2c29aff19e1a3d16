// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/machine/circuit.h>

// Not installed.
namespace oblique::machine {

/// Whether an input is compared with a level that no factor moves: the input `set` of an integrator, the
/// clock of a counter.
bool has_fixed_level(const CircuitElement& element, std::size_t port);
/// Whether an output is a level that no factor moves: that of a flip-flop.
bool has_fixed_level(const std::vector<CircuitElement>& elements, const diagram::SignalRef& signal);

/// Throws RealiseError where what is compared with such a level could not keep its scale: a product, and what
/// leaves the machine unit. `peaks` are those of the elements, unscaled.
void check_levels(const Circuit& circuit, const std::vector<double>& peaks);

}  // namespace oblique::machine
