// SPDX-License-Identifier: MIT
#include <oblique/diagram/rescale.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

#include <fmt/format.h>

#include <oblique/diagram/machine_defaults.h>
#include <oblique/diagram/names.h>
#include <oblique/diagram/propose_scaling.h>
#include <oblique/diagram/published.h>
#include <oblique/text/expression_printer.h>
#include <oblique/text/nearest_decimal.h>

namespace oblique::diagram {
namespace {

/// Value of an equation for given values of its names other than parameters.
double value_of(const BlockDefinition& definition, const std::vector<double>& parameters,
                const text::Expression& expression, const text::NameLookup& signals) {
  return text::evaluate(expression, [&](std::string_view name) -> std::optional<double> {
    if (const auto p = definition.find_parameter(name)) return parameters[*p];
    return signals(name);
  });
}

bool names_polarity(const text::Expression& expression) {
  const auto names = names_in(expression);
  return std::any_of(names.begin(), names.end(),
                     [](const text::Expression* e) { return e->name == "polarity"; });
}

/// Whether a block of one polarity with inverted inputs is the same block with the other polarity. Its
/// equations are tried at odd numbers.
bool inputs_replace_polarity(const FlatBlock& block) {
  for (const Equation& equation : block.behaviour->equations) {
    for (int trial = 1; trial <= 5; ++trial) {
      const auto with = [&](double polarity, double sign) {
        return value_of(*block.definition, block.parameters, equation.expression,
                        [&](std::string_view name) -> std::optional<double> {
                          if (name == "polarity") return polarity;
                          const auto input = block.definition->find_input(name);
                          const double odd = std::sin(static_cast<double>(7 * trial) +
                                                      3.0 * static_cast<double>(name.size()) +
                                                      static_cast<double>(input.value_or(11)));
                          return input ? sign * odd : odd;
                        });
      };
      const double one = with(1, 1), other = with(-1, -1);
      if (!(std::abs(one - other) <= 1e-12 * std::abs(one))) return false;
    }
  }
  return true;
}

class Writer {
 public:
  Writer(const Diagram& diagram, const FlatDiagram& flat, const AmplitudeScaling& scaling,
         const BlockLibrary& library)
      : diagram_(diagram),
        flat_(flat),
        scaling_(scaling),
        library_(library),
        machine_(diagram.machine.profile),
        polarity_(diagram.machine.inverting ? -1 : 1) {
    for (const BlockInstance& block : diagram.blocks) labels_.emplace(block.name, block.label);
    for (const FlatBlock& block : flat.blocks) names_.push_back(free_name(block.path));
  }

  Diagram write() {
    Diagram scaled;
    scaled.file = diagram_.file;
    scaled.title = diagram_.title;
    scaled.source = diagram_.source;
    scaled.machine = diagram_.machine;
    scaled.run = diagram_.run;
    scaled.expectations = diagram_.expectations;
    scaled.published = without_settings(diagram_.published);
    for (std::size_t b = 0; b < flat_.blocks.size(); ++b) {
      BlockInstance block = block_of(b);
      scaled.blocks.insert(scaled.blocks.end(), helpers_.begin(), helpers_.end());
      helpers_.clear();
      scaled.blocks.push_back(std::move(block));
    }
    for (const FlatOutput& output : flat_.outputs) {
      scaled.outputs.push_back({output.name,
                                signal_name(output.signal),
                                output.scale / factor_of(output.signal),
                                output.unit,
                                {}});
    }
    scaled.layout = layout();
    diagnostics_.throw_if_any<DiagramError>();
    return scaled;
  }

 private:
  /// The places of the blocks; none where a composite had one, since its parts have none in its stead.
  std::vector<BlockPlace> layout() const {
    std::vector<BlockPlace> places;
    for (BlockPlace place : diagram_.layout) {
      const auto block = std::find_if(flat_.blocks.begin(), flat_.blocks.end(),
                                      [&](const FlatBlock& b) { return b.path == place.name; });
      if (block == flat_.blocks.end()) return {};
      place.name = names_[static_cast<std::size_t>(block - flat_.blocks.begin())];
      places.push_back(std::move(place));
    }
    return places;
  }

