// SPDX-License-Identifier: MIT
#include <oblique/diagram/block_definition.h>

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/behaviour_reader.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/formula.h>
#include <oblique/diagram/layout_reader.h>
#include <oblique/diagram/names.h>
#include <oblique/diagram/points.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

template <class Named>
std::optional<std::size_t> find_named(const std::vector<Named>& things, std::string_view name) {
  const auto found =
      std::find_if(things.begin(), things.end(), [&](const Named& n) { return n.name == name; });
  if (found == things.end()) return std::nullopt;
  return static_cast<std::size_t>(found - things.begin());
}

class BlockReader {
 public:
  BlockReader(const text::Document& document, BlockDefinition& definition)
      : reader_(document.file, document.root, "the block file", diagnostics_), definition_(definition) {}

  void read() {
    if (!text::check_format(reader_, "oblique-block/1")) diagnostics_.throw_if_any<DiagramError>();
    definition_.title = reader_.required_string("title", "what people call the block").value_or("");
    definition_.summary = reader_.string("summary").value_or("");
    definition_.source = reader_.string("source").value_or("");
    definition_.symbol = reader_.string("symbol").value_or("");
    const auto role = reader_.string("role");
    if (role) definition_.role = read_role(*role, role_place(), diagnostics_);
    definition_.doc = reader_.string("doc").value_or("");
    const text::Value* const blocks = reader_.table("blocks");
    each("inputs", [&](const text::Entry& entry) { read_input(entry); });
    each("outputs", [&](const text::Entry& entry) { read_output(entry, blocks != nullptr); });
    each("parameters", [&](const text::Entry& entry) { read_parameter(entry); });
    check_open_inputs();
    if (reader_.table().find("outputs") == nullptr) {
      reader_.report("outputs", "the block has no [outputs]", "at least one output");
    }
    if (blocks != nullptr) {
      read_composite(*blocks);
    } else {
      read_behaviours(reader_, definition_, diagnostics_);
      if (reader_.find("layout") != nullptr)
        reader_.report("layout", "a block without [blocks] has a [layout]", {}, "leave it out");
    }
    reader_.finish();
    diagnostics_.throw_if_any<DiagramError>();
    if (!role) return;
    check_role(definition_, role_place(), diagnostics_);
    diagnostics_.throw_if_any<DiagramError>();
  }

 private:
  template <class Read>
  void each(std::string_view key, Read read) {
    const text::Value* const table = reader_.table(key);
    if (table == nullptr) return;
    for (const text::Entry& entry : table->entries) read(entry);
  }

  text::Place place(text::SourcePosition position) const { return {definition_.file, position}; }
  text::Place role_place() const { return place(reader_.table().find("role")->position); }

  void check_port(const text::Entry& entry, std::string_view what,
                  std::initializer_list<std::string_view> taken) {
    check_name(entry.key, what, place(entry.position), diagnostics_);
    if (std::find(taken.begin(), taken.end(), entry.key) != taken.end()) {
      diagnostics_.add(
          {place(entry.position),
           fmt::format("'{}' cannot be the name of {}: a block in a diagram uses that key itself", entry.key,
                       what),
           fmt::format("another name than {}", fmt::join(taken, ", ")),
           {}});
    }
    if (!names_.insert(entry.key).second) {
      diagnostics_.add({place(entry.position),
                        fmt::format("the name '{}' is used twice", entry.key),
                        "different names for inputs, outputs and parameters",
                        {}});
    }
  }

  text::TableReader entry_reader(const text::Entry& entry, std::string_view what) {
    return {definition_.file, entry.value, fmt::format("{} '{}'", what, entry.key), diagnostics_};
  }

  void read_input(const text::Entry& entry) {
    check_port(entry, "an input", {"type", "label"});
    text::TableReader reader = entry_reader(entry, "input");
    InputPort input;
    input.name = entry.key;
    input.sum = reader.boolean("sum").value_or(false);
    input.default_value = reader.quantity("default", "machine unit");
    if (input.default_value && !std::isfinite(*input.default_value)) {
      reader.report("default", fmt::format("'default' of input '{}' is infinite", entry.key),
                    "a finite number");
    }
    input.open_with = reader.strings("open_with").value_or(std::vector<std::string>{});
    input.doc = reader.string("doc").value_or("");
    reader.finish();
    definition_.inputs.push_back(std::move(input));
  }

