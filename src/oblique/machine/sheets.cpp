// SPDX-License-Identifier: MIT
#include <oblique/machine/sheets.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/flatten.h>
#include <oblique/machine/operating_sheets.h>
#include <oblique/machine/role.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>

namespace oblique::machine {
namespace {

/// Inputs of one block that one signal goes to with one weight.
struct Connection {
  diagram::SignalRef from;
  std::size_t to = 0;    ///< block
  std::size_t port = 0;  ///< of it
  double weight = 1;
  int inputs = 1;
};

class SheetMaker {
 public:
  SheetMaker(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine)
      : diagram_(diagram),
        volts_(machine.unit.value_or(1)),
        unit_(machine.unit ? "V" : "machine unit"),
        numbers_(element_numbers(diagram)) {
    for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
      const diagram::FlatBlock& block = diagram.blocks[b];
      for (std::size_t port = 0; port < block.inputs.size(); ++port) {
        for (diagram::FlatTerm term : block.inputs[port].terms) {
          // In diagrams for the machine all summers invert.
          if (!machine.inverting_summers && block.definition->role == Role::summer)
            term.weight = -term.weight;
          connect(b, port, term);
        }
      }
    }
  }

  Sheet connections() const {
    Sheet sheet{"patch list", {"from", "signal", "to", "element", "input"}, {}};
    for (const Connection& c : connections_) {
      sheet.rows.push_back({numbers_[c.from.block], diagram_.signal_name(c.from), numbers_[c.to],
                            diagram_.blocks[c.to].path, input_text(c)});
    }
    return sheet;
  }

  Sheet potentiometers() const {
    Sheet sheet{"potentiometers", {"pot", "setting", "from", "to", "stands for"}, {}};
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      if (diagram_.blocks[b].definition->role != Role::potentiometer) continue;
      const double setting = parameter_of(diagram_.blocks[b], "setting");
      const Connection& source = *std::find_if(connections_.begin(), connections_.end(),
                                               [&](const Connection& c) { return c.to == b; });
      std::vector<std::string> to, meanings;
      for (const Connection& c : connections_) {
        if (c.from.block != b) continue;
        to.push_back(fmt::format("{} {}", numbers_[c.to], input_text(c)));
        const std::string meaning = meaning_of(c, setting, source.from);
        // a square takes the wiper twice
        if (std::find(meanings.begin(), meanings.end(), meaning) == meanings.end())
          meanings.push_back(meaning);
      }
      sheet.rows.push_back({numbers_[b], fmt::format("{:.4f}", setting), numbers_[source.from.block],
                            fmt::format("{}", fmt::join(to, ", ")),
                            fmt::format("{}", fmt::join(meanings, "; "))});
    }
    return sheet;
  }

