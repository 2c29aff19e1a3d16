// SPDX-License-Identifier: MIT
#include <oblique/draw/schematic/schematic.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/names.h>
#include <oblique/diagram/wiring.h>
#include <oblique/draw/schematic/servo_loops.h>

namespace oblique::draw::schematic {
namespace {

using diagram::wiring::Scope;
using diagram::wiring::Source;
using diagram::wiring::WiredBlock;

/// An output of the diagram: its signal, and what is written there.
struct Record {
  Source source;
  std::string text;
};

/// What is around the blocks: a composite, or the diagram itself.
struct Around {
  const Scope* scope = nullptr;
  const std::vector<diagram::BlockPlace>* layout = nullptr;
  std::vector<Record> records;  ///< of the diagram
  std::vector<double> parameters;
  std::string path;                    ///< of what is inside: "q." in the composite q
  std::vector<std::string> inputs;     ///< what a console reads at each input; see Block::reads
  std::vector<std::string> outputs;    ///< as on its frame
  std::vector<Source> signals_inside;  ///< those of the outputs beyond the definition's
  bool is_sketch = false;
};

/// Whether a block's equations change their sign on a machine whose amplifiers invert.
bool follows_polarity(const diagram::BlockDefinition& definition) {
  for (const diagram::Behaviour& behaviour : definition.behaviours) {
    for (const diagram::Equation& equation : behaviour.equations) {
      for (const text::Expression* const name : diagram::names_in(equation.expression)) {
        if (name->name == "polarity") return true;
      }
    }
  }
  return false;
}

class Builder {
 public:
  Builder(const Around& around, int depth) : around_(around), scope_(*around.scope), depth_(depth) {}

  Schematic build() {
    stand_for_constants();
    for (std::size_t i = 0; i < scope_.blocks.size(); ++i) add_block(i);
    if (scope_.composite != nullptr) add_inputs();
    for (std::size_t i = 0; i < scope_.blocks.size(); ++i) connect(i);
    if (scope_.composite != nullptr) add_outputs();
    for (const Record& record : around_.records) write_record(record);
    mark_wired();
    name_signals();
    for (std::size_t i = 0; i < scope_.blocks.size(); ++i) open(i);
    schematic_.layout = around_.layout;
    schematic_.is_sketch = around_.is_sketch;
    find_servo_loops(schematic_);
    return std::move(schematic_);
  }

 private:
  static bool is_constant(const WiredBlock& block) {
    return block.definition->symbol == "constant" && block.definition->inputs.empty() &&
           !block.definition->parameters.empty();
  }

  /// A constant that only feeds inputs is drawn there: the reference of a machine is everywhere.
  void stand_for_constants() {
    std::vector<bool> used(scope_.blocks.size());
    for (const WiredBlock& block : scope_.blocks) {
      for (const auto& input : block.inputs) {
        for (const auto& term : input.terms) {
          if (!term.source.own_input) used[term.source.blocks.front()] = true;
        }
      }
    }
    std::vector<bool> shown(scope_.blocks.size());
    for (const auto& output : scope_.outputs) {
      if (output && !output->own_input) shown[output->blocks.front()] = true;
    }
    for (const Source& source : around_.signals_inside) shown[source.blocks.front()] = true;
    for (std::size_t i = 0; i < scope_.blocks.size(); ++i)
      stands_at_inputs_.push_back(is_constant(scope_.blocks[i]) && used[i] && !shown[i] && !has_own_place(i));
    hidden_ = stands_at_inputs_;
    for (const Record& record : around_.records) hidden_[record.source.blocks.front()] = false;
  }

  /// In a sketch what was put somewhere stays there.
  bool has_own_place(std::size_t i) const {
    const std::vector<diagram::BlockPlace>& places = *around_.layout;
    return around_.is_sketch &&
           std::any_of(places.begin(), places.end(), [&](const diagram::BlockPlace& place) {
             return place.name == scope_.blocks[i].instance->name;
           });
  }

  double value_of(const diagram::wiring::Constant& constant) const {
    return constant.value(scope_.composite, around_.parameters);
  }

