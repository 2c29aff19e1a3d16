// SPDX-License-Identifier: MIT
#include <oblique/machine/element_writer.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/published.h>
#include <oblique/machine/carried_signals.h>
#include <oblique/machine/input_weight.h>
#include <oblique/machine/mode_control.h>
#include <oblique/text/expression_printer.h>
#include <oblique/text/nearest_decimal.h>

namespace oblique::machine {

std::vector<double> gains_of_one(const diagram::MachineProfile& machine) {
  return has_signed_weights(machine) ? machine.input_gains : std::vector<double>{1};
}

double most_weight_of_one(const diagram::MachineProfile& machine) {
  const std::vector<double> gains = gains_of_one(machine);
  return gains.empty() ? std::numeric_limits<double>::infinity() : gains.back();
}

namespace {

/// Parameters that change their sign with the signal: voltages at the output or at the summing junction.
bool turns_with_the_signal(std::string_view parameter) {
  return parameter == "initial" || parameter == "offset" || parameter == "drift";
}

class Writer {
 public:
  Writer(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
         const diagram::BlockLibrary& library, const diagram::MachineProfile& machine, const Circuit& circuit)
      : diagram_(diagram),
        flat_(flat),
        library_(library),
        machine_(machine),
        circuit_(circuit),
        signed_(has_signed_weights(machine)),
        gains_of_one_(gains_of_one(machine)),
        signals_(circuit, machine) {}

  Realisation write() {
    result_.run = diagram_.run;
    result_.run.tolerances.clear();
    for (std::size_t e = 0; e < circuit_.elements.size(); ++e) write_element(e);
    for (std::size_t k = 0; k < flat_.outputs.size(); ++k) write_output(k);
    write_modes();
    write_references();
    number();
    describe();
    Realisation realisation{std::move(result_), signals_.inverter_count(), {}};
    for (std::size_t e = 0; e < circuit_.elements.size(); ++e)
      realisation.elements.push_back(signals_.name(e));
    return realisation;
  }

 private:
  using Terms = std::vector<diagram::WeightedSignal>;

  void write_element(std::size_t e) {
    const CircuitElement& element = circuit_.elements[e];
    const std::size_t first = result_.blocks.size();
    std::vector<text::Entry> settings;
    double rate = 1;
    bool starts_by_wire = false;
    Terms factors;  // of a multiplier
    for (std::size_t port = 0; port < element.inputs.size(); ++port) {
      const diagram::InputPort& input = element.definition->inputs[port];
      double factor = signals_.input_factor(e, port);
      if (element.role == Role::integrator && input.sum) {
        rate = rate_for(element.inputs[port], std::abs(factor));
        factor /= rate;
      }
      Terms terms = terms_of(element.inputs[port], factor,
                             input.sum ? std::span<const double>(machine_.input_gains) : gains_of_one_);
      if (element.role == Role::integrator && input.name == "start" && terms.empty())
        starts_by_wire = connect_start(e, terms);
      if (terms.empty() && !input.default_value && !may_stay_open(element, input))
        terms = {{0, signals_.source(std::nullopt, false)}};
      if (element.role == Role::multiplier) {
        factors.push_back(terms.front());
      } else if (!terms.empty()) {
        settings.push_back(diagram::wire_setting(input.name, terms));
      }
    }
    if (element.role == Role::multiplier) settings.push_back(diagram::wire_setting("in", factors));
    if (rate != 1) settings.push_back(diagram::number_setting("rate", rate));
    if (element.block != nullptr) {
      add_parameters(e, starts_by_wire, settings);
      if (element.block->tolerance > 0)
        result_.run.tolerances.emplace_back(signals_.name(e), element.block->tolerance);
    }
    add_block(signals_.name(e), *element.definition, std::move(settings));
    for (const auto& [inverter, inverted] : signals_.inverters(e))
      add_block(inverter, Role::inverter, {diagram::wire_setting("in", {{1, inverted}})});
    result_.blocks[first].comment = comment_of(element.path);
  }

  /// Whether another input is fed that lets this one stay open: a store is an integrator that is fed with
  /// nothing but its initial value.
  static bool may_stay_open(const CircuitElement& element, const diagram::InputPort& input) {
    return std::any_of(input.open_with.begin(), input.open_with.end(), [&](const std::string& other) {
      const auto port = element.definition->find_input(other);
      return port && !element.inputs[*port].terms.empty();
    });
  }

  void add_block(std::string name, Role role, std::vector<text::Entry> settings) {
    add_block(std::move(name), element_block(library_, role), std::move(settings));
  }

