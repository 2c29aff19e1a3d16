// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>

/// A diagram as it is drawn: with composites folded or open, and constants at the inputs that they feed. Not
/// installed.
namespace oblique::draw::schematic {

/// An output of a block of the same schematic.
struct Signal {
  std::size_t block = 0;
  std::size_t output = 0;
};

/// A connected input: one term of a sum, or a port that takes one signal.
struct Input {
  std::string port;  ///< its name in the block's file
  std::size_t port_index = 0;
  double weight = 1;
  std::optional<Signal> signal;     ///< none where a constant feeds it
  std::string constant;             ///< what stands at the wire's end then: "+1", "a = 0.3"
  bool in_loop = false;             ///< the wire is a part of the servo loop that the block is in
  std::optional<std::size_t> loop;  ///< that the wire's net is a part of
  std::string reads;                ///< the signal at the wire's end, as a console calls it; may be empty
  std::string source;               ///< the signal as the file names it
  text::SourcePosition position;    ///< of that name in the file
  bool open = false;                ///< of a sketch: nothing is wired here, and something must be
};

struct Schematic;

/// A block, or on the frame of an open composite one of its ports.
struct Block {
  enum class Kind { block, input, output };
  Kind kind = Kind::block;
  std::string name;
  std::string label;                                     ///< may be empty
  const diagram::BlockDefinition* definition = nullptr;  ///< none for a port
  std::vector<double> parameters;                        ///< in the order of the definition
  std::vector<bool> given;                               ///< whether the file gives it
  std::vector<Input> inputs;
  std::vector<std::string> outputs;  ///< names: those of the definition, then signals inside that are used
  /// What a console reads at each output; empty on the frame of a composite where a weighted sum arrives,
  /// which has no name.
  std::vector<std::string> reads;
  std::vector<bool> wired;           ///< whether a wire starts at an output
  std::vector<std::string> records;  ///< of each output, where it is measured: under what name, in what unit
  bool inverts = false;
  std::optional<std::size_t> loop;  ///< the servo loop that it is a part of
  std::vector<Schematic> inside;    ///< of an open composite: one
};

/// The blocks of a diagram or of an open composite.
struct Schematic {
  std::vector<Block> blocks;
  std::size_t loops = 0;                                     ///< servo loops
  const std::vector<diagram::BlockPlace>* layout = nullptr;  ///< as the file has it
  bool is_sketch = false;                                    ///< of a diagram that may be wrong
};

/// Resolves the names of a diagram; composites are open `depth` levels deep. Throws DiagramError with all
/// findings about its wiring and outputs. `diagram` and `library` must outlive the result.
Schematic make_schematic(const diagram::Diagram& diagram, const diagram::BlockLibrary& library, int depth);

/// The same of a diagram that may be wrong, as far as it is right: wires that name no signal are left out,
/// inputs that must be wired have an open end. Constants with a place stand there. Every type of a block must
/// be known. Throws where the diagram is too large.
Schematic sketch_schematic(const diagram::Diagram& diagram, const diagram::BlockLibrary& library);

/// "0.3142": four significant digits, with a true minus sign.
std::string number_text(double value);

}  // namespace oblique::draw::schematic