  std::vector<double> parameters_of(const WiredBlock& wired) const {
    std::vector<double> values;
    for (std::size_t k = 0; k < wired.parameters.size(); ++k) {
      const auto& parameter = wired.parameters[k];
      const bool is_number = parameter.given && !parameter.points && !parameter.formula;
      values.push_back(is_number ? value_of(parameter.value) : wired.definition->parameters[k].default_value);
    }
    return values;
  }

  void add_block(std::size_t i) {
    const WiredBlock& wired = scope_.blocks[i];
    index_.push_back(schematic_.blocks.size());
    if (hidden_[i]) return;
    Block block;
    block.name = wired.instance->name;
    block.label = wired.instance->label;
    block.definition = wired.definition;
    block.parameters = parameters_of(wired);
    for (const auto& parameter : wired.parameters) block.given.push_back(parameter.given);
    for (const diagram::OutputPort& output : wired.definition->outputs) block.outputs.push_back(output.name);
    block.inverts = scope_.inverting && follows_polarity(*wired.definition);
    schematic_.blocks.push_back(std::move(block));
  }

  void add_inputs() {
    for (const auto& input : scope_.composite->inputs) {
      inputs_.push_back(schematic_.blocks.size());
      Block port;
      port.kind = Block::Kind::input;
      port.name = input.name;
      port.outputs = {port.name};
      schematic_.blocks.push_back(std::move(port));
    }
  }

  /// "+1": the reference of the machine has a sign.
  static std::string reference_text(double value) { return (value == 1 ? "+" : "") + number_text(value); }

  std::string constant_text(std::size_t i) const {
    const WiredBlock& wired = scope_.blocks[i];
    const double value = parameters_of(wired).front();
    if (std::abs(value) == 1) return reference_text(value);
    const std::string& name = wired.instance->label.empty() ? wired.instance->name : wired.instance->label;
    constexpr std::size_t kLongest = 12;
    return name.size() > kLongest ? number_text(value) : fmt::format("{} = {}", name, number_text(value));
  }

  /// The signal that a source means; on a composite it gets an output for a signal inside.
  Signal signal_of(const Source& source) {
    if (source.own_input) return {inputs_[*source.own_input], 0};
    const std::size_t first = source.blocks.front();
    if (source.blocks.size() == 1) return {index_[first], source.output};
    std::string name;
    const WiredBlock* at = &scope_.blocks[first];
    for (std::size_t k = 1; k < source.blocks.size(); ++k) {
      at = &at->inside->blocks[source.blocks[k]];
      name += (k > 1 ? "." : "") + at->instance->name;
    }
    if (at->definition->outputs.size() > 1) name += "." + at->definition->outputs[source.output].name;
    Block& block = schematic_.blocks[index_[first]];
    const auto known =
        std::find(block.outputs.begin() + static_cast<std::ptrdiff_t>(block.definition->outputs.size()),
                  block.outputs.end(), name);
    const auto output = static_cast<std::size_t>(known - block.outputs.begin());
    if (known == block.outputs.end()) {
      block.outputs.push_back(name);
      inside_[first].push_back({{}, {source.blocks.begin() + 1, source.blocks.end()}, source.output});
    }
    return {index_[first], output};
  }

  static bool may_stay_open(const WiredBlock& wired, std::size_t k) {
    const diagram::InputPort& port = wired.definition->inputs[k];
    if (port.default_value || (port.sum && wired.inputs[k].connected)) return true;
    return std::any_of(port.open_with.begin(), port.open_with.end(), [&](const std::string& other) {
      const auto input = wired.definition->find_input(other);
      return input && wired.inputs[*input].connected;
    });
  }

  void connect(std::size_t i) {
    if (stands_at_inputs_[i]) return;
    const WiredBlock& wired = scope_.blocks[i];
    std::vector<Input> inputs;
    for (std::size_t k = 0; k < wired.inputs.size(); ++k) {
      for (const auto& term : wired.inputs[k].terms) {
        Input input;
        input.port = wired.definition->inputs[k].name;
        input.port_index = k;
        input.weight = value_of(term.weight);
        input.source = term.signal;
        input.position = term.position;
        if (!term.source.own_input && stands_at_inputs_[term.source.blocks.front()]) {
          input.constant = constant_text(term.source.blocks.front());
          input.reads = read_name(around_.path, scope_.blocks[term.source.blocks.front()], 0);
        } else {
          input.signal = signal_of(term.source);
        }
        inputs.push_back(std::move(input));
      }
      // so that composites of one kind look alike whichever of their inputs are used
      const diagram::InputPort& port = wired.definition->inputs[k];
      if (wired.inside != nullptr && !wired.inputs[k].connected && port.default_value)
        inputs.push_back(
            {port.name, k, 1, {}, reference_text(*port.default_value), false, {}, {}, {}, {}, false});
      if (around_.is_sketch && wired.inputs[k].terms.empty() && !may_stay_open(wired, k))
        inputs.push_back({port.name, k, 1, {}, "?", false, {}, {}, {}, {}, true});
    }
    schematic_.blocks[index_[i]].inputs = std::move(inputs);
  }

