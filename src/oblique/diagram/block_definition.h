// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/element_kind.h>
#include <oblique/diagram/role.h>
#include <oblique/text/document.h>
#include <oblique/text/expression.h>
#include <oblique/text/point_table.h>

namespace oblique::diagram {

/// An input of a block. A `sum` port adds its weighted signals, as a summing junction does; any other takes
/// one.
struct InputPort {
  std::string name;
  bool sum = false;
  std::optional<double>
      default_value;  ///< what an unconnected input sees [machine unit]; without it: an error
  std::vector<std::string>
      open_with;  ///< inputs of which one that is connected lets this one stay open, at 0
  std::string doc;
};

/// An output of a block; on a composite, `wire` is the inner signal that it shows.
struct OutputPort {
  std::string name;
  std::string wire;
  std::string doc;
  text::Place place;
};

/// A parameter of a block with its default, unit and allowed range.
struct ParameterDefinition {
  std::string name;
  double default_value = 0;
  std::string unit = "1";
  std::optional<double> above, below;       ///< exclusive limits
  std::optional<double> at_least, at_most;  ///< inclusive limits
  bool saturation = false;  ///< where it stays open it is what the amplifiers of the machine saturate at
  std::string doc;
  std::optional<text::PointTable> points;  ///< the default of a parameter that is a function given by points
  std::string x_unit = "machine unit", y_unit = "machine unit";  ///< of its points
  std::optional<text::Expression> formula;  ///< the default of a parameter that is an expression of time

  bool allows(double value) const;  ///< within the limits; never for "not a number"
  std::string range() const;        ///< "a number above 0 [Hz]"
};

/// One equation of a primitive block; names in it are inputs, outputs, parameters, other targets, memories,
/// `time`, `polarity` (−1 on a machine whose summers and integrators invert, else 1), and the mode of
/// operation: `in_initial`, `in_operate`, `in_hold` (one of them 1, the others 0).
struct Equation {
  enum class Kind {
    assignment,  ///< target = expression
    derivative,  ///< der(target) = expression; target is a state
    implicit,    ///< 0 = expression; target is the unknown that makes it so
  };
  Kind kind = Kind::assignment;
  std::string target;
  text::Expression expression;
  text::Place place;
};

/// The equations of a block in one case; the first case whose condition on the parameters holds applies.
struct Behaviour {
  std::optional<text::Expression> when;  ///< none: the default, which comes last
  std::vector<Equation> equations;
};

/// Where a state starts, or from where an implicit unknown is sought.
struct StartRule {
  std::string target;
  text::Expression value;  ///< of parameters and, for a state not brought to rest, of inputs
  bool at_rest =
      false;  ///< a state brought to rest (zero derivative) before the clock starts; `value` is the guess
};

/// A value that a block keeps until an event changes it.
struct MemoryRule {
  std::string name;
  text::Expression initial;  ///< of parameters
  text::Place place;
};

/// What an event does to one memory or state; the value is that of the moment before the event.
struct EventAction {
  std::string target;
  text::Expression value;
  text::Place place;
};

/// What happens when a condition becomes true.
struct EventRule {
  text::Expression when;
  std::vector<EventAction> actions;
  std::vector<EventAction> piling_up;  ///< in their place where the event comes ever faster; none: not told
  bool at_start = true;       ///< a condition that holds when the run starts counts as having become true
  bool before_start = false;  ///< … and as having done so before: nothing that follows from it rises
  std::optional<text::Expression> where;  ///< of parameters: there is no such event where it is 0
  text::Place place;
};

/// What a block without a role takes of a machine's elements.
struct ElementNeed {
  ElementKind kind = ElementKind::amplifier;
  text::Expression count;  ///< of parameters
};

/// One block of a diagram or of a composite as its file has it. Which key of `settings` is an input and which
/// a parameter only the block's definition tells, so that is settled by `flatten`.
struct BlockInstance {
  std::string name;
  std::string type;
  std::string label;                  ///< any text, for people
  std::string comment;                ///< lines that `write_diagram` puts above the block
  std::vector<text::Entry> settings;  ///< every key but `type` and `label`
  text::Place place;

  bool operator==(const BlockInstance& other) const;  ///< without places and comments
};

/// Where the drawing of a diagram has a block: the middle of its outline, x to the right and y down. The unit
/// is the distance between two inputs of a block, 16 px; the origin is anywhere.
struct BlockPlace {
  std::string name;
  double x = 0, y = 0;
  text::Place place;

  bool operator==(const BlockPlace& other) const;  ///< without places in the file
};

/// What the parameters of a block must meet together: "width < period".
struct ParameterRelation {
  text::Expression condition;
  std::string text;
};

/// A kind of block: `blocks/<name>.toml`. Primitive ones have behaviours, composite ones have inner blocks.
struct BlockDefinition {
  std::string name;
  std::string title;
  std::string summary;
  std::string source;
  std::string symbol;
  Role role = Role::other;  ///< what a real machine makes of it
  std::string doc;
  std::vector<InputPort> inputs;
  std::vector<OutputPort> outputs;
  std::vector<ParameterDefinition> parameters;

  std::vector<Behaviour> behaviours;
  std::vector<StartRule> starts;
  std::vector<MemoryRule> memories;
  std::vector<EventRule> events;
  std::optional<text::Expression>
      check_interval;                        ///< [s] of parameters: how often at least its switches look
  std::vector<ElementNeed> needs;            ///< `requires`
  std::vector<ParameterRelation> relations;  ///< `valid`

  std::vector<BlockInstance> blocks;
  std::vector<BlockPlace> layout;  ///< of the inner blocks, where an open composite is drawn
  bool inverting =
      false;  ///< whether the inner summers and integrators invert (the composite's own convention)

  std::string file;
  std::string text;  ///< the file as it stands

  bool is_composite() const { return !blocks.empty(); }
  std::optional<std::size_t> find_input(std::string_view input) const;
  std::optional<std::size_t> find_output(std::string_view output) const;
  std::optional<std::size_t> find_parameter(std::string_view parameter) const;
  std::optional<std::size_t> find_memory(std::string_view memory) const;

  /// The first relation that these values of the parameters do not meet; none: they meet all.
  const ParameterRelation* unmet_relation(const std::vector<double>& values) const;

  /// The first case whose condition holds, with the values of the parameters in their order.
  const Behaviour* choose_behaviour(const std::vector<double>& values, double polarity) const;
};

/// Reads one block file (oblique-block/1). Checks all that one file can tell: kinds of keys, ranges, that
/// every output has an equation in every case, that equations use known names. Throws DiagramError with all
/// findings.
BlockDefinition parse_block(std::string_view text, std::string file, std::string name);

}  // namespace oblique::diagram