  void add_block(std::string name, const diagram::BlockDefinition& definition,
                 std::vector<text::Entry> settings) {
    diagram::BlockInstance block;
    block.name = std::move(name);
    block.type = definition.name;
    block.settings = std::move(settings);
    result_.blocks.push_back(std::move(block));
  }

  /// The time factor k0 of an integrator that has `own` in the diagram.
  double rate_for(const CircuitInput& input, double own) const {
    double largest = 0;
    for (const CircuitTerm& term : input.terms) largest = std::max(largest, own * std::abs(term.weight));
    return largest == 0 ? 1 : choose_rate(largest, own, machine_.rates, machine_.input_gains);
  }

  Terms terms_of(const CircuitInput& input, double factor, std::span<const double> gains) {
    Terms terms;
    for (const CircuitTerm& term : input.terms) connect(terms, factor * term.weight, term.signal, gains);
    return terms;
  }

  /// Adds weight · signal to an input, through a potentiometer where the weight is no gain of the machine.
  void connect(Terms& terms, double weight, const std::optional<diagram::SignalRef>& signal,
               std::span<const double> gains) {
    constexpr int kWeightDigits = 15;  // 0.1*3 is 0.3
    weight = text::nearest_decimal(weight, kWeightDigits);
    const bool negative = weight < 0;
    const InputWeight split = split_weight(std::abs(weight), gains);
    std::string from = signals_.source(signal, negative && !signed_);
    if (split.setting != 1) from = potentiometer(from, split.setting);
    const double gain = negative && signed_ ? -split.gain : split.gain;
    terms.insert(terms.end(), static_cast<std::size_t>(split.inputs), diagram::WeightedSignal{gain, from});
  }

  const std::string& potentiometer(const std::string& from, double setting) {
    // Settings that differ by less are the same position of the wiper.
    constexpr int kSettingDigits = 14;  // 1.962/10 comes out as 0.1962
    std::string& name = potentiometers_[{from, fmt::format("{:.12g}", setting)}];
    if (name.empty()) {
      name = signals_.free_name(fmt::format("pot_{}", potentiometers_.size()));
      add_block(name, Role::potentiometer,
                {diagram::wire_setting("in", {{1, from}}),
                 diagram::number_setting("setting", text::nearest_decimal(setting, kSettingDigits))});
    }
    return name;
  }

  /// An initial value comes from the reference through a potentiometer, unless coefficients have signs.
  bool connect_start(std::size_t e, Terms& terms) {
    const double initial = parameter_of(*circuit_.elements[e].block, "initial");
    constexpr double kRounding = 1e-12;
    if (signed_ || initial == 0 || std::abs(initial) > 1 + kRounding) return false;
    connect(terms, signals_.is_negative(e) ? -initial : initial, std::nullopt, gains_of_one_);
    return true;
  }

  void add_parameters(std::size_t e, bool starts_by_wire, std::vector<text::Entry>& settings) const {
    const CircuitElement& element = circuit_.elements[e];
    const diagram::FlatBlock& block = *element.block;
    for (std::size_t k = 0; k < block.definition->parameters.size(); ++k) {
      const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
      // What a squarer has and a multiplier does not is at its default (`reduce`), and makes no difference.
      const auto written = element.definition->find_parameter(parameter.name);
      if (!written) continue;
      if (parameter.points) {
        if (block.points[k] != *parameter.points)
          settings.push_back(diagram::points_setting(parameter.name, block.points[k]));
        continue;
      }
      if (parameter.formula) {
        settings.push_back(
            diagram::text_setting(parameter.name, text::to_string(block.formulas.at(parameter.name))));
        continue;
      }
      if (element.role == Role::integrator && parameter.name == "rate") continue;
      if (parameter.name == "noise_bandwidth" && is_quiet(block)) continue;  // the scale of time has moved it
      if (starts_by_wire && parameter.name == "initial") continue;
      const bool loop =
          element.role == Role::open_amplifier && (parameter.name == "gain" || parameter.name == "bandwidth");
      if (loop && parameter.name == "gain" && machine_states_gain(*block.definition)) continue;
      const bool turns =
          !stays_as_it_is(element.role) && signals_.is_negative(e) && turns_with_the_signal(parameter.name);
      double value = turns ? -block.parameters[k] : block.parameters[k];
      // From where an amplifier goes to rest: no farther than it goes at all.
      if (element.role == Role::open_amplifier && parameter.name == "initial")
        value = std::clamp(value, -1.0, 1.0);
      if (loop || value != element.definition->parameters[*written].default_value)
        settings.push_back(diagram::number_setting(parameter.name, value));
    }
  }

