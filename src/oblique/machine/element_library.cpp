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
    diagram::BlockDefinition of_elements = diagram::parse_block(
        circuit.text, fmt::format("src/machines/elements/{}.toml", circuit.name), std::string(circuit.name));
    for (diagram::BlockInstance& inner : of_elements.blocks) {
      if (inner.type != of_elements.name) continue;
      inner.type = fmt::format("{} itself", of_elements.name);  // no file can have this name
      elements.add_as(inner.type, *block);
    }
    elements.add(std::move(of_elements));
  }
  return elements;
}

}  // namespace oblique::machine
