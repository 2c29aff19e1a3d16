// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/block_definition.h>

/// The wiring of one diagram or one composite block with its names resolved: made once, then laid out as
/// often as the composite is used (flatten.cpp).
namespace oblique::diagram::wiring {

struct Scope;

/// A number of a file: fixed, or `number` times an expression of the parameters of the composite around it.
struct Constant {
  double number = 0;
  std::optional<text::Expression> expression;

  double value(const BlockDefinition* composite, std::span<const double> parameters) const;
};

/// Where a wire starts, seen from inside a scope: an input of the composite itself, or an output of a block,
/// reached through the blocks whose indices stand in `blocks` (one, or more to reach inside composites).
struct Source {
  std::optional<std::size_t> own_input;
  std::vector<std::size_t> blocks;
  std::size_t output = 0;
};

/// weight · signal.
struct Term {
  Constant weight;
  Source source;
  std::string signal;  ///< the source as the file names it
  text::SourcePosition position;
};

/// What a file says about one input.
struct WiredInput {
  bool connected = false;
  std::vector<Term> terms;
};

/// What a file says about one parameter; without `given` the default applies.
struct WiredParameter {
  bool given = false;
  std::optional<text::PointTable> points;   ///< of a parameter that is a function given by points
  std::optional<text::Expression> formula;  ///< of a parameter that is an expression of time
  Constant value;
  text::SourcePosition position;
};

/// One block of a scope.
struct WiredBlock {
  const BlockInstance* instance = nullptr;
  const BlockDefinition* definition = nullptr;  ///< none where the type is unknown or contains itself
  const Scope* inside = nullptr;                ///< of a composite
  std::vector<WiredParameter> parameters;       ///< in the order of the definition
  std::vector<WiredInput> inputs;               ///< in the order of the definition
};

/// The blocks of a diagram or of a composite.
struct Scope {
  const BlockDefinition* composite = nullptr;  ///< none for the diagram
  std::string file;
  bool inverting = false;
  std::string machine;  ///< the profile, whose volts count
  std::vector<WiredBlock> blocks;
  std::unordered_map<std::string_view, std::size_t> index;  ///< of `blocks` by name
  std::vector<std::optional<Source>> outputs;               ///< of a composite; empty where the wire is wrong

  /// "" in a diagram, " of composite 'divider'" in a composite: the end of a subject in a message.
  std::string belonging() const;
  /// What a wire may name here.
  std::vector<std::string> signal_names() const;
};

/// "input 'c.in' of composite 'divider'", "block 'c' (multiplier)": subjects of messages.
std::string describe_port(const Scope& scope, std::string_view kind, const WiredBlock& block,
                          std::string_view port);
std::string describe_block(const Scope& scope, const WiredBlock& block);

/// A number as messages give it: "not a number" has no sign there.
std::string describe_number(double number);

/// The signal that a path names ("c", "crank.cos", "C.direction.length"). Reports a path that names none.
std::optional<Source> find_signal(const Scope& scope, std::string_view path, text::SourcePosition position,
                                  const std::string& subject, text::Diagnostics& diagnostics);

}  // namespace oblique::diagram::wiring
