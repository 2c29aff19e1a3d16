// SPDX-License-Identifier: MIT
#include "binding.h"

#include <nlohmann/json.hpp>

#include <oblique/diagram/machine_profile.h>
#include <oblique/report/block_page.h>
#include <oblique/report/json_text.h>
#include <oblique/report/machine_list.h>
#include <oblique/text/quantity.h>

namespace oblique::python {
namespace {

py::dict described(const diagram::BlockDefinition& block) {
  py::list inputs, outputs, parameters;
  for (const diagram::InputPort& port : block.inputs)
    inputs.append(py::make_tuple(port.name, port.sum, port.default_value, to_str(port.doc)));
  for (const diagram::OutputPort& port : block.outputs)
    outputs.append(py::make_tuple(port.name, to_str(port.doc)));
  for (const diagram::ParameterDefinition& parameter : block.parameters) {
    py::object value = py::float_(parameter.default_value);
    if (parameter.points || parameter.formula) value = py::none();
    parameters.append(py::make_tuple(parameter.name, value, parameter.unit, parameter.points.has_value(),
                                     to_str(parameter.doc)));
  }
  py::dict all;
  all["title"] = to_str(block.title);
  all["summary"] = to_str(block.summary);
  all["text"] = to_str(report::to_text(block));
  all["inputs"] = inputs;
  all["outputs"] = outputs;
  all["parameters"] = parameters;
  return all;
}

/// A quantity in `unit`, of the argument `name`.
double quantity(const std::string& name, const std::string& text, const std::string& unit) {
  try {
    return text::parse_quantity(text, text::parse_unit(unit).value());
  } catch (const text::ExpressionError& error) {
    throw text::ReadError(
        text::Diagnostic{{}, name + "=\"" + text + "\": " + error.what, error.expected, error.remedy});
  }
}

}  // namespace

void bind_libraries(py::module_& module) {
  py::class_<diagram::BlockLibrary, Library>(module, "BlockLibrary")
      .def(py::init([](const std::vector<std::string>& folders) {
        auto library = std::make_shared<diagram::BlockLibrary>(diagram::BlockLibrary::shipped());
        for (const std::string& folder : folders) library->add_directory(folder);
        return library;
      }))
      .def("names", &diagram::BlockLibrary::names)
      .def("describe", [](const diagram::BlockLibrary& library, const std::string& name) -> py::object {
        const diagram::BlockDefinition* const block = library.find(name);
        if (block == nullptr) return py::none();
        return described(*block);
      });
  module.def("quantity", quantity);
  module.def("suggest", [](const std::string& name, const std::vector<std::string>& candidates) {
    return text::suggest(name, candidates);
  });
  module.def("machine_names", &diagram::machine_names);
  module.def("machine", [](const std::string& name) -> py::object {
    const diagram::MachineProfile* const machine = diagram::find_machine(name);
    if (machine == nullptr) return py::none();
    return py::make_tuple(to_str(machine->title),
                          to_str(report::to_text(*machine, diagram::BlockLibrary::shipped())),
                          to_str(report::json_text(report::to_json(*machine))));
  });
}

}  // namespace oblique::python