  static bool is_quiet(const diagram::FlatBlock& block) {
    const auto noise = block.definition->find_parameter("noise");
    return noise && block.parameters[*noise] == 0;
  }

  bool machine_states_gain(const diagram::BlockDefinition& amplifier) const {
    return std::any_of(machine_.errors.begin(), machine_.errors.end(),
                       [&](const diagram::BlockFigure& figure) {
                         return figure.parameter == "gain" && figure.acts_on(amplifier).has_value();
                       });
  }

  /// The comment of the block of the diagram that an element is a part of, above its first element.
  std::string comment_of(const std::string& path) {
    const std::string name = path.substr(0, path.find('.'));
    if (!commented_.insert(name).second) return {};
    const auto block = std::find_if(diagram_.blocks.begin(), diagram_.blocks.end(),
                                    [&](const diagram::BlockInstance& b) { return b.name == name; });
    return block == diagram_.blocks.end() ? std::string() : block->comment;
  }

  /// A meter reads either sign: an output takes no inverter.
  void write_output(std::size_t k) {
    const diagram::FlatOutput& output = flat_.outputs[k];
    const CircuitTerm& term = circuit_.outputs[k];
    const bool negative = term.signal && signals_.is_negative(*term.signal);
    const double scale = (negative ? -output.scale : output.scale) * term.weight;
    result_.outputs.push_back(
        {output.name, signals_.source(term.signal, negative), scale, output.unit, {}, output.offset});
  }

  void write_modes() {
    const diagram::FlatTimeline& timeline = flat_.timeline;
    if (timeline.groups.empty()) return;
    std::vector<std::vector<std::string>> members(timeline.groups.size());
    for (std::size_t e = 0; e < circuit_.elements.size(); ++e) {
      const CircuitElement& element = circuit_.elements[e];
      if (element.role == Role::integrator) members[element.block->group].push_back(signals_.name(e));
    }
    std::vector<ModeSource> sources;
    for (const CircuitTerm& term : circuit_.mode_sources) {
      const bool negative = term.signal && signals_.is_negative(*term.signal);
      sources.push_back({signals_.source(term.signal, negative), negative ? -term.weight : term.weight});
    }
    machine::write_modes(timeline, members, sources, result_);
  }

  void write_references() {
    std::vector<diagram::BlockInstance> elements = std::exchange(result_.blocks, {});
    const auto& [plus, minus] = signals_.references();
    if (!plus.empty()) add_block(plus, Role::reference, {diagram::number_setting("value", 1)});
    if (!minus.empty()) add_block(minus, Role::reference, {diagram::number_setting("value", -1)});
    if (!result_.blocks.empty()) result_.blocks.front().comment = "the reference: 1 machine unit";
    std::move(elements.begin(), elements.end(), std::back_inserter(result_.blocks));
  }

  void number() {
    ElementNumbers numbers;
    for (diagram::BlockInstance& block : result_.blocks)
      block.label = numbers.next(library_.find(block.type)->role);
  }

  void describe() {
    result_.file = diagram_.file;
    result_.title =
        diagram_.title + (diagram_.title.empty() ? "" : ", ") + "in the elements of " + machine_.title;
    result_.source = diagram_.source;
    result_.comment = diagram_.comment + (diagram_.comment.empty() ? "" : "\n") + "In the elements of " +
                      machine_.title + (signed_ ? "." : "; minus_… carries the negative of a signal.");
    result_.machine = {machine_.name, machine_.inverting};
    result_.expectations = diagram_.expectations;
    result_.published = diagram::without_settings(diagram_.published);
  }

  const diagram::Diagram& diagram_;
  const diagram::FlatDiagram& flat_;
  const diagram::BlockLibrary& library_;
  const diagram::MachineProfile& machine_;
  const Circuit& circuit_;
  bool signed_;
  std::vector<double> gains_of_one_;
  CarriedSignals signals_;
  std::map<std::pair<std::string, std::string>, std::string> potentiometers_;  ///< by source and setting
  std::set<std::string> commented_;
  diagram::Diagram result_;
};

}  // namespace

Realisation write_elements(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                           const diagram::BlockLibrary& library, const diagram::MachineProfile& machine,
                           const Circuit& circuit) {
  return Writer(diagram, flat, library, machine, circuit).write();
}

}  // namespace oblique::machine
