// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

namespace oblique::testing {

/// The shipped blocks.
inline const diagram::BlockLibrary& shipped_blocks() {
  static const diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  return library;
}

/// The shipped blocks and one more, whose file has this text below its title.
inline diagram::BlockLibrary shipped_blocks_and(const std::string& name, std::string_view text) {
  diagram::BlockLibrary library = diagram::BlockLibrary::shipped();
  library.add(diagram::parse_block(
      "format = \"oblique-block/1\"\ntitle = \"" + name + "\"\n" + std::string(text), name + ".toml", name));
  return library;
}

/// The text of a diagram with these blocks, from its third line on, and these further tables.
inline std::string diagram_text(std::string_view blocks, std::string_view rest = "") {
  return "format = \"oblique-diagram/1\"\n[blocks]\n" + std::string(blocks) + std::string(rest);
}

/// A diagram on its way from text to a Program. `library` must outlive it.
struct Compiled {
  diagram::Diagram diagram;
  diagram::FlatDiagram flat;
  network::Program program;

  explicit Compiled(std::string_view blocks, std::string_view rest = "",
                    const diagram::BlockLibrary& library = shipped_blocks())
      : diagram(diagram::parse_diagram(diagram_text(blocks, rest), "d.toml")),
        flat(diagram::flatten(diagram, library)),
        program(network::assemble(flat)) {}

  /// The number of a signal among those of the program.
  std::size_t signal(std::string_view name) const {
    const auto& names = program.signal_names();
    for (std::size_t s = 0; s < names.size(); ++s) {
      if (names[s] == name) return s;
    }
    throw std::out_of_range(std::string(name));
  }
};

/// What is thrown by `action`, as the user sees it; "" where nothing is.
template <class Thrown, class Action>
std::string message_of(Action action) {
  try {
    action();
  } catch (const Thrown& error) {
    return error.what();
  }
  return {};
}

}  // namespace oblique::testing
