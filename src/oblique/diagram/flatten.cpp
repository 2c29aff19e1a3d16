// SPDX-License-Identifier: MIT
#include <oblique/diagram/flatten.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/machine_defaults.h>
#include <oblique/diagram/names.h>
#include <oblique/diagram/overrides.h>
#include <oblique/diagram/terms.h>
#include <oblique/diagram/timeline.h>
#include <oblique/diagram/wiring.h>

namespace oblique::diagram {
namespace {

using wiring::Constant;
using wiring::Scope;
using wiring::Source;
using wiring::WiredBlock;

/// Guards against composites of composites whose size explodes.
constexpr std::size_t kMostBlocks = 300'000;
constexpr std::size_t kMostWires = 3'000'000;

/// One block of the tree of composites, laid out with its own parameters.
struct Node {
  const WiredBlock* wired = nullptr;  ///< none for the diagram itself, which is the root
  const Scope* inside = nullptr;
  std::size_t parent = 0;
  std::size_t first_child = 0;  ///< children stand side by side, in the order of `inside->blocks`
  std::size_t flat = 0;         ///< of a primitive block: its index in the flat diagram
  std::string path;
  text::Place place;  ///< of the block of the diagram that it is or is a part of
  std::vector<double> parameters;
  std::vector<bool> open;         ///< parameters that no one has given a value
  std::vector<FlatInput> inputs;  ///< of a composite
};

class Layout {
 public:
  Layout(const Scope& diagram, wiring::MachineDefaults& machine, const wiring::Replacements& replacements,
         FlatDiagram& flat, text::Diagnostics& diagnostics)
      : machine_(machine), replacements_(replacements), flat_(flat), diagnostics_(diagnostics) {
    Node root;
    root.inside = &diagram;
    nodes_.push_back(std::move(root));
    expand(0);
    connect_children(0);
  }

  /// The output that a source of the diagram means; nothing where the way there is broken and reported.
  std::optional<SignalRef> signal(const Source& source) const { return signal(0, source); }

 private:
  void report_size(std::string_view things, std::size_t most) {
    if (!too_large_) {
      const text::Place place{flat_.file, {}};
      diagnostics_.add({place,
                        fmt::format("the diagram has too many {}", things),
                        fmt::format("at most {}, those inside composites counted", most),
                        {}});
    }
    too_large_ = true;
  }

  /// Makes the blocks inside a composite, depth first, so that the flat blocks keep the order of the files.
  void expand(std::size_t parent) {
    const Scope& scope = *nodes_[parent].inside;
    const std::size_t first = nodes_.size();
    if (first + scope.blocks.size() > kMostBlocks) {
      report_size("blocks", kMostBlocks);
      nodes_[parent].inside = nullptr;
      return;
    }
    nodes_[parent].first_child = first;
    nodes_.resize(first + scope.blocks.size());
    for (std::size_t i = 0; i < scope.blocks.size(); ++i) {
      const WiredBlock& wired = scope.blocks[i];
      Node& node = nodes_[first + i];
      node.wired = &wired;
      node.inside = wired.inside;
      node.parent = parent;
      if (wired.definition == nullptr) continue;
      const std::string& around = nodes_[parent].path;
      node.path = around.empty() ? wired.instance->name : around + "." + wired.instance->name;
      node.place = parent == 0 ? wired.instance->place : nodes_[parent].place;
      set_parameters(node, nodes_[parent]);
      if (wired.inside != nullptr) {
        expand(first + i);
      } else {
        add_flat_block(node, scope);
      }
    }
  }