  Sheet functions() const {
    Sheet sheet{"function generators",
                {"element", "signal", fmt::format("breakpoint [{}]", unit_),
                 fmt::format("output [{}]", unit_), "slope beyond", "slope added", "side"},
                {}};
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      const diagram::FlatBlock& block = diagram_.blocks[b];
      if (block.definition->role != Role::function_generator) continue;
      for (std::size_t k = 0; k < block.definition->parameters.size(); ++k) {
        if (block.definition->parameters[k].points) add_function(sheet, b, block.points[k]);
      }
    }
    return sheet;
  }

  Sheet static_test(const std::vector<solve::StaticReading>& readings) const {
    Sheet sheet{"static test",
                {"element", "signal", "kind", fmt::format("output [{}]", unit_),
                 fmt::format("derivative [{}/s]", unit_)},
                {}};
    std::unordered_map<std::string_view, const solve::StaticReading*> by_name;
    for (const solve::StaticReading& reading : readings) by_name.emplace(reading.signal, &reading);
    for (std::size_t b = 0; b < diagram_.blocks.size(); ++b) {
      const diagram::BlockDefinition& definition = *diagram_.blocks[b].definition;
      if (definition.role == Role::reference) continue;
      for (std::size_t k = 0; k < definition.outputs.size(); ++k) {
        const std::string signal = diagram_.signal_name({b, k});
        const solve::StaticReading& reading = *by_name.at(signal);
        const bool integrates = definition.role == Role::integrator && reading.derivative;
        sheet.rows.push_back({numbers_[b], signal, kind_text(diagram_.blocks[b]), voltage(reading.output),
                              integrates ? voltage(*reading.derivative) : ""});
      }
    }
    return sheet;
  }

 private:
  /// The line about 0, the breakpoints above it, and those below it, each outwards. One at 0 itself counts
  /// as below, which its side says.
  void add_function(Sheet& sheet, std::size_t block, const text::PointTable& points) const {
    const std::vector<double>&x = points.x, &y = points.y;
    const auto slope = [&](std::size_t line) { return (y[line + 1] - y[line]) / (x[line + 1] - x[line]); };
    const auto row = [&](double at, double value, const std::string& beyond, const std::string& added,
                         const char* side) {
      sheet.rows.push_back(
          {numbers_[block], diagram_.blocks[block].path, voltage(at), voltage(value), beyond, added, side});
    };
    const auto breakpoint = [&](std::size_t point, std::size_t before, std::size_t beyond) {
      const char* const side = beyond < before ? "below" : "above";
      // Two points of one x: what follows is a jump there.
      if (x[beyond] == x[beyond + 1]) return row(x[point], y[point], "jump", "", side);
      const bool jumps = x[before] == x[before + 1];
      row(x[point], y[point], rounded(slope(beyond)), jumps ? "" : rounded(slope(beyond) - slope(before)),
          side);
    };
    std::size_t middle = 0;
    while (middle + 2 < x.size() && !(x[middle + 1] > 0)) ++middle;
    row(0, y[middle] - slope(middle) * x[middle], rounded(slope(middle)), "", "");
    for (std::size_t point = middle + 1; point + 1 < x.size(); ++point) breakpoint(point, point - 1, point);
    for (std::size_t point = middle; point > 0; --point) breakpoint(point, point, point - 1);
  }

  /// Rounded, and never "-0.0000".
  static std::string rounded(double value) {
    constexpr double kDigits = 1e4;
    return fmt::format("{:.4f}", std::round(value * kDigits) / kDigits + 0.0);
  }

  void connect(std::size_t block, std::size_t port, const diagram::FlatTerm& term) {
    if (term.weight == 0) return;
    const auto same = std::find_if(connections_.begin(), connections_.end(), [&](const Connection& c) {
      return c.to == block && c.port == port && c.from == term.signal && c.weight == term.weight;
    });
    if (same != connections_.end()) {
      ++same->inputs;
    } else {
      connections_.push_back({term.signal, block, port, term.weight, 1});
    }
  }

  /// "summer", "integrator, k0 = 500 1/s, limited to ±8 V", "open amplifier, gain 1e+06, bandwidth 10 Hz",
  /// "comparator, 0 or 10 V, hysteresis 0.5 V", "counter, modulus 4, step 5 V": the kind, and what is set at
  /// the element itself.
  std::string kind_text(const diagram::FlatBlock& block) const {
    const std::string limit = own(block, "limit", ", limited to ±", volts_, unit_);
    switch (block.definition->role) {
      case Role::integrator:
        return fmt::format("integrator, k0 = {:.6g} 1/s", parameter_of(block, "rate")) +
               own(block, "initial", ", starts at ", volts_, unit_) + limit;
      case Role::open_amplifier:
        return "open amplifier" + own(block, "gain", ", gain ", 1, "") +
               own(block, "bandwidth", ", bandwidth ", 1, "Hz") + limit;
      case Role::comparator: {
        const auto low = block.definition->find_parameter("low"),
                   high = block.definition->find_parameter("high");
        if (!low || !high) return block.definition->name;
        return fmt::format("comparator, {:.4g} or {:.4g} {}", block.parameters[*low] * volts_,
                           block.parameters[*high] * volts_, unit_) +
               own(block, "hysteresis", ", hysteresis ", volts_, unit_);
      }
      case Role::other:
        return block.definition->name + settings_text(block);
      default:
        return block.definition->name + limit;
    }
  }

  /// ", length 0.4 s, low −4 V, high 10 V": all that is set at an element that is what the diagram has.
  std::string settings_text(const diagram::FlatBlock& block) const {
    std::string text;
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      const diagram::ParameterDefinition& parameter = block.definition->parameters[k];
      if (parameter.points || parameter.formula || block.saturation == k) continue;
      if (!std::isfinite(block.parameters[k])) continue;
      const bool voltage = parameter.unit == "machine unit";
      const std::string unit = voltage ? unit_ : parameter.unit == "1" ? "" : parameter.unit;
      text += fmt::format(", {} {:.6g}{}{}", parameter.name, block.parameters[k] * (voltage ? volts_ : 1),
                          unit.empty() ? "" : " ", unit);
    }
    return text;
  }

  /// A finite parameter that is not zero, and that is not the machine's saturation, behind some words.
  static std::string own(const diagram::FlatBlock& block, std::string_view parameter, const char* words,
                         double volts, const std::string& unit) {
    const auto k = block.definition->find_parameter(parameter);
    if (!k || block.saturation == k) return {};
    const double value = block.parameters[*k];
    if (value == 0 || !std::isfinite(value)) return {};
    return fmt::format("{}{:.4g}{}{}", words, value * volts, unit.empty() ? "" : " ", unit);
  }

  /// "×10", "3 inputs ×10", "x", "initial value": where a wire ends.
  std::string input_text(const Connection& c) const {
    const diagram::FlatBlock& block = diagram_.blocks[c.to];
    const diagram::InputPort& port = block.definition->inputs[c.port];
    if (block.definition->role == Role::integrator && port.name == "start") return "initial value";
    const std::string gain = fmt::format("{}×{:.6g}", c.weight < 0 ? "−" : "", std::abs(c.weight));
    if (!port.sum) return c.weight == 1 ? port.name : port.name + " " + gain;
    return c.inputs == 1 ? gain : fmt::format("{} inputs {}", c.inputs, gain);
  }

  /// "2.5 1/s of y in x", "−0.2 in a sum", "x starts at 0.6": what a potentiometer does at one input.
  std::string meaning_of(const Connection& c, double setting, diagram::SignalRef source) const {
    const diagram::FlatBlock& block = diagram_.blocks[c.to];
    const diagram::InputPort& port = block.definition->inputs[c.port];
    const diagram::FlatBlock& from = diagram_.blocks[source.block];
    const bool integrator = block.definition->role == Role::integrator;
    const bool reference = from.definition->role == Role::reference;
    double factor = setting * c.weight * c.inputs;
    if (reference) factor *= parameter_of(from, "value");
    if (integrator && port.sum) factor *= parameter_of(block, "rate");
    const std::string number = fmt::format("{}{:.4g}", factor < 0 ? "−" : "", std::abs(factor));
    if (integrator && !port.sum) return fmt::format("{} starts at {}", block.path, number);
    return fmt::format("{}{}{} in {}", number, integrator ? " 1/s" : "",
                       reference ? "" : " of " + diagram_.signal_name(source), block.path);
  }

  std::string voltage(double value) const { return rounded(value * volts_); }

  const diagram::FlatDiagram& diagram_;
  double volts_;  ///< 1 machine unit [V]
  std::string unit_;
  std::vector<std::string> numbers_;  ///< of each block
  std::vector<Connection> connections_;
};

