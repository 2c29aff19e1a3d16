// SPDX-License-Identifier: MIT
#include <oblique/diagram/wiring.h>

#include <algorithm>

#include <oblique/diagram/formula.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/points.h>
#include <oblique/diagram/terms.h>
#include <oblique/text/expression.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::diagram::wiring {
namespace {

/// Composites may stand in composites this deep.
constexpr std::size_t kDeepest = 100;

/// The wires of a setting: a list of them, or one that stands alone.
std::vector<const text::Value*> wires_of(const text::Value& value) {
  if (value.kind != text::Value::Kind::array) return {&value};
  std::vector<const text::Value*> wires;
  for (const text::Value& element : value.elements) wires.push_back(&element);
  return wires;
}

template <class Port>
std::vector<std::string> names_of(const std::vector<Port>& ports) {
  std::vector<std::string> names;
  names.reserve(ports.size());
  for (const Port& port : ports) names.push_back(port.name);
  return names;
}

bool has_word(std::string_view text, std::string_view word) {
  const auto is_word = [](char c) { return text::is_identifier(std::string("_") + c); };
  for (std::size_t at = text.find(word); at != std::string_view::npos; at = text.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    if ((at == 0 || !is_word(text[at - 1])) && (end == text.size() || !is_word(text[end]))) return true;
  }
  return false;
}

/// What may be meant by a key that a block does not have: a name that is near, or else the parameter whose
/// documentation has that word, as "k0" of machines that have no rate.
std::string hint_for(const std::string& key, const BlockDefinition& definition,
                     const std::vector<std::string>& known) {
  if (!text::nearest_name(key, known) && key.size() > 1) {
    for (const ParameterDefinition& parameter : definition.parameters) {
      if (has_word(parameter.doc, key)) return fmt::format("'{}' is {}", parameter.name, parameter.doc);
    }
  }
  return text::suggest(key, known);
}

}  // namespace

Scope Resolver::diagram(const Diagram& diagram) {
  Scope scope;
  scope.file = diagram.file;
  scope.inverting = diagram.machine.inverting;
  scope.machine = machine_ = diagram.machine.profile;
  add_blocks(diagram.blocks, scope);
  return scope;
}

const Scope* Resolver::composite(const BlockDefinition& definition, const text::Place& user) {
  const auto start = std::find(open_.begin(), open_.end(), &definition);
  if (start != open_.end()) {
    std::vector<std::string> circle;
    for (auto step = start; step != open_.end(); ++step) circle.push_back((*step)->name);
    circle.push_back(definition.name);
    diagnostics_->add(
        {user,
         fmt::format("composite '{}' contains itself: {}", definition.name, fmt::join(circle, " contains ")),
         {},
         "build one of them without the other"});
    return nullptr;
  }
  if (open_.size() >= kDeepest) {
    diagnostics_->add({user,
                       fmt::format("composite '{}' is nested too deeply", definition.name),
                       fmt::format("at most {} composites around a block", kDeepest),
                       {}});
    return nullptr;
  }
  auto& scope = composites_[&definition];
  if (scope) return scope.get();
  auto made = std::make_unique<Scope>();
  made->composite = &definition;
  made->file = definition.file;
  made->inverting = definition.inverting;
  made->machine = machine_;
  open_.push_back(&definition);
  add_blocks(definition.blocks, *made);
  read_outputs(*made);
  open_.pop_back();
  return (composites_[&definition] = std::move(made)).get();
}

void Resolver::add_blocks(const std::vector<BlockInstance>& blocks, Scope& scope) {
  scope.blocks.resize(blocks.size());
  scope.index.reserve(blocks.size());
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    WiredBlock& block = scope.blocks[i];
    block.instance = &blocks[i];
    if (!scope.index.emplace(blocks[i].name, i).second) {
      diagnostics_->add({blocks[i].place,
                         fmt::format("there are two blocks '{}'{}", blocks[i].name, scope.belonging()),
                         "a name of its own for each block",
                         {}});
    }
    find_definition(scope, block);
  }
  for (WiredBlock& block : scope.blocks) {
    if (block.definition != nullptr) read_settings(scope, block);
  }
}

void Resolver::find_definition(const Scope& scope, WiredBlock& block) {
  const BlockInstance& instance = *block.instance;
  const BlockDefinition* const definition = library_->find(instance.type);
  if (definition == nullptr) {
    diagnostics_->add({instance.place,
                       fmt::format("block '{}'{}: there is no block type '{}'", instance.name,
                                   scope.belonging(), instance.type),
                       {},
                       text::suggest(instance.type, library_->names())});
    return;
  }
  if (definition->is_composite()) {
    block.inside = composite(*definition, instance.place);
    if (block.inside == nullptr) return;
  }
  block.definition = definition;
  block.parameters.resize(definition->parameters.size());
  block.inputs.resize(definition->inputs.size());
}