  void set_parameters(Node& node, const Node& parent) {
    const BlockDefinition& definition = *node.wired->definition;
    const auto& machine = machine_.of(definition);
    node.parameters.reserve(definition.parameters.size());
    for (std::size_t k = 0; k < definition.parameters.size(); ++k) {
      const ParameterDefinition& parameter = definition.parameters[k];
      const wiring::WiredParameter& wired = node.wired->parameters[k];
      const bool open = !wired.given || is_passed_on(wired.value, parent);
      const bool of_machine = open && machine[k];
      const double value = of_machine    ? *machine[k]
                           : wired.given ? value_of(wired.value, parent)
                                         : parameter.default_value;
      // Other values were checked with their file; a block of the user may not allow what the shipped one
      // does.
      if ((of_machine || wired.value.expression) && !parameter.allows(value)) {
        wiring::check_range(
            parameter, value, fmt::format("parameter '{}.{}'", node.path, parameter.name),
            of_machine ? node.place : text::Place{parent.inside->file, wired.position},
            of_machine ? fmt::format("it follows from the machine '{}'", machine_.profile()) : origin(parent),
            diagnostics_);
      }
      node.parameters.push_back(value);
      node.open.push_back(open);
    }
    const wiring::Replacement* const replaced = replacement_of(node);
    if (replaced == nullptr) return;
    for (const auto& [parameter, value] : replaced->parameters) {
      node.parameters[parameter] = value;
      node.open[parameter] = false;
    }
  }

  /// What the request replaces in a block; nothing in most.
  const wiring::Replacement* replacement_of(const Node& node) const {
    if (replacements_.empty()) return nullptr;
    const auto replaced = replacements_.find(node.path);
    return replaced == replacements_.end() ? nullptr : &replaced->second;
  }

  /// The weight of one wire of a block.
  double weight_of(const Node& node, std::size_t input, std::size_t wire, const Node& parent) const {
    if (const wiring::Replacement* const replaced = replacement_of(node)) {
      // the last word counts, as it does of parameters
      const auto& weights = replaced->weights;
      const auto found = std::find_if(weights.rbegin(), weights.rend(), [&](const auto& weight) {
        return weight.input == input && weight.wire == wire;
      });
      if (found != weights.rend()) return found->value;
    }
    return value_of(node.wired->inputs[input].terms[wire].weight, parent);
  }

  /// Whether a composite hands down one of its own parameters as it is, and that one is open.
  static bool is_passed_on(const Constant& constant, const Node& composite) {
    if (!constant.expression || constant.number != 1) return false;
    if (constant.expression->kind != text::Expression::Kind::name) return false;
    const auto own = composite.inside->composite->find_parameter(constant.expression->name);
    return own && composite.open[*own];
  }

  static double value_of(const Constant& constant, const Node& composite) {
    return constant.value(composite.inside->composite, composite.parameters);
  }

  /// Where the parameters of a composite come from: the remedy for values that follow from them.
  static std::string origin(const Node& composite) {
    const text::Place& place = composite.wired->instance->place;
    return fmt::format("it follows from the parameters of '{}' ({}:{}:{})", composite.path, place.file,
                       place.position.line, place.position.column);
  }

  void add_flat_block(Node& node, const Scope& scope) {
    FlatBlock block;
    block.path = node.path;
    block.definition = node.wired->definition;
    block.polarity = scope.inverting ? -1 : 1;
    block.parameters = node.parameters;
    for (std::size_t k = 0; k < node.parameters.size(); ++k) {
      const bool machine = node.open[k] && machine_.of(*block.definition)[k];
      if (machine && block.definition->parameters[k].saturation) block.saturation = k;
    }
    for (std::size_t k = 0; k < block.definition->parameters.size(); ++k) {
      const ParameterDefinition& parameter = block.definition->parameters[k];
      if (parameter.formula)
        block.formulas[parameter.name] = node.wired->parameters[k].formula.value_or(*parameter.formula);
      const auto& default_points = parameter.points;
      if (!default_points) continue;
      block.points.resize(block.definition->parameters.size());
      block.points[k] = node.wired->parameters[k].points.value_or(*default_points);
    }
    check_relations(node);
    block.choose_behaviour();
    block.place = node.place;
    node.flat = flat_.blocks.size();
    flat_.blocks.push_back(std::move(block));
  }

  void check_relations(const Node& node) {
    const BlockDefinition& definition = *node.wired->definition;
    const ParameterRelation* const unmet = definition.unmet_relation(node.parameters);
    if (unmet == nullptr) return;
    std::vector<std::string> values;
    for (const text::Expression* const name : names_in(unmet->condition)) {
      const auto k = definition.find_parameter(name->name);
      if (!k) continue;
      const std::string& unit = definition.parameters[*k].unit;
      values.push_back(fmt::format("{} = {}{}", name->name, node.parameters[*k],
                                   unit == "1" ? "" : fmt::format(" [{}]", unit)));
    }
    diagnostics_.add({node.place,
                      fmt::format("'{}' ({}) has {}", node.path, definition.name, fmt::join(values, " and ")),
                      unmet->text,
                      {}});
  }