  void add_outputs() {
    const std::size_t own = scope_.composite->outputs.size();
    for (std::size_t k = 0; k < around_.outputs.size(); ++k) {
      Block port;
      port.kind = Block::Kind::output;
      port.name = around_.outputs[k];
      Input input;
      input.signal = signal_of(k < own ? *scope_.outputs[k] : around_.signals_inside[k - own]);
      port.inputs.push_back(std::move(input));
      schematic_.blocks.push_back(std::move(port));
    }
  }

  void mark_wired() {
    for (Block& block : schematic_.blocks) block.wired.resize(block.outputs.size());
    for (const Block& block : schematic_.blocks) {
      for (const Input& input : block.inputs) {
        if (input.signal) schematic_.blocks[input.signal->block].wired[input.signal->output] = true;
      }
    }
  }

  /// The signal as a console calls it: that of a primitive block, whatever composites show it.
  static std::string read_name(const std::string& path, const WiredBlock& block, std::size_t output) {
    const std::string at = path + block.instance->name;
    if (block.inside != nullptr) return read_name(at + ".", *block.inside, *block.inside->outputs[output]);
    return block.definition->outputs.size() > 1 ? at + "." + block.definition->outputs[output].name : at;
  }
  static std::string read_name(std::string path, const Scope& scope, const Source& source) {
    const WiredBlock* at = &scope.blocks[source.blocks.front()];
    for (std::size_t k = 1; k < source.blocks.size(); ++k) {
      path += at->instance->name + ".";
      at = &at->inside->blocks[source.blocks[k]];
    }
    return read_name(path, *at, source.output);
  }

  void name_signals() {
    for (std::size_t i = 0; i < scope_.blocks.size(); ++i) {
      if (hidden_[i]) continue;
      const WiredBlock& wired = scope_.blocks[i];
      Block& block = schematic_.blocks[index_[i]];
      const std::size_t own = wired.definition->outputs.size();
      for (std::size_t k = 0; k < block.outputs.size(); ++k)
        block.reads.push_back(
            k < own ? read_name(around_.path, wired, k)
                    : read_name(around_.path + block.name + ".", *wired.inside, inside_[i][k - own]));
    }
    for (std::size_t k = 0; k < inputs_.size(); ++k)
      schematic_.blocks[inputs_[k]].reads = {around_.inputs[k]};
    for (Block& block : schematic_.blocks) {
      for (Input& input : block.inputs) {
        if (input.signal) input.reads = schematic_.blocks[input.signal->block].reads[input.signal->output];
      }
    }
  }

  void write_record(const Record& record) {
    const Signal signal = signal_of(record.source);
    Block& block = schematic_.blocks[signal.block];
    block.records.resize(block.outputs.size());
    std::string& text = block.records[signal.output];
    text += (text.empty() ? "" : ", ") + record.text;
  }

  /// The signal that arrives at an input of a block unchanged, as a console calls it; empty where none does.
  static std::string arriving(const Block& block, std::size_t port) {
    const auto at = [&](const Input& input) { return input.port_index == port; };
    const auto first = std::find_if(block.inputs.begin(), block.inputs.end(), at);
    if (first == block.inputs.end() || first->weight != 1) return {};
    return std::find_if(std::next(first), block.inputs.end(), at) == block.inputs.end() ? first->reads
                                                                                        : std::string{};
  }