void Resolver::read_settings(const Scope& scope, WiredBlock& block) {
  const BlockDefinition& definition = *block.definition;
  std::vector<const text::Entry*> drivers(definition.inputs.size());
  for (const text::Entry& entry : block.instance->settings) {
    if (const auto parameter = definition.find_parameter(entry.key)) {
      WiredParameter& wired = block.parameters[*parameter];
      const std::string subject = describe_port(scope, "parameter", block, entry.key);
      if (definition.parameters[*parameter].points) {
        const ParameterDefinition& points = definition.parameters[*parameter];
        wired.points =
            read_points(scope.file, entry.value,
                        {unit_on(scope.machine, points.x_unit), unit_on(scope.machine, points.y_unit)},
                        subject, *diagnostics_);
        continue;
      }
      if (definition.parameters[*parameter].formula) {
        wired.formula = read_formula(scope.file, entry.value, subject, *diagnostics_);
        continue;
      }
      const auto value =
          read_parameter(scope, entry.value, definition.parameters[*parameter], subject, *diagnostics_);
      if (value) wired = {true, {}, {}, *value, entry.value.position};
    } else if (const auto input = definition.find_input(entry.key)) {
      connect(scope, block, *input, entry, wires_of(entry.value), drivers);
    } else if (entry.key == "in") {
      read_input_list(scope, block, entry, drivers);
    } else {
      std::vector<std::string> known = names_of(definition.inputs);
      for (const ParameterDefinition& p : definition.parameters) known.push_back(p.name);
      diagnostics_->add(
          {{scope.file, entry.position},
           fmt::format("{} has no input and no parameter '{}'", describe_block(scope, block), entry.key),
           {},
           hint_for(entry.key, definition, known)});
    }
  }
  check_open_inputs(scope, block);
}

void Resolver::read_input_list(const Scope& scope, WiredBlock& block, const text::Entry& entry,
                               std::vector<const text::Entry*>& drivers) {
  const std::vector<InputPort>& inputs = block.definition->inputs;
  const auto wires = wires_of(entry.value);
  if (inputs.size() == 1) {
    connect(scope, block, 0, entry, wires, drivers);
    return;
  }
  if (wires.size() > inputs.size() || inputs.empty()) {
    const std::string count =
        inputs.empty() ? "no inputs"
                       : fmt::format("{} inputs ({})", inputs.size(), fmt::join(names_of(inputs), ", "));
    diagnostics_->add(
        {{scope.file, entry.value.position},
         fmt::format("{} has {}, but 'in' lists {}", describe_block(scope, block), count, wires.size()),
         {},
         inputs.empty() ? "take 'in' away" : "list one signal for each input"});
    for (std::size_t i = 0; i < inputs.size(); ++i) block.inputs[i].connected = true;
    return;
  }
  for (std::size_t i = 0; i < wires.size(); ++i) connect(scope, block, i, entry, {wires[i]}, drivers);
}

void Resolver::connect(const Scope& scope, WiredBlock& block, std::size_t input, const text::Entry& entry,
                       std::vector<const text::Value*> wires, std::vector<const text::Entry*>& drivers) {
  const InputPort& port = block.definition->inputs[input];
  WiredInput& wired = block.inputs[input];
  const std::string subject = describe_port(scope, "input", block, port.name);
  for (const text::Value* const wire : wires) {
    if (wire->kind == text::Value::Kind::string || wire->kind == text::Value::Kind::number) continue;
    diagnostics_->add({{scope.file, wire->position},
                       fmt::format("{} is given {}", subject, text::kind_name(wire->kind)),
                       "the name of a signal, or a list of names",
                       {}});
    wired.connected = true;
    return;
  }
  if (drivers[input] != nullptr) {
    diagnostics_->add(
        {{scope.file, entry.position},
         fmt::format("{} is doubly driven: by '{}' and by '{}'", subject, drivers[input]->key, entry.key),
         {},
         "keep one of the two"});
    return;
  }
  if (!port.sum && wires.size() > 1) {
    wired.connected = true;
    diagnostics_->add(
        {{scope.file, wires[1]->position},
         fmt::format("{} is doubly driven: it takes one signal and was given {}", subject, wires.size()),
         {},
         "add the signals in a block with a summing input and wire its output here"});
    return;
  }
  wired.connected = !wires.empty() || port.sum;  // an empty list says that nothing is to be added
  if (wired.connected) drivers[input] = &entry;
  for (const text::Value* const wire : wires) {
    if (auto term = read_term(scope, *wire, subject, *diagnostics_)) wired.terms.push_back(std::move(*term));
  }
}

void Resolver::check_open_inputs(const Scope& scope, const WiredBlock& block) {
  for (std::size_t i = 0; i < block.inputs.size(); ++i) {
    const InputPort& port = block.definition->inputs[i];
    if (block.inputs[i].connected || port.default_value) continue;
    const bool may_be_open =
        std::any_of(port.open_with.begin(), port.open_with.end(), [&](const std::string& other) {
          const auto input = block.definition->find_input(other);
          return input && block.inputs[*input].connected;
        });
    if (may_be_open) continue;
    diagnostics_->add(
        {block.instance->place,
         fmt::format("{} ({}) is not connected", describe_port(scope, "input", block, port.name),
                     block.instance->type),
         "a signal",
         fmt::format("{} = \"NAME OF A SIGNAL\"{}", port.name,
                     port.sum ? fmt::format(", or {} = [] where nothing is to be added", port.name) : "")});
  }
}

void Resolver::read_outputs(Scope& scope) {
  for (const OutputPort& output : scope.composite->outputs) {
    const std::string subject = fmt::format("output '{}'{}", output.name, scope.belonging());
    auto source = find_signal(scope, output.wire, output.place.position, subject, *diagnostics_);
    if (source && source->own_input) {
      diagnostics_->add({output.place,
                         fmt::format("{} shows the input '{}'", subject, output.wire),
                         "the signal of an inner block",
                         {}});
      source.reset();
    }
    const auto hidden = scope.index.find(output.name);
    if (source && hidden != scope.index.end() && source->blocks.front() != hidden->second) {
      diagnostics_->add(
          {output.place,
           fmt::format("{} has the name of an inner block but shows '{}'", subject, output.wire),
           "another name", "'block.name' would not say which of the two is meant"});
    }
    scope.outputs.push_back(std::move(source));
  }
}

}  // namespace oblique::diagram::wiring
