// SPDX-License-Identifier: MIT
#include <oblique/report/machine_list.h>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <oblique/report/text_table.h>

namespace oblique::report {
namespace {

using Json = nlohmann::ordered_json;

/// "20", "any" for as many as it takes, "?" where that is unknown, "–" for none.
std::string cell_of(const diagram::ElementCount* element) {
  if (element == nullptr) return "–";
  if (!element->count) return "?";
  return std::isinf(*element->count) ? "any" : short_number(*element->count);
}

std::string list_of_machines(const text::Vocabulary& vocabulary) {
  Table table({"name", "machine", "unit", "amplifiers", "integrators", "summers", "multipliers", "pots"});
  for (const std::string& name : diagram::machine_names()) {
    const diagram::MachineProfile& machine = *diagram::find_machine(name);
    const auto cell = [&](diagram::ElementKind kind) { return cell_of(machine.find(kind)); };
    table.add({name, machine.title, machine.unit ? short_number(*machine.unit) + " V" : "?",
               cell(diagram::ElementKind::amplifier), cell(diagram::ElementKind::integrator),
               cell(diagram::ElementKind::summer), cell(diagram::ElementKind::multiplier),
               cell(diagram::ElementKind::potentiometer)});
  }
  return table.text(2) +
         "\nany: as many as it takes; ?: unknown; –: none. Amplifiers are uncommitted: they become summers,\n"
         "inverters and, with the networks that stand under integrators, integrators.\n" +
         vocabulary.action({"machines", "NAME"}) + " tells all about one.\n";
}

/// "1, 10", "any" or "unknown".
std::string text_of(const std::vector<double>& steps, bool known) {
  if (!known) return "unknown";
  return steps.empty() ? "any" : fmt::format("{}", fmt::join(steps, ", "));
}

/// A figure's value with the unit of its parameter.
std::string value_of(const diagram::BlockFigure& figure, const diagram::BlockLibrary& library) {
  const diagram::BlockDefinition& block = *library.find(figure.block);
  const std::string& unit = block.parameters[*block.find_parameter(figure.parameter)].unit;
  return unit == "1" ? short_number(figure.value) : short_number(figure.value) + " " + unit;
}

std::string actions_of(const diagram::MachineProfile& machine, const diagram::BlockLibrary& library) {
  Table table({"acts on", "parameter", "value", "from the figure"});
  for (const diagram::BlockFigure& f : machine.errors)
    table.add({f.block, f.parameter, value_of(f, library), f.figure});
  for (const diagram::BlockFigure& f : machine.scatters)
    table.add({f.block, f.parameter, "each its own within ± " + value_of(f, library), f.figure});
  return table.text(4);
}

std::string page_of(const diagram::MachineProfile& machine, const diagram::BlockLibrary& library) {
  std::string text = fmt::format("{} ({})\n", machine.title, machine.name);
  if (!machine.comment.empty()) text += machine.comment + (machine.comment.ends_with('\n') ? "" : "\n");
  Table facts({"machine unit", machine.unit ? short_number(*machine.unit) + " V" : "unknown"});
  facts.add({"summers and integrators", !machine.inverting          ? "do not invert"
                                        : machine.inverting_summers ? "invert"
                                                                    : "integrators invert, summers do not"});
  facts.add({"input gains", text_of(machine.input_gains, machine.input_gains_known)});
  facts.add({"time factors k0 [1/s]", text_of(machine.rates, machine.rates_known)});
  facts.add({"amplifiers saturate at",
             machine.saturation ? "±" + short_number(*machine.saturation) + " machine units" : "no level"});
  facts.add({"coefficients", machine.signed_coefficients ? "−1 … 1" : "0 … 1"});
  text += "\n" + facts.text(2) + "\n";
  Table elements({"element", "count", ""});
  for (const diagram::ElementCount& element : machine.elements) {
    elements.add({std::string(diagram::element_name(element.kind)),
                  element.count ? cell_of(&element) : "unknown", element.note});
  }
  text += elements.text(3);
  if (!machine.figures.empty()) {
    Table figures({"figure", "published", ""});
    for (const diagram::MachineFigure& f : machine.figures) {
      const bool elsewhere = !f.source.empty() && f.source != machine.source;
      figures.add({f.name, f.value, elsewhere ? "[" + f.source + "]" : ""});
    }
    text += "\n" + figures.text(3);
  }
  if (!machine.errors.empty() || !machine.scatters.empty()) text += "\n" + actions_of(machine, library);
  return text + fmt::format("\nsource: {}\n", machine.source);
}

Json steps_json(const std::vector<double>& steps, bool known) {
  return known && !steps.empty() ? Json(steps) : Json(known ? "any" : "unknown");
}

Json json_of(const std::vector<diagram::BlockFigure>& figures) {
  Json list = Json::array();
  for (const diagram::BlockFigure& f : figures)
    list.push_back(
        {{"block", f.block}, {"parameter", f.parameter}, {"value", f.value}, {"figure", f.figure}});
  return list;
}

Json json_of(const diagram::MachineProfile& machine) {
  Json elements = Json::array();
  for (const diagram::ElementCount& e : machine.elements) {
    const Json count = !e.count ? Json("unknown") : std::isinf(*e.count) ? Json("any") : Json(*e.count);
    elements.push_back({{"element", diagram::element_name(e.kind)}, {"count", count}, {"note", e.note}});
  }
  Json figures = Json::array();
  for (const diagram::MachineFigure& f : machine.figures)
    figures.push_back({{"name", f.name}, {"value", f.value}, {"source", f.source}});
  return {{"name", machine.name},
          {"title", machine.title},
          {"source", machine.source},
          {"comment", machine.comment},
          {"unit", machine.unit ? Json(*machine.unit) : Json("unknown")},
          {"inverting", machine.inverting},
          {"inverting_summers", machine.inverting_summers},
          {"input_gains", steps_json(machine.input_gains, machine.input_gains_known)},
          {"rates", steps_json(machine.rates, machine.rates_known)},
          {"signed_coefficients", machine.signed_coefficients},
          {"saturation", machine.saturation ? Json(*machine.saturation) : Json("none")},
          {"elements", std::move(elements)},
          {"figures", std::move(figures)},
          {"errors", json_of(machine.errors)},
          {"scatters", json_of(machine.scatters)}};
}

}  // namespace

std::string machine_list(const text::Vocabulary& vocabulary) {
  return list_of_machines(vocabulary);
}

std::string to_text(const diagram::MachineProfile& machine, const diagram::BlockLibrary& library) {
  return page_of(machine, library);
}

nlohmann::ordered_json to_json(const diagram::MachineProfile& machine) {
  return json_of(machine);
}

}  // namespace oblique::report
