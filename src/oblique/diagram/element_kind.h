// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <oblique/text/diagnostic.h>

namespace oblique::diagram {

/// The elements a machine is made of. An amplifier is uncommitted: with its networks it becomes a summer, an
/// inverter, an integrator or an open amplifier.
enum class ElementKind {
  amplifier,
  integrator,  ///< where amplifiers are uncommitted: the network that makes one an integrator
  summer,
  inverter,
  potentiometer,
  multiplier,
  comparator,
  function_generator,
  // Hardly anybody published how many of these a machine has.
  store,
  electronic_switch,
  counter,
  flip_flop,
  monostable,
  noise_generator,
  diode,
};

/// "amplifier", "function generator" …
std::string_view element_name(ElementKind kind);
/// "amplifiers", "electronic switches" …
std::string elements_name(ElementKind kind);

/// Whether a profile that does not name the kind says by that that the machine has none of it, and not only
/// that nobody has published it.
bool is_always_told(ElementKind kind);

/// Reads the key of an element, its name as an identifier ("function_generator"), or reports that there is
/// none of that name.
std::optional<ElementKind> read_element_kind(std::string_view key, const text::Place& place,
                                             text::Diagnostics& diagnostics);

}  // namespace oblique::diagram
