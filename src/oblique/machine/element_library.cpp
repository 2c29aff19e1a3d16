// SPDX-License-Identifier: MIT
#include <oblique/machine/element_library.h>

#include <fmt/format.h>

#include <oblique/diagram/shipped_files.h>

namespace oblique::machine {

diagram::BlockLibrary element_library(const diagram::BlockLibrary& library) {
  const diagram::BlockLibrary shipped = diagram::BlockLibrary::shipped();
  diagram::BlockLibrary elements = library;
  for (const diagram::ShippedFile& circuit : diagram::shipped_elements()) {
    const diagram::BlockDefinition* const block = library.find(circuit.name);
    const diagram::BlockDefinition* const original = shipped.find(circuit.name);
    if (block == nullptr || original == nullptr || block->text != original->text) continue;
    elements.add(diagram::parse_block(
        circuit.text, fmt::format("src/machines/elements/{}.toml", circuit.name), std::string(circuit.name)));
  }
  return elements;
}

}  // namespace oblique::machine