  std::string free_name(std::string path) {
    std::replace(path.begin(), path.end(), '.', '_');
    std::string name = path;
    for (int k = 2; !taken_.insert(name).second; ++k) name = fmt::format("{}_{}", path, k);
    return name;
  }

  std::string signal_name(SignalRef signal) const {
    const auto& outputs = flat_.blocks[signal.block].definition->outputs;
    if (outputs.size() == 1) return names_[signal.block];
    return names_[signal.block] + "." + outputs[signal.output].name;
  }

  double factor_of(SignalRef signal) const { return scaling_[signal.block].outputs[signal.output]; }

  BlockInstance block_of(std::size_t b) {
    const FlatBlock& block = flat_.blocks[b];
    const BlockDefinition& definition = *block.definition;
    BlockInstance instance;
    instance.name = names_[b];
    instance.type = definition.name;
    if (const auto found = labels_.find(block.path); found != labels_.end()) instance.label = found->second;
    const double sign = input_sign(block);
    for (std::size_t i = 0; i < definition.inputs.size(); ++i) {
      add_input(instance, definition.inputs[i], block.inputs[i], sign * scaling_[b].inputs[i]);
    }
    for (const auto& [name, formula] : block.formulas)
      instance.settings.push_back(text_setting(name, text::to_string(formula)));
    for (std::size_t k = 0; k < definition.parameters.size(); ++k) {
      if (definition.parameters[k].points) {
        instance.settings.push_back(points_setting(definition.parameters[k].name, block.points[k]));
        continue;
      }
      if (block.saturation == k) continue;  // it stays the machine's
      set(instance, definition, k, scaled_number(block.parameters[k], scaling_[b].parameters[k], 1));
    }
    return instance;
  }

  /// Writes a parameter, unless it would have that value left open.
  void set(BlockInstance& instance, const BlockDefinition& definition, std::size_t k, double value) {
    const ParameterDefinition& parameter = definition.parameters[k];
    if (value != machine_.of(definition)[k].value_or(parameter.default_value))
      instance.settings.push_back(number_setting(parameter.name, value));
  }

  /// −1 where the block comes from a composite of another convention than the file's.
  double input_sign(const FlatBlock& block) {
    const auto& equations = block.behaviour->equations;
    const bool asks = std::any_of(equations.begin(), equations.end(),
                                  [](const Equation& e) { return names_polarity(e.expression); });
    if (!asks || block.polarity == polarity_) return 1;
    if (!inputs_replace_polarity(block)) {
      diagnostics_.add(
          {block.place,
           fmt::format("'{}' cannot stand outside its composite: whether it inverts is a matter of "
                       "the composite, and inverted inputs do not make up for it",
                       block.path),
           {},
           "scale the diagram by hand"});
    }
    return -1;
  }

  void add_input(BlockInstance& instance, const InputPort& port, const FlatInput& input, double factor) {
    std::vector<WeightedSignal> terms;
    for (const FlatTerm& term : input.terms) {
      terms.push_back({scaled_number(term.weight, factor, factor_of(term.signal)), signal_name(term.signal)});
    }
    if (terms.empty() && port.default_value == input.constant * factor)
      return;  // left open, it stays as it is
    if (input.constant != 0 || terms.empty()) terms.push_back({input.constant * factor, reference()});
    if (terms.size() > 1 && !port.sum) terms = {{1, sum_of(instance.name + "_" + port.name, terms)}};
    instance.settings.push_back(wire_setting(port.name, terms));
  }

  /// A number as it is, or times a ratio, without the rounding of the ratio.
  static double scaled_number(double number, double by, double over) {
    if (by == over) return number;
    return text::nearest_decimal(number * by / over, 14);
  }