/// A field of a CSV file; quoted where it has to be.
std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + "\"";
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::vector<std::string> fields;
  fields.reserve(cells.size());
  for (const std::string& cell : cells) fields.push_back(csv_field(cell));
  return fmt::format("{}\n", fmt::join(fields, ","));
}

}  // namespace

std::string to_csv(const Sheet& sheet) {
  std::string text = csv_line(sheet.columns);
  for (const auto& row : sheet.rows) text += csv_line(row);
  return text;
}

MachineSheets make_sheets(const diagram::FlatDiagram& diagram,
                          const std::vector<solve::StaticReading>& readings,
                          const diagram::MachineProfile& machine) {
  const SheetMaker maker(diagram, machine);
  return {maker.connections(), maker.potentiometers(),         maker.static_test(readings),
          maker.functions(),   output_sheet(diagram, machine), {}};
}

namespace {

/// Readings of the ideal machine: what the elements should show.
std::vector<solve::StaticReading> expected_readings(diagram::Diagram diagram,
                                                    const diagram::BlockLibrary& library) {
  diagram.machine.profile = "ideal";
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  return solve::static_test(network::Program(network::assemble(flat)), diagram.file);
}

}  // namespace

MachineSheets sheets_of(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                        const diagram::BlockLibrary& library, const diagram::MachineProfile& machine) {
  MachineSheets sheets = make_sheets(flat, expected_readings(diagram, library), machine);
  sheets.modes = mode_sheet(flat, diagram.run.until, machine);
  return sheets;
}

Sheet scale_sheet(const ScaledRealisation& made, const diagram::MachineProfile& machine) {
  const std::string unit = machine.unit ? "V" : "machine unit";
  const double volts = machine.unit.value_or(1);
  Sheet sheet{
      "scales", {"element", "signal", fmt::format("1 {} is", unit), fmt::format("largest [{}]", unit)}, {}};
  for (const SignalScale& scale : made.scales) {
    const auto block =
        std::find_if(made.diagram.blocks.begin(), made.diagram.blocks.end(),
                     [&](const diagram::BlockInstance& candidate) { return candidate.name == scale.signal; });
    sheet.rows.push_back({block->label, scale.signal, fmt::format("{:.6g}", scale.unit / volts),
                          fmt::format("{:.4f}", scale.largest * volts)});
  }
  return sheet;
}

}  // namespace oblique::machine
