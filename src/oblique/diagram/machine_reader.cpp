// SPDX-License-Identifier: MIT
#include <oblique/diagram/machine_reader.h>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/diagram.h>
#include <oblique/text/table_reader.h>

namespace oblique::diagram {
namespace {

constexpr std::string_view kUnknown = "unknown";

bool is_text(const text::Value& value, std::string_view text) {
  return value.kind == text::Value::Kind::string && value.text == text;
}

class MachineReader {
 public:
  MachineReader(const text::Document& document, const BlockLibrary& library, MachineProfile& machine)
      : file_(document.file),
        library_(library),
        reader_(file_, document.root, "the machine file", diagnostics_),
        machine_(machine) {}

  void read() {
    if (!text::check_format(reader_, "oblique-machine/1")) diagnostics_.throw_if_any<DiagramError>();
    machine_.title = reader_.required_string("title", "what people call the machine").value_or("");
    machine_.source = reader_.required_string("source", "where its figures are from").value_or("");
    machine_.comment = reader_.string("comment").value_or("");
    read_unit();
    machine_.inverting = reader_.boolean("inverting").value_or(true);
    machine_.inverting_summers = reader_.boolean("inverting_summers").value_or(true);
    machine_.signed_coefficients = reader_.boolean("signed_coefficients").value_or(false);
    machine_.input_gains_known = read_steps("input_gains", "1", machine_.input_gains);
    machine_.rates_known = read_steps("rates", "1/s", machine_.rates);
    if (const text::Value* const table = reader_.table("elements")) {
      for (const text::Entry& entry : table->entries) read_element(entry);
    } else if (reader_.table().find("elements") == nullptr) {
      reader_.report("elements", "the machine has no [elements]", "at least one kind of element");
    }
    if (const text::Value* const table = reader_.table("figures")) {
      for (const text::Entry& entry : table->entries) read_figure(entry);
    }
    reader_.finish();
    diagnostics_.throw_if_any<DiagramError>();
  }

 private:
  void report(text::SourcePosition position, std::string what, std::string expected = {},
              std::string remedy = {}) {
    diagnostics_.add({{file_, position}, std::move(what), std::move(expected), std::move(remedy)});
  }

  void read_unit() {
    const text::Value* const value = reader_.find("unit");
    if (value == nullptr) {
      reader_.report("unit", "the machine file has no 'unit'", R"(a voltage such as "10 V", or "unknown")");
    } else if (!is_text(*value, kUnknown)) {
      machine_.unit = reader_.quantity("unit", "V");
      if (machine_.unit && !(*machine_.unit > 0 && std::isfinite(*machine_.unit)))
        reader_.report("unit", fmt::format("'unit' is {} V", *machine_.unit), "a finite voltage above 0");
    }
  }

  /// Reads "any", "unknown" or the values there are; false where they are unknown.
  bool read_steps(std::string_view key, std::string_view unit, std::vector<double>& steps) {
    const text::Value* const value = reader_.find(key);
    const std::string expected =
        R"(a list of numbers above 0, each above the one before; "any" or "unknown")";
    if (value == nullptr) {
      reader_.report(key, fmt::format("the machine file has no '{}'", key), expected);
      return false;
    }
    if (is_text(*value, kUnknown)) return false;
    if (is_text(*value, "any")) return true;
    if (value->kind != text::Value::Kind::array || value->elements.empty()) {
      reader_.report(key,
                     fmt::format("'{}' is {}", key,
                                 value->kind == text::Value::Kind::array ? "an empty list"
                                                                         : text::kind_name(value->kind)),
                     expected);
      return true;
    }
    steps.reserve(value->elements.size());
    for (const text::Value& element : value->elements) {
      const auto step = text::read_quantity(file_, element, unit, fmt::format("'{}'", key), diagnostics_);
      if (!step) continue;
      if (!(*step > (steps.empty() ? 0 : steps.back()) && std::isfinite(*step)))
        report(element.position, fmt::format("'{}' holds {} here", key, *step), expected);
      steps.push_back(*step);
    }
    return true;
  }

