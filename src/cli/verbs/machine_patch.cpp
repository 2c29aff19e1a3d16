// SPDX-License-Identifier: MIT
#include "verbs/machine_patch.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/realise.h>
#include <oblique/machine/sheets.h>
#include <oblique/network/assembly/network.h>

#include <oblique/diagram/diagram_writer.h>
#include <oblique/diagram/flatten.h>
#include <oblique/report/component_list_text.h>
#include <oblique/report/judgement_text.h>
#include <oblique/report/text_table.h>
#include "terminal/output_files.h"
#include "terminal/terminal.h"

namespace oblique::cli {
namespace {

constexpr std::array<const char*, 4> kSheetEndings{"-patch.csv", "-pots.csv", "-static.csv", ".txt"};

std::string table_of(const machine::Sheet& sheet) {
  report::Table table(sheet.columns);
  for (const auto& row : sheet.rows) table.add(row);
  return sheet.title + "\n" + table.text(sheet.columns.size());
}

std::vector<Written> sheet_files(const PatchRequest& request, const diagram::Diagram& diagram,
                                 const diagram::FlatDiagram& flat, const machine::ComponentList& components,
                                 const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine) {
  const machine::MachineSheets sheets = machine::sheets_of(diagram, flat, library, machine);
  const std::string text = fmt::format("{}\n\n{}\n{}\n{}\n{}", diagram.title, report::to_text(components),
                                       table_of(sheets.connections), table_of(sheets.potentiometers),
                                       table_of(sheets.static_test));
  const std::array<std::string, 4> texts{machine::to_csv(sheets.connections),
                                         machine::to_csv(sheets.potentiometers),
                                         machine::to_csv(sheets.static_test), text};
  std::vector<Written> files;
  for (std::size_t k = 0; k < texts.size(); ++k)
    files.push_back({request.sheets + kSheetEndings[k], texts[k]});
  return files;
}

}  // namespace

void check_machine_request(const PatchRequest& request) {
  if (request.machine.empty()) {
    if (request.sheets.empty()) return;
    throw text::ReadError(text::Diagnostic{
        {}, "--sheets writes the sheets of a machine, and none is named", "--machine NAME beside it", {}});
  }
  if (diagram::find_machine(request.machine) == nullptr)
    throw text::ReadError(diagram::unknown_machine(request.machine));
  if (request.sheets.empty()) return;
  for (const std::string ending : kSheetEndings) {
    check_output(request.sheets + ending, ending.substr(ending.find('.')));
  }
}

ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const mechanism::Mechanism& mechanism, const commission::JudgedPatch& patched) {
  const diagram::MachineProfile& machine = *diagram::find_machine(request.machine);
  const machine::ComponentList needed = machine::component_list_of(
      diagram::flatten(machine::realise(patched.diagram, library, machine).diagram, library), machine);
  if (const auto absent = needed.absent(); !absent.empty() && !request.force) {
    note(report::to_text(needed));
    print_error(message(text::Diagnostic{
        {request.mechanism, {}},
        fmt::format("the machine {} has no {}, so nothing is written", machine.title,
                    fmt::join(absent, ", no ")),
        {},
        "choose another machine (oblique machines), or write the diagram all the same with --force"}));
    return ExitStatus::no;
  }
  const commission::MachinePatch on_machine =
      commission::put_on_machine(mechanism, library, machine, patched);
  const diagram::Diagram& realised = on_machine.realised;
  const diagram::FlatDiagram flat = diagram::flatten(realised, library);
  const machine::ComponentList components = machine::component_list_of(flat, machine);
  note(report::to_text(components));
  note(report::bandwidth_text(on_machine, machine));
  note(report::judgement_text(on_machine.judgement, command_line()));
  std::vector<Written> files;
  if (!request.sheets.empty()) files = sheet_files(request, realised, flat, components, library, machine);
  const std::string text = diagram::write_diagram(realised);
  if (!request.output.empty()) files.insert(files.begin(), {request.output, text});
  save_together(files);
  if (request.output.empty()) {
    print(text);
  } else {
    note(fmt::format("run it with: oblique run {}\n", request.output));
  }
  return ExitStatus::done;
}

}  // namespace oblique::cli