  /// Connects the inputs of all blocks inside a composite whose own inputs are known.
  void connect_children(std::size_t parent) {
    const Scope* const scope = nodes_[parent].inside;
    if (scope == nullptr) return;
    for (std::size_t i = 0; i < scope->blocks.size(); ++i) {
      const std::size_t child = nodes_[parent].first_child + i;
      if (scope->blocks[i].definition == nullptr) continue;
      std::vector<FlatInput> inputs = connect(nodes_[child], parent);
      if (nodes_[child].wired->inside != nullptr) {
        nodes_[child].inputs = std::move(inputs);
        connect_children(child);
      } else {
        flat_.blocks[nodes_[child].flat].inputs = std::move(inputs);
      }
    }
  }

  std::vector<FlatInput> connect(const Node& node, std::size_t parent) {
    const BlockDefinition& definition = *node.wired->definition;
    std::vector<FlatInput> inputs(definition.inputs.size());
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      const wiring::WiredInput& wired = node.wired->inputs[k];
      if (!wired.connected) inputs[k].constant = definition.inputs[k].default_value.value_or(0);
      for (std::size_t wire = 0; wire < wired.terms.size(); ++wire) {
        const wiring::Term& term = wired.terms[wire];
        const double weight = weight_of(node, k, wire, nodes_[parent]);
        if (std::isfinite(weight)) {
          add_term(inputs[k], weight, term.source, parent);
        } else {
          diagnostics_.add({{nodes_[parent].inside->file, term.position},
                            fmt::format("the weight '{}' is {}",
                                        wiring::weight_name(node.path, definition.inputs[k].name, wire),
                                        wiring::describe_number(weight)),
                            "a finite number",
                            origin(nodes_[parent])});
        }
      }
    }
    return inputs;
  }

  void add_term(FlatInput& input, double weight, const Source& source, std::size_t parent) {
    if (source.own_input) {
      const FlatInput& outer = nodes_[parent].inputs[*source.own_input];
      wires_ += outer.terms.size();
      if (wires_ > kMostWires) {
        report_size("wires", kMostWires);
        return;
      }
      for (const FlatTerm& term : outer.terms) input.terms.push_back({weight * term.weight, term.signal});
      input.constant += weight * outer.constant;
    } else if (const auto ref = signal(parent, source)) {
      input.terms.push_back({weight, *ref});
    }
  }

  std::optional<SignalRef> signal(std::size_t parent, const Source& source) const {
    std::size_t at = parent;
    for (const std::size_t block : source.blocks) {
      if (nodes_[at].inside == nullptr) return std::nullopt;
      at = nodes_[at].first_child + block;
    }
    if (nodes_[at].wired->inside == nullptr) return SignalRef{nodes_[at].flat, source.output};
    const std::optional<Source>& inner = nodes_[at].wired->inside->outputs[source.output];
    return inner ? signal(at, *inner) : std::nullopt;
  }

