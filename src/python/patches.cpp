// SPDX-License-Identifier: MIT
#include "binding.h"

#include <oblique/commission/judge.h>
#include <oblique/commission/on_machine.h>
#include <oblique/compare/branch.h>
#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/component_list.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/sheets.h>
#include <oblique/report/comparison_report.h>
#include <oblique/report/component_list_text.h>
#include <oblique/report/judgement_text.h>

namespace oblique::python {
namespace {

py::dict told(const commission::Judgement& judgement) {
  py::dict all;
  all["good"] = judgement.good();
  all["well_damped"] = judgement.well_damped();
  all["slowest_pole"] = judgement.slowest_pole;
  all["damping"] = judgement.damping;
  all["largest_signal"] = judgement.largest_signal;
  all["largest"] = judgement.largest;
  all["grows_from"] = judgement.grows_from;
  all["text"] = to_str(report::judgement_text(judgement, python_words()));
  return all;
}

py::dict told(const patch::PatchOptions& options, const mechanism::Mechanism& mechanism) {
  py::dict all;
  all["method"] = std::string(patch::method_name(options.method));
  all["gain"] = options.gain;
  all["bandwidth"] = patch::bandwidth_of(mechanism, options);
  all["slower"] = options.slower;
  all["split"] = options.split;
  return all;
}

py::tuple table_of(const machine::Sheet& sheet) {
  return py::make_tuple(to_str(sheet.title), sheet.columns, sheet.rows, to_str(machine::to_csv(sheet)));
}

py::dict patched(const MechanismModel& model, const Library& library, const py::dict& asked) {
  const patch::PatchOptions options = patch_options(asked);
  commission::JudgedPatch made;
  std::optional<double> off_branch;
  unlocked([&](SignalWatch&) {
    made = commission::judged_patch(model.mechanism, *library, options);
    off_branch = compare::drive_off_branch(model.mechanism, made, *library);
    return 0;
  });
  py::dict all;
  all["text"] = to_str(diagram::write_diagram(made.diagram));
  all["judgement"] = told(made.judgement);
  if (off_branch) {
    all["judgement"]["text"] = to_str(report::judgement_text(made.judgement, python_words()) +
                                      report::left_branch_text(model.mechanism, *off_branch, python_words()));
  }
  all["options"] = told(made.options, model.mechanism);
  return all;
}

/// The same in a machine's elements; `force`: though the machine has none of some kind.
py::dict patched_on(const MechanismModel& model, const Library& library, const std::string& name,
                    const py::dict& asked) {
  const patch::PatchOptions options = patch_options(asked);
  const diagram::MachineProfile* const machine = diagram::find_machine(name);
  if (machine == nullptr) throw diagram::DiagramError(diagram::unknown_machine(name));
  commission::MachinePatch made;
  machine::ComponentList components;
  machine::MachineSheets sheets;
  std::vector<std::string> absent;
  unlocked([&](SignalWatch&) {
    commission::JudgedPatch ideal = commission::judged_patch(model.mechanism, *library, options);
    components = machine::component_list_of(
        diagram::flatten(machine::realise(ideal.diagram, *library, *machine).diagram, *library), *machine);
    absent = components.absent();
    if (!absent.empty() && !options.force) return 0;
    made = commission::put_on_machine(model.mechanism, *library, *machine, std::move(ideal));
    const diagram::FlatDiagram flat = diagram::flatten(made.realised, *library);
    components = machine::component_list_of(flat, *machine);
    sheets = machine::sheets_of(made.realised, flat, *library, *machine);
    return 0;
  });
  if (!absent.empty() && !options.force) {
    std::string list;
    for (const std::string& kind : absent) list += (list.empty() ? "no " : ", no ") + kind;
    throw patch::PatchError(
        text::Diagnostic{{model.file, {}},
                         "the machine " + machine->title + " has " + list,
                         {},
                         text::Remedy{"choose another of ", text::Action{"machines"},
                                      ", or patch it all the same with ", text::Setting{"force", "True"}}});
  }
  py::list rows;
  for (const machine::ComponentListRow& row : components.rows)
    rows.append(py::make_tuple(to_str(row.element), row.needed, row.available, row.missing(), row.exists));
  py::dict all;
  all["text"] = to_str(diagram::write_diagram(made.realised));
  all["judgement"] = told(made.judgement);
  all["options"] = told(made.options, model.mechanism);
  all["bandwidth_text"] = to_str(report::bandwidth_text(made, *machine));
  all["components"] = rows;
  all["components_text"] = to_str(report::to_text(components));
  all["fits"] = components.verdict() == machine::ComponentList::Verdict::fits;
  all["sheets"] = py::make_tuple(table_of(sheets.connections), table_of(sheets.potentiometers),
                                 table_of(sheets.static_test), table_of(sheets.functions));
  return all;
}

}  // namespace

void bind_patches(py::class_<MechanismModel, std::shared_ptr<MechanismModel>>& model) {
  model.def("patch", &patched).def("patch_on", &patched_on);
}

}  // namespace oblique::python
