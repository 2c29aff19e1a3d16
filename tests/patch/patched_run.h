// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/mechanism/read_mechanism.h>
#include <oblique/patch/patch.h>
#include <oblique/solve/run.h>

namespace oblique {

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  text.replace(text.find(from), from.size(), to);
  return text;
}

inline Mechanism shipped(const std::string& name) {
  return read_mechanism(std::string(OBLIQUE_SOURCE_DIR) + "/diagrams/mechanisms/" + name + ".toml");
}

/// A patched diagram run to its end, and the program it became.
struct PatchedRun {
  explicit PatchedRun(const Diagram& diagram)
      : flat(flatten(diagram, library)),
        program(assemble(flat)),
        result(run(program, flat, options_of(diagram.run))) {}
  BlockLibrary library = BlockLibrary::shipped();
  FlatDiagram flat;
  Program program;
  Run result;
};

}  // namespace oblique