  /// A block of 1 machine unit, made when it is first asked for.
  const std::string& reference() {
    if (!reference_.empty()) return reference_;
    for (const std::string& name : library_.names()) {
      const BlockDefinition& d = *library_.find(name);
      if (!d.inputs.empty() || d.outputs.size() != 1 || d.behaviours.size() != 1) continue;
      const auto& equations = d.behaviours[0].equations;
      if (equations.size() != 1 || equations[0].kind != Equation::Kind::assignment) continue;
      if (equations[0].expression.kind != text::Expression::Kind::name) continue;
      const auto parameter = d.find_parameter(equations[0].expression.name);
      if (!parameter || !d.parameters[*parameter].allows(1)) continue;
      BlockInstance one;
      one.name = reference_ = free_name("reference");
      one.type = name;
      set(one, d, *parameter, 1);
      helpers_.push_back(std::move(one));
      return reference_;
    }
    lacks("gives a constant");
    return reference_;
  }

  /// A block that adds what a port of one signal cannot take.
  std::string sum_of(const std::string& wish, std::vector<WeightedSignal> terms) {
    for (const std::string& name : library_.names()) {
      const BlockDefinition& d = *library_.find(name);
      if (d.is_composite() || d.inputs.size() != 1 || !d.inputs[0].sum || d.outputs.size() != 1) continue;
      std::vector<double> defaults;
      for (const ParameterDefinition& parameter : d.parameters) defaults.push_back(parameter.default_value);
      const auto& equations = d.choose_behaviour(defaults, polarity_)->equations;
      if (equations.size() != 1 || equations[0].kind != Equation::Kind::assignment) continue;
      const auto at = [&](double in) {
        return text::evaluate(equations[0].expression, [&](std::string_view symbol) -> std::optional<double> {
          if (symbol == "polarity") return polarity_;
          if (const auto p = d.find_parameter(symbol)) return defaults[*p];
          return symbol == d.inputs[0].name ? std::optional(in) : std::nullopt;
        });
      };
      const double slope = at(1);
      if (std::abs(slope) != 1 || at(0) != 0 || at(0.5) != 0.5 * slope) continue;
      for (WeightedSignal& term : terms) term.weight *= slope;
      BlockInstance sum;
      sum.name = free_name(wish);
      sum.type = name;
      sum.settings.push_back(wire_setting(d.inputs[0].name, terms));
      for (std::size_t k = 0; k < defaults.size(); ++k) set(sum, d, k, defaults[k]);
      helpers_.push_back(sum);
      return sum.name;
    }
    lacks("adds its inputs");
    return wish;
  }

  void lacks(std::string_view what) {
    const text::Place place{diagram_.file, {}};
    diagnostics_.add({place,
                      fmt::format("the library has no block that {}, which the flat diagram needs", what),
                      {},
                      "scale the diagram by hand"});
  }

  const Diagram& diagram_;
  const FlatDiagram& flat_;
  const AmplitudeScaling& scaling_;
  const BlockLibrary& library_;
  wiring::MachineDefaults machine_;
  double polarity_;
  std::unordered_map<std::string, std::string> labels_;
  std::unordered_set<std::string> taken_;
  std::vector<std::string> names_;
  std::vector<BlockInstance> helpers_;  ///< to stand before the block that needs them
  std::string reference_;
  text::Diagnostics diagnostics_;
};

}  // namespace

Diagram rescale(const Diagram& diagram, const FlatDiagram& flat, const AmplitudeScaling& scaling,
                const BlockLibrary& library) {
  if (!diagram.groups.empty() || !diagram.timeline.phases.empty()) {
    throw DiagramError(text::Diagnostic{{diagram.file, {}},
                                        "a diagram with [groups] or a [timeline] cannot be rescaled",
                                        "one run in the mode \"operate\"",
                                        "scale it by hand: the report proposes the factors"});
  }
  return Writer(diagram, flat, scaling, library).write();
}

}  // namespace oblique::diagram