  wiring::MachineDefaults& machine_;
  const wiring::Replacements& replacements_;
  FlatDiagram& flat_;
  text::Diagnostics& diagnostics_;
  std::vector<Node> nodes_;
  std::size_t wires_ = 0;  ///< that composites passed on from their inputs
  bool too_large_ = false;
};

void add_output(const Layout& layout, const OutputSpec& spec, const Source& source, FlatDiagram& flat) {
  if (const auto signal = layout.signal(source))
    flat.outputs.push_back({spec.name, *signal, spec.scale, spec.unit, spec.offset});
}

void choose_outputs(const Diagram& diagram, const Scope& scope, const Layout& layout, FlatDiagram& flat,
                    text::Diagnostics& diagnostics) {
  for (const OutputSpec& output : diagram.outputs) {
    const std::string subject = fmt::format("output '{}'", output.name);
    const auto source =
        wiring::find_signal(scope, output.signal, output.place.position, subject, diagnostics);
    if (source) add_output(layout, output, *source, flat);
  }
  if (!diagram.outputs.empty()) return;
  for (std::size_t i = 0; i < scope.blocks.size(); ++i) {
    const BlockDefinition* const definition = scope.blocks[i].definition;
    if (definition == nullptr) continue;
    for (std::size_t k = 0; k < definition->outputs.size(); ++k) {
      OutputSpec all;
      all.name = diagram.blocks[i].name;
      if (definition->outputs.size() > 1) all.name += "." + definition->outputs[k].name;
      add_output(layout, all, {{}, {i}, k}, flat);
    }
  }
}

/// Reports what `[published]` and `[lesson]` set and is not there, or cannot be set so.
void check_settings(const Diagram& diagram, const Scope& scope, text::Diagnostics& diagnostics) {
  const auto check = [&](const std::vector<ParameterOverride>& settings) {
    if (!settings.empty()) wiring::resolve_overrides(scope, settings, diagnostics);
  };
  if (diagram.published) {
    for (const PublishedValue& value : diagram.published->values) check(value.set);
  }
  if (!diagram.lesson) return;
  for (const LessonStep& step : diagram.lesson->steps) check(step.set);
  if (const auto& question = diagram.lesson->question)
    wiring::check_override_path(scope, question->answer, question->place, diagnostics);
}

/// Of elements that are as the machine `elements` has them.
FlatDiagram flatten_on(const std::string& elements, const Diagram& diagram, const BlockLibrary& library,
                       const std::vector<ParameterOverride>& overrides) {
  FlatDiagram flat;
  flat.file = diagram.file;
  text::Diagnostics diagnostics;
  wiring::Resolver resolver(library, diagnostics);
  const Scope scope = resolver.diagram(diagram);
  const wiring::Replacements replacements = wiring::resolve_overrides(scope, overrides, diagnostics);
  wiring::MachineDefaults machine(elements);
  const Layout layout(scope, machine, replacements, flat, diagnostics);
  choose_outputs(diagram, scope, layout, flat, diagnostics);
  for (const auto& [path, tolerance] : diagram.run.tolerances) {
    bool found = false;
    for (FlatBlock& block : flat.blocks) {
      if (block.path != path && !block.path.starts_with(path + ".")) continue;
      block.tolerance = tolerance;
      found = true;
    }
    if (found) continue;
    std::vector<std::string> blocks;
    for (const BlockInstance& block : diagram.blocks) blocks.push_back(block.name);
    diagnostics.add({{diagram.file, {}},
                     fmt::format("tolerances of [run]: there is no block '{}'", path),
                     {},
                     text::suggest(path, blocks)});
  }
  lay_out_timeline(
      diagram, flat,
      [&](const std::string& path, const text::Place& place,
          const std::string& subject) -> std::optional<SignalRef> {
        const auto source = wiring::find_signal(scope, path, place.position, subject, diagnostics);
        return source ? layout.signal(*source) : std::nullopt;
      },
      diagnostics);
  std::vector<std::string> names;
  for (const FlatOutput& output : flat.outputs) names.push_back(output.name);
  if (std::find(names.begin(), names.end(), "t") != names.end()) {
    const auto is_t = [](const auto& named) { return named.name == "t"; };
    const auto output = std::find_if(diagram.outputs.begin(), diagram.outputs.end(), is_t);
    const auto block = std::find_if(diagram.blocks.begin(), diagram.blocks.end(), is_t);
    const bool is_listed = output != diagram.outputs.end();
    diagnostics.add({is_listed                       ? output->place
                     : block != diagram.blocks.end() ? block->place
                                                     : text::Place{diagram.file, {}},
                     "an output is called 't', which is the column of time", "another name",
                     is_listed ? "" : "name it in [outputs]"});
  }
  if (diagnostics.empty()) check_expected_outputs(diagram, names, diagnostics);
  check_settings(diagram, scope, diagnostics);
  diagnostics.throw_if_any<DiagramError>();
  return flat;
}

}  // namespace

FlatDiagram flatten(const Diagram& diagram, const BlockLibrary& library,
                    const std::vector<ParameterOverride>& overrides) {
  return flatten_on(diagram.machine.profile, diagram, library, overrides);
}

FlatDiagram flatten_on_ideal_elements(const Diagram& diagram, const BlockLibrary& library,
                                      const std::vector<ParameterOverride>& overrides) {
  return flatten_on("ideal", diagram, library, overrides);
}

}  // namespace oblique::diagram