  void check_open_inputs() {
    std::vector<std::string> names;
    for (const InputPort& input : definition_.inputs) names.push_back(input.name);
    for (const InputPort& input : definition_.inputs) {
      for (const std::string& other : input.open_with) {
        if (other != input.name && definition_.find_input(other)) continue;
        diagnostics_.add(
            {{definition_.file, {}},
             fmt::format("'open_with' of input '{}': there is no other input '{}'", input.name, other),
             {},
             text::suggest(other, names)});
      }
    }
  }

  void read_output(const text::Entry& entry, bool composite) {
    check_port(entry, "an output", {});
    text::TableReader reader = entry_reader(entry, "output");
    OutputPort output;
    output.name = entry.key;
    output.place = place(entry.position);
    if (composite) {
      output.wire = reader.required_string("wire", "the inner signal that the output shows").value_or("");
    } else if (reader.find("wire") != nullptr) {
      reader.report("wire", fmt::format("output '{}' of a block without [blocks] has a 'wire'", entry.key),
                    {}, "give the output an equation, or the block inner [blocks]");
    }
    output.doc = reader.string("doc").value_or("");
    reader.finish();
    definition_.outputs.push_back(std::move(output));
  }

  static void read_unit(text::TableReader& reader, std::string_view key, const std::string& parameter,
                        std::string& unit) {
    auto read = reader.string(key);
    if (!read) return;
    if (text::parse_unit(*read)) {
      unit = std::move(*read);
    } else {
      reader.report(key, fmt::format("parameter '{}': there is no unit '{}'", parameter, *read),
                    R"(a unit such as "1", "Hz", "s", "rad", "m/s" or "machine unit")");
    }
  }

  void read_parameter(const text::Entry& entry) {
    check_port(entry, "a parameter", {"type", "label", "in"});
    text::TableReader reader = entry_reader(entry, "parameter");
    ParameterDefinition parameter;
    parameter.name = entry.key;
    if (const auto kind = reader.string("kind")) {
      if (*kind != "number" && *kind != "points" && *kind != "formula")
        reader.report("kind", fmt::format("parameter '{}' is of kind '{}'", entry.key, *kind),
                      "number, points or formula");
      if (*kind == "formula") {
        parameter.formula = text::Expression{};
        const std::string subject = fmt::format("default of parameter '{}'", entry.key);
        if (const text::Value* const value = reader.find("default"))
          parameter.formula =
              read_formula(definition_.file, *value, subject, diagnostics_).value_or(text::Expression{});
        parameter.doc = reader.string("doc").value_or("");
        reader.finish();
        definition_.parameters.push_back(std::move(parameter));
        return;
      }
      if (*kind == "points") {
        read_unit(reader, "x_unit", parameter.name, parameter.x_unit);
        read_unit(reader, "y_unit", parameter.name, parameter.y_unit);
        parameter.points = text::PointTable{{0, 1}, {0, 1}};
        const std::string subject = fmt::format("default of parameter '{}'", entry.key);
        if (const text::Value* const value = reader.find("default"))
          parameter.points = read_points(
              definition_.file, *value,
              {text::parse_unit(parameter.x_unit).value(), text::parse_unit(parameter.y_unit).value()},
              subject, diagnostics_);
        parameter.doc = reader.string("doc").value_or("");
        reader.finish();
        definition_.parameters.push_back(std::move(parameter));
        return;
      }
    }
    read_unit(reader, "unit", parameter.name, parameter.unit);
    parameter.default_value = reader.quantity("default", parameter.unit).value_or(0);
    parameter.above = reader.quantity("above", parameter.unit);
    parameter.below = reader.quantity("below", parameter.unit);
    parameter.at_least = reader.quantity("at_least", parameter.unit);
    parameter.at_most = reader.quantity("at_most", parameter.unit);
    parameter.saturation = reader.boolean("saturation").value_or(false);
    if (parameter.saturation && parameter.unit != "machine unit")
      reader.report("saturation", fmt::format("parameter '{}' is no voltage of an amplifier", entry.key),
                    "a parameter in 'machine unit'");
    parameter.doc = reader.string("doc").value_or("");
    if (!parameter.allows(parameter.default_value)) {
      reader.report("default",
                    fmt::format("the default of parameter '{}' is {}", entry.key, parameter.default_value),
                    parameter.range());
    }
    reader.finish();
    definition_.parameters.push_back(std::move(parameter));
  }

