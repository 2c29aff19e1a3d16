// SPDX-License-Identifier: MIT
#include "runs.h"

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/draw/schematic/diagram_drawing.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/diagram_check.h>
#include <oblique/report/diagram_check_json.h>
#include <oblique/report/diagram_check_text.h>
#include <oblique/report/pole_chart.h>
#include <oblique/solve/static_test.h>
#include <oblique/text/file.h>

namespace oblique::python {
namespace {

using Model = std::shared_ptr<DiagramModel>;

/// The words and the JSON of a check, the picture of its eigenvalues, and why its trial run failed.
py::dict check(const DiagramModel& model, const Settings& settings) {
  std::string text, json, poles;
  std::vector<text::Diagnostic> failure;
  unlocked([&](SignalWatch& watch) {
    const auto compiled = model.compiled(overrides_of(settings));
    const report::DiagramCheck found =
        report::examine(model.diagram(), compiled->flat, compiled->program, watch.progress());
    text = report::to_text(found, python_words());
    json = report::to_json(found);
    poles = draw::to_svg(
        draw::draw_chart(report::pole_chart(compiled->flat, compiled->program, found.analysis.instants,
                                            "Eigenvalues along the run: " + model.diagram().title)));
    if (found.analysis.failure) failure = found.analysis.failure->diagnostics();
    return 0;
  });
  py::dict all;
  all["text"] = to_str(text);
  all["json"] = to_str(json);
  all["poles"] = to_str(poles);
  all["failure"] = to_list(failure);
  return all;
}

/// A diagram in scaled signals, by how much its outputs differ, and its overloads.
py::tuple rescaled(const DiagramModel& model) {
  report::ScaledDiagram scaled = unlocked([&](SignalWatch& watch) {
    const auto compiled = model.compiled({});
    const report::DiagramCheck found =
        report::examine(model.diagram(), compiled->flat, compiled->program, watch.progress());
    if (found.analysis.failure) throw solve::SolveError(*found.analysis.failure);
    return report::scaled_by(found, *model.library());
  });
  return py::make_tuple(to_str(diagram::write_diagram(scaled.diagram)), scaled.difference, scaled.overloads);
}

py::list static_test(const DiagramModel& model, const Settings& settings) {
  const std::vector<solve::StaticReading> readings = unlocked([&](SignalWatch&) {
    const diagram::FlatDiagram ideal =
        diagram::flatten_on_ideal_elements(model.diagram(), *model.library(), overrides_of(settings));
    return solve::static_test(network::Program(network::assemble(ideal)), model.diagram().file);
  });
  py::list list;
  for (const solve::StaticReading& reading : readings)
    list.append(py::make_tuple(reading.signal, reading.output, reading.derivative, reading.at_rest));
  return list;
}

std::string drawn_diagram(const DiagramModel& model, const std::string& symbols, int depth,
                          const std::string& theme) {
  draw::DiagramDrawing options;
  if (symbols == "din") options.symbols = draw::SymbolStyle::din;
  options.depth = depth;
  return draw::to_svg(draw::draw_diagram(model.diagram(), *model.library(), options), theme_of(theme));
}

/// The paths of all servo amplifiers, which a machine makes of open amplifiers, with a gain to be set.
std::vector<std::string> servo_amplifiers(const DiagramModel& model) {
  std::vector<std::string> paths;
  for (const diagram::FlatBlock& block : model.compiled({})->flat.blocks) {
    if (block.definition->role == diagram::Role::open_amplifier && block.definition->find_parameter("gain"))
      paths.push_back(block.path);
  }
  return paths;
}

}  // namespace

void bind_diagrams(py::module_& module) {
  py::class_<DiagramModel, Model>(module, "Diagram")
      .def(py::init([](const std::string& text, const std::string& file, const Library& library) {
        return unlocked([&](SignalWatch&) {
          return std::make_shared<DiagramModel>(diagram::parse_diagram(text, file), library);
        });
      }))
      .def_property_readonly("title", [](const DiagramModel& model) { return to_str(model.diagram().title); })
      .def_property_readonly("until", [](const DiagramModel& model) { return model.diagram().run.until; })
      .def_property_readonly("machine",
                             [](const DiagramModel& model) { return model.diagram().machine.profile; })
      .def_property_readonly("blocks",
                             [](const DiagramModel& model) {
                               py::list list;
                               for (const diagram::BlockInstance& block : model.diagram().blocks)
                                 list.append(py::make_tuple(block.name, block.type));
                               return list;
                             })
      .def_property_readonly("outputs",
                             [](const DiagramModel& model) {
                               py::list list;
                               for (const diagram::OutputSpec& output : model.diagram().outputs)
                                 list.append(py::make_tuple(output.name, output.signal, to_str(output.unit)));
                               return list;
                             })
      .def_property_readonly("expects",
                             [](const DiagramModel& model) { return !model.diagram().expectations.empty(); })
      .def("toml", [](const DiagramModel& model) { return to_str(diagram::write_diagram(model.diagram())); })
      .def("columns",
           [](const DiagramModel& model) {
             return to_list(
                 solve::output_columns(unlocked([&](SignalWatch&) { return model.compiled({}); })->flat));
           })
      .def("servo_amplifiers", &servo_amplifiers)
      .def("run", &run_diagram)
      .def("gradient", &gradient_of)
      .def("check", &check)
      .def("rescaled", &rescaled)
      .def("static_test", &static_test)
      .def("draw", &drawn_diagram);
  module.def("read_file", [](const std::string& path) { return py::bytes(text::read_file(path)); });
  module.def("write_file",
             [](const std::string& path, const std::string& text) { text::write_file(path, text); });
}

}  // namespace oblique::python