  void read_element(const text::Entry& entry) {
    const auto kind = read_element_kind(entry.key, {file_, entry.position}, diagnostics_);
    if (!kind) return;
    ElementCount element;
    element.kind = *kind;
    const std::string subject = fmt::format("element '{}'", entry.key);
    if (entry.value.kind == text::Value::Kind::table) {
      text::TableReader reader(file_, entry.value, subject, diagnostics_);
      if (const text::Value* const count = reader.find("count")) {
        element.count = read_count(*count, subject);
      } else {
        reader.report("count", subject + " has no 'count'", "a whole number, inf or \"unknown\"");
      }
      element.note = reader.string("note").value_or("");
      reader.finish();
    } else {
      element.count = read_count(entry.value, subject);
    }
    machine_.elements.push_back(std::move(element));
  }

  std::optional<double> read_count(const text::Value& value, const std::string& subject) {
    if (is_text(value, kUnknown)) return std::nullopt;
    const auto count = text::read_quantity(file_, value, "1", subject, diagnostics_);
    if (count && !(*count >= 1 && *count == std::floor(*count))) {
      report(value.position, fmt::format("{}: the count is {}", subject, *count),
             "a whole number from 1, inf or \"unknown\"", "leave out what the machine has none of");
    }
    return count;
  }

  void read_figure(const text::Entry& entry) {
    MachineFigure figure;
    figure.name = entry.key;
    if (entry.value.kind == text::Value::Kind::string) {
      figure.value = entry.value.text;
    } else {
      text::TableReader reader(file_, entry.value, fmt::format("figure '{}'", entry.key), diagnostics_);
      figure.value = reader.required_string("value", "what is published, or \"unknown\"").value_or("");
      figure.source = reader.string("source").value_or("");
      const text::Value* const errors = reader.table("errors");
      const text::Value* const scatters = reader.table("scatters");
      if (errors != nullptr) read_actions(*errors, figure, machine_.errors, false);
      if (scatters != nullptr) read_actions(*scatters, figure, machine_.scatters, true);
      read_saturation(reader, figure);
      if (figure.value == kUnknown &&
          (errors != nullptr || scatters != nullptr || reader.find("saturation") != nullptr))
        report(entry.position, fmt::format("figure '{}' is unknown and yet acts on blocks", entry.key),
               "a figure that acts has a value");
      reader.finish();
    }
    if (figure.source.empty() && figure.value != kUnknown) figure.source = machine_.source;
    machine_.figures.push_back(std::move(figure));
  }

  /// What all amplifiers saturate at; one figure of a machine says it.
  void read_saturation(text::TableReader& reader, const MachineFigure& figure) {
    const text::Value* const value = reader.find("saturation");
    if (value == nullptr) return;
    const std::string subject = fmt::format("figure '{}': 'saturation'", figure.name);
    const auto number = read_value(*value, "machine unit", subject);
    if (!number) return;
    if (machine_.saturation) {
      report(value->position, subject + " is given a second time", "one figure that says it");
    } else if (!(*number >= 1 && std::isfinite(*number))) {
      report(value->position, fmt::format("{} is {}", subject, *number), "at least 1 [machine unit]");
    }
    machine_.saturation = number;
  }

  /// `{ summer.offset = "20 µV", … }`: what a figure is for parameters of blocks.
  void read_actions(const text::Value& table, const MachineFigure& figure, std::vector<BlockFigure>& actions,
                    bool scatter) {
    for (const text::Entry& block : table.entries) {
      const BlockDefinition* const definition = find_block(block, figure);
      if (definition == nullptr) continue;
      for (const text::Entry& entry : block.value.entries) {
        const ParameterDefinition* const parameter = find_parameter(*definition, entry, figure);
        if (parameter == nullptr) continue;
        const std::string subject = fmt::format("figure '{}': '{}.{}'", figure.name, block.key, entry.key);
        const auto value = read_value(entry.value, parameter->unit, subject);
        if (!value) continue;
        check_value(*parameter, *value, entry, subject, scatter);
        const bool twice = std::any_of(actions.begin(), actions.end(), [&](const BlockFigure& other) {
          return other.block == block.key && other.parameter == entry.key;
        });
        if (twice) report(entry.position, subject + " has a value already", "one figure a parameter");
        actions.push_back({block.key, entry.key, *value, figure.name, definition->role});
      }
    }
  }

