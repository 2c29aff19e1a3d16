// SPDX-License-Identifier: MIT
#include <oblique/diagram/element_kind.h>

#include <algorithm>
#include <array>
#include <vector>

#include <fmt/format.h>

namespace oblique::diagram {
namespace {

struct ElementWords {
  ElementKind kind;
  std::string_view one, many, key;
};

constexpr std::array kElements{
    ElementWords{ElementKind::amplifier, "amplifier", "amplifiers", "amplifier"},
    ElementWords{ElementKind::integrator, "integrator", "integrators", "integrator"},
    ElementWords{ElementKind::summer, "summer", "summers", "summer"},
    ElementWords{ElementKind::inverter, "inverter", "inverters", "inverter"},
    ElementWords{ElementKind::potentiometer, "potentiometer", "potentiometers", "potentiometer"},
    ElementWords{ElementKind::multiplier, "multiplier", "multipliers", "multiplier"},
    ElementWords{ElementKind::comparator, "comparator", "comparators", "comparator"},
    ElementWords{ElementKind::function_generator, "function generator", "function generators",
                 "function_generator"},
    ElementWords{ElementKind::store, "store", "stores", "store"},
    ElementWords{ElementKind::electronic_switch, "electronic switch", "electronic switches",
                 "electronic_switch"},
    ElementWords{ElementKind::counter, "counter", "counters", "counter"},
    ElementWords{ElementKind::flip_flop, "flip-flop", "flip-flops", "flip_flop"},
    ElementWords{ElementKind::monostable, "monostable", "monostables", "monostable"},
    ElementWords{ElementKind::noise_generator, "noise generator", "noise generators", "noise_generator"},
    ElementWords{ElementKind::diode, "diode", "diodes", "diode"},
};

const ElementWords& words_of(ElementKind kind) {
  return *std::find_if(kElements.begin(), kElements.end(),
                       [&](const ElementWords& words) { return words.kind == kind; });
}

}  // namespace

std::string_view element_name(ElementKind kind) {
  return words_of(kind).one;
}

std::string elements_name(ElementKind kind) {
  return std::string(words_of(kind).many);
}

bool is_always_told(ElementKind kind) {
  return kind < ElementKind::store;
}

std::optional<ElementKind> read_element_kind(std::string_view key, const text::Place& place,
                                             text::Diagnostics& diagnostics) {
  std::vector<std::string> known;
  for (const ElementWords& words : kElements) {
    if (words.key == key) return words.kind;
    known.emplace_back(words.key);
  }
  diagnostics.add(
      {place, fmt::format("there is no kind of element '{}'", key), {}, text::suggest(key, known)});
  return std::nullopt;
}

}  // namespace oblique::diagram