  void open(std::size_t i) {
    const WiredBlock& wired = scope_.blocks[i];
    if (depth_ <= 0 || wired.inside == nullptr) return;
    Block& block = schematic_.blocks[index_[i]];
    Around around;
    around.scope = wired.inside;
    around.parameters = block.parameters;
    around.layout = &wired.definition->layout;
    around.path = around_.path + block.name + ".";
    for (std::size_t k = 0; k < wired.inputs.size(); ++k) around.inputs.push_back(arriving(block, k));
    around.outputs = block.outputs;
    around.signals_inside = inside_[i];
    block.inside.push_back(Builder(around, depth_ - 1).build());
  }

  const Around& around_;
  const Scope& scope_;
  int depth_;
  Schematic schematic_;
  std::vector<bool> stands_at_inputs_;
  std::vector<bool> hidden_;                           ///< those of them that have no symbol of their own
  std::vector<std::size_t> index_;                     ///< in the schematic, of each block of the scope
  std::vector<std::size_t> inputs_;                    ///< of each input of the composite
  std::map<std::size_t, std::vector<Source>> inside_;  ///< signals inside a composite that are used outside
};

/// "side [m]".
std::string record_text(const diagram::OutputSpec& output) {
  const bool has_unit =
      output.unit != diagram::OutputSpec{}.unit && output.unit != "1" && !output.unit.empty();
  return has_unit ? fmt::format("{} [{}]", output.name, output.unit) : output.name;
}

std::vector<Record> records_of(const diagram::Diagram& diagram, const Scope& scope,
                               text::Diagnostics& diagnostics) {
  std::vector<Record> records;
  for (const diagram::OutputSpec& output : diagram.outputs) {
    const std::string subject = fmt::format("output '{}'", output.name);
    if (auto source = find_signal(scope, output.signal, output.place.position, subject, diagnostics))
      records.push_back({std::move(*source), record_text(output)});
  }
  return records;
}

/// Guards against composites of composites whose size explodes; a drawing of so many takes seconds.
constexpr std::size_t kMostBlocks = 30'000;

/// How many blocks are seen with so many levels open; one more than kMostBlocks where they are more.
std::size_t blocks_seen(const Scope& scope, int depth,
                        std::map<std::pair<const Scope*, int>, std::size_t>& known) {
  const auto [found, is_new] = known.try_emplace({&scope, depth}, scope.blocks.size());
  if (!is_new) return found->second;
  std::size_t seen = scope.blocks.size();
  for (const WiredBlock& wired : scope.blocks) {
    if (depth > 0 && wired.inside != nullptr) seen += blocks_seen(*wired.inside, depth - 1, known);
    seen = std::min(seen, kMostBlocks + 1);
  }
  return known[{&scope, depth}] = seen;
}

/// `diagnostics` gets what is wrong with the wiring; where it is no sketch, that is thrown.
Schematic schematic_of(const diagram::Diagram& diagram, const diagram::BlockLibrary& library, int depth,
                       bool is_sketch, text::Diagnostics& diagnostics) {
  diagram::wiring::Resolver resolver(library, diagnostics);
  const Scope scope = resolver.diagram(diagram);
  Around around;
  around.scope = &scope;
  around.layout = &diagram.layout;
  around.is_sketch = is_sketch;
  around.records = records_of(diagram, scope, diagnostics);
  if (!is_sketch) diagnostics.throw_if_any<diagram::DiagramError>();
  std::map<std::pair<const Scope*, int>, std::size_t> known;
  if (blocks_seen(scope, depth, known) > kMostBlocks) {
    throw diagram::DiagramError(
        text::Diagnostic{{diagram.file, {}},
                         fmt::format("opened that far, the drawing has more than {} blocks", kMostBlocks),
                         {},
                         "open fewer levels of composites"});
  }
  return Builder(around, depth).build();
}

}  // namespace

std::string number_text(double value) {
  if (!std::isfinite(value)) return value > 0 ? "∞" : value < 0 ? "−∞" : "?";
  const std::string text = fmt::format("{:.4g}", std::abs(value));
  return (value < 0 ? "−" : "") + text;
}

Schematic make_schematic(const diagram::Diagram& diagram, const diagram::BlockLibrary& library, int depth) {
  text::Diagnostics diagnostics;
  return schematic_of(diagram, library, depth, false, diagnostics);
}

Schematic sketch_schematic(const diagram::Diagram& diagram, const diagram::BlockLibrary& library) {
  text::Diagnostics diagnostics;
  return schematic_of(diagram, library, 0, true, diagnostics);
}

}  // namespace oblique::draw::schematic