  const BlockDefinition* find_block(const text::Entry& entry, const MachineFigure& figure) {
    const BlockDefinition* const definition = library_.find(entry.key);
    if (definition == nullptr) {
      report(entry.position, fmt::format("figure '{}': there is no block '{}'", figure.name, entry.key), {},
             text::suggest(entry.key, library_.names()));
      return nullptr;
    }
    if (definition->is_composite()) {
      report(entry.position,
             fmt::format("figure '{}': '{}' is a composite, which no figure reaches", figure.name, entry.key),
             "one of the blocks it is made of");
      return nullptr;
    }
    if (entry.value.kind != text::Value::Kind::table) {
      report(
          entry.value.position,
          fmt::format("figure '{}': '{}' is {}", figure.name, entry.key, text::kind_name(entry.value.kind)),
          "BLOCK.PARAMETER = VALUE");
      return nullptr;
    }
    return definition;
  }

  const ParameterDefinition* find_parameter(const BlockDefinition& block, const text::Entry& entry,
                                            const MachineFigure& figure) {
    const auto index = block.find_parameter(entry.key);
    if (index && !block.parameters[*index].points) return &block.parameters[*index];
    std::vector<std::string> names;
    for (const ParameterDefinition& p : block.parameters) {
      if (!p.points) names.push_back(p.name);
    }
    report(entry.position,
           fmt::format("figure '{}': block '{}' has no number '{}'", figure.name, block.name, entry.key), {},
           text::suggest(entry.key, names));
    return nullptr;
  }

  /// A quantity in the parameter's unit; where that is of a signal, it may be in volts.
  std::optional<double> read_value(const text::Value& value, const std::string& unit,
                                   const std::string& subject) {
    constexpr std::string_view kSignal = "machine unit";
    const std::size_t signal = unit.find(kSignal);
    if (signal != std::string::npos && value.kind == text::Value::Kind::string) {
      const std::string volts = "V" + unit.substr(signal + kSignal.size());
      text::Diagnostics not_volts;
      const auto number = text::read_quantity(file_, value, volts, subject, not_volts);
      text::Diagnostics not_units;
      const auto plain = text::read_quantity(file_, value, unit, subject, not_units);
      if (number && !plain) {
        if (machine_.unit) return *number / *machine_.unit;
        report(value.position, subject + " is in volts, and the machine unit is unknown",
               fmt::format("a quantity in '{}'", unit));
        return std::nullopt;
      }
    }
    return text::read_quantity(file_, value, unit, subject, diagnostics_);
  }

  void check_value(const ParameterDefinition& parameter, double value, const text::Entry& entry,
                   const std::string& subject, bool scatter) {
    const double middle = parameter.default_value;
    const bool fits = scatter
                          ? value > 0 && parameter.allows(middle - value) && parameter.allows(middle + value)
                          : parameter.allows(value);
    if (fits) return;
    report(entry.value.position, fmt::format("{} is {}", subject, value),
           scatter ? fmt::format("a half width above 0 that keeps {} ± it {}", middle, parameter.range())
                   : parameter.range());
  }

  std::string file_;
  const BlockLibrary& library_;
  text::Diagnostics diagnostics_;
  text::TableReader reader_;
  MachineProfile& machine_;
};

}  // namespace

MachineProfile parse_machine(std::string_view text, std::string file, std::string name,
                             const BlockLibrary& library) {
  MachineProfile machine;
  machine.name = std::move(name);
  MachineReader(text::parse_document(text, std::move(file)), library, machine).read();
  return machine;
}

}  // namespace oblique::diagram