  void read_composite(const text::Value& blocks) {
    for (const std::string_view key : {"let", "equations", "implicit", "cases", "start", "memories", "events",
                                       "check_interval", "requires"}) {
      if (reader_.find(key) == nullptr) continue;
      reader_.report(key, fmt::format("a block with [blocks] has '{}' too", key), "one or the other",
                     "put the equations into a block file of their own");
    }
    definition_.blocks = read_blocks(definition_.file, blocks, diagnostics_);
    if (const text::Value* const layout = reader_.table("layout"))
      definition_.layout = read_layout(definition_.file, *layout, definition_.blocks, diagnostics_);
    if (const text::Value* const machine = reader_.table("machine")) {
      text::TableReader reader(definition_.file, *machine, "[machine]", diagnostics_);
      definition_.inverting = reader.boolean("inverting").value_or(false);
      reader.finish();
    }
    for (const BlockInstance& block : definition_.blocks) {
      const bool parameter = definition_.find_parameter(block.name).has_value();
      if (!parameter && !definition_.find_input(block.name)) continue;
      diagnostics_.add({block.place,
                        fmt::format("'{}' is the name of an inner block and of {} too", block.name,
                                    parameter ? "a parameter" : "an input"),
                        "different names, since a wire may name either",
                        {}});
    }
  }

  text::Diagnostics diagnostics_;
  text::TableReader reader_;
  BlockDefinition& definition_;
  std::set<std::string, std::less<>> names_;
};

}  // namespace

bool ParameterDefinition::allows(double value) const {
  return !std::isnan(value) && (!above || value > *above) && (!below || value < *below) &&
         (!at_least || value >= *at_least) && (!at_most || value <= *at_most);
}

std::string ParameterDefinition::range() const {
  std::string text;
  const auto add = [&](std::string_view word, const std::optional<double>& limit) {
    if (limit) text += fmt::format("{}{} {}", text.empty() ? " " : " and ", word, *limit);
  };
  add("above", above);
  add("at least", at_least);
  add("below", below);
  add("at most", at_most);
  return fmt::format("a number{}{}", text, unit == "1" ? "" : fmt::format(" [{}]", unit));
}

std::optional<std::size_t> BlockDefinition::find_input(std::string_view input) const {
  return find_named(inputs, input);
}

std::optional<std::size_t> BlockDefinition::find_output(std::string_view output) const {
  return find_named(outputs, output);
}

std::optional<std::size_t> BlockDefinition::find_parameter(std::string_view parameter) const {
  return find_named(parameters, parameter);
}

std::optional<std::size_t> BlockDefinition::find_memory(std::string_view memory) const {
  return find_named(memories, memory);
}

const Behaviour* BlockDefinition::choose_behaviour(const std::vector<double>& values, double polarity) const {
  const auto lookup = [&](std::string_view parameter) -> std::optional<double> {
    if (parameter == "polarity") return polarity;
    const auto index = find_parameter(parameter);
    return index ? std::optional(values[*index]) : std::nullopt;
  };
  for (const Behaviour& behaviour : behaviours) {
    if (!behaviour.when || text::evaluate(*behaviour.when, lookup) != 0) return &behaviour;
  }
  return nullptr;
}

const ParameterRelation* BlockDefinition::unmet_relation(const std::vector<double>& values) const {
  const auto lookup = [&](std::string_view parameter) -> std::optional<double> {
    const auto index = find_parameter(parameter);
    return index ? std::optional(values[*index]) : std::nullopt;
  };
  const auto unmet = std::find_if(relations.begin(), relations.end(), [&](const ParameterRelation& relation) {
    return text::evaluate(relation.condition, lookup) == 0;
  });
  return unmet == relations.end() ? nullptr : &*unmet;
}

BlockDefinition parse_block(std::string_view text, std::string file, std::string name) {
  BlockDefinition definition;
  definition.name = std::move(name);
  definition.file = std::move(file);
  definition.text = std::string(text);
  BlockReader(text::parse_document(text, definition.file), definition).read();
  return definition;
}

}  // namespace oblique::diagram
