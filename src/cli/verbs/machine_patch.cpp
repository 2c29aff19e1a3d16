// SPDX-License-Identifier: MIT
#include "verbs/machine_patch.h"

#include <array>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/coarse_settings.h>
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

constexpr const char* kPatchEnding = "-patch.csv";
constexpr const char* kPotsEnding = "-pots.csv";
constexpr const char* kStaticEnding = "-static.csv";
constexpr const char* kFunctionsEnding = "-functions.csv";  ///< where there are function generators
constexpr const char* kOutputsEnding = "-outputs.csv";
constexpr const char* kModesEnding = "-modes.csv";
constexpr const char* kScalesEnding = "-scales.csv";  ///< of a diagram alone
constexpr const char* kPaperEnding = ".txt";          ///< all of them
constexpr std::array kSheetEndings{kPatchEnding,   kPotsEnding,  kStaticEnding, kFunctionsEnding,
                                   kOutputsEnding, kModesEnding, kScalesEnding, kPaperEnding};

std::string table_of(const machine::Sheet& sheet) {
  report::Table table(sheet.columns);
  for (const auto& row : sheet.rows) table.add(row);
  return sheet.title + "\n" + table.text(sheet.columns.size());
}

/// The files that --sheets asks for.
std::vector<Written> sheet_files(const PatchRequest& request, const diagram::Diagram& diagram,
                                 const diagram::FlatDiagram& flat, const machine::ComponentList& components,
                                 const diagram::BlockLibrary& library, const diagram::MachineProfile& machine,
                                 const std::string& told, const std::optional<machine::Sheet>& scales) {
  const machine::MachineSheets sheets = machine::sheets_of(diagram, flat, library, machine);
  std::vector<std::pair<const char*, const machine::Sheet*>> all{{kPatchEnding, &sheets.connections},
                                                                 {kPotsEnding, &sheets.potentiometers},
                                                                 {kStaticEnding, &sheets.static_test}};
  if (!sheets.functions.rows.empty()) all.emplace_back(kFunctionsEnding, &sheets.functions);
  all.emplace_back(kOutputsEnding, &sheets.outputs);
  all.emplace_back(kModesEnding, &sheets.modes);
  if (scales) all.emplace_back(kScalesEnding, &*scales);
  std::string paper = diagram.title + "\n\n" + report::to_text(components) + told;
  std::vector<Written> files;
  for (const auto& [ending, sheet] : all) {
    paper += "\n" + table_of(*sheet);
    files.push_back({request.sheets + ending, machine::to_csv(*sheet)});
  }
  files.push_back({request.sheets + kPaperEnding, paper});
  return files;
}

/// "multipliers (for 'xy', 'xz')": the kinds that the machine has none of, with the blocks.
std::vector<std::string> absent_blocks(const machine::ComponentList& components) {
  std::vector<std::string> kinds;
  for (const machine::ComponentListRow& row : components.rows) {
    if (row.exists) continue;
    kinds.push_back(row.blocks.empty()
                        ? row.element
                        : fmt::format("{} (for '{}')", row.element, fmt::join(row.blocks, "', '")));
  }
  return kinds;
}

ExitStatus refuse_absent(const PatchRequest& request, const diagram::MachineProfile& machine,
                         const machine::ComponentList& needed, const std::vector<std::string>& absent) {
  note(report::to_text(needed));
  print_error(message(text::Diagnostic{
      {request.mechanism, {}},
      fmt::format("the machine {} has no {}, so nothing is written", machine.title,
                  fmt::join(absent, ", no ")),
      {},
      "choose another machine (oblique machines), or write the diagram all the same with --force"}));
  return ExitStatus::no;
}

/// Throws the error with what --force would do, where it would do anything.
[[noreturn]] void refuse_diagram(const machine::RealiseError& error, const diagram::Diagram& diagram,
                                 const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine) {
  std::vector<text::Diagnostic> findings = error.diagnostics();
  try {
    machine::realise(diagram, library, machine);
    findings.back().remedy += "; --force writes the diagram unscaled, with its own blocks";
  } catch (const machine::RealiseError&) {  // not even so
  }
  throw machine::RealiseError(findings);
}

/// Of a diagram that cannot run on the machine's elements.
ExitStatus refuse_failing(const PatchRequest& request, const diagram::MachineProfile& machine,
                          const machine::ComponentList& needed, const std::string& failure) {
  note(report::to_text(needed));
  print_error(message(text::Diagnostic{
      {request.mechanism, {}},
      fmt::format("on the elements of {} it does not run, so nothing is written: {}", machine.title, failure),
      {},
      "choose another machine (oblique machines), or write the diagram all the same with --force"}));
  return ExitStatus::no;
}

/// Writes the diagram and the sheets, after the component list and what is told of the diagram.
ExitStatus write_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const diagram::MachineProfile& machine, const diagram::Diagram& realised,
                             const std::string& findings, const std::optional<machine::Sheet>& scales) {
  const diagram::FlatDiagram flat = diagram::flatten(realised, library);
  const std::string told = findings + report::settings_text(machine::coarse_settings(flat, machine), machine);
  const machine::ComponentList components = machine::component_list_of(flat, machine);
  note(report::to_text(components));
  note(told);
  std::vector<Written> files;
  if (!request.sheets.empty())
    files = sheet_files(request, realised, flat, components, library, machine, told, scales);
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

/// Of a diagram that has been put onto the machine.
ExitStatus write_scaled(const diagram::BlockLibrary& library, const PatchRequest& request,
                        const diagram::MachineProfile& machine, const commission::DiagramOnMachine& patched,
                        const std::string& findings) {
  return write_for_machine(library, request, machine, patched.made.diagram,
                           findings + report::machine_text(patched, machine),
                           machine::scale_sheet(patched.made, machine));
}

/// A mechanism whose patch has blocks of which the machine has no element, put onto it as any diagram is:
/// that makes what it has of sources such as a drive's law. Nothing where it cannot.
std::optional<commission::DiagramOnMachine> as_diagram(const diagram::BlockLibrary& library,
                                                       const diagram::MachineProfile& machine,
                                                       const diagram::Diagram& diagram) {
  try {
    commission::DiagramOnMachine patched = commission::put_on_machine(diagram, library, machine);
    const machine::ComponentList needed =
        machine::component_list_of(diagram::flatten(patched.made.diagram, library), machine);
    if (absent_blocks(needed).empty() && patched.failure.empty()) return patched;
  } catch (const machine::RealiseError&) {
  }
  return std::nullopt;
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
  if (std::filesystem::is_directory(request.sheets) || request.sheets.ends_with('/'))
    throw text::ReadError(text::Diagnostic{
        {},
        fmt::format("--sheets {} is a folder", request.sheets),
        "what the names of the sheets begin with",
        fmt::format("--sheets {}", (std::filesystem::path(request.sheets) / "sheet").string())});
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
    const auto scaled = as_diagram(library, machine, patched.diagram);
    if (!scaled) return refuse_absent(request, machine, needed, absent);
    return write_scaled(library, request, machine, *scaled,
                        fmt::format("put onto the machine as a diagram is, since it has no {}\n",
                                    fmt::join(absent, ", no ")));
  }
  const commission::MachinePatch on_machine =
      commission::put_on_machine(mechanism, library, machine, patched);
  const std::string told = report::bandwidth_text(on_machine, machine) +
                           report::judgement_text(on_machine.judgement, command_line());
  return write_for_machine(library, request, machine, on_machine.realised, told, {});
}

ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const diagram::Diagram& diagram, const machine::ScalingOptions& options) {
  const diagram::MachineProfile& machine = *diagram::find_machine(request.machine);
  std::optional<commission::DiagramOnMachine> patched;
  try {
    patched = commission::put_on_machine(diagram, library, machine, options);
  } catch (const machine::RealiseError& error) {
    if (!request.force) refuse_diagram(error, diagram, library, machine);
    const diagram::Diagram realised = machine::realise(diagram, library, machine).diagram;
    const std::string told = fmt::format("warning: not scaled: {}\n", error.diagnostics().front().what);
    return write_for_machine(library, request, machine, realised, told, {});
  }
  const machine::ComponentList needed =
      machine::component_list_of(diagram::flatten(patched->made.diagram, library), machine);
  if (const auto absent = absent_blocks(needed); !absent.empty() && !request.force)
    return refuse_absent(request, machine, needed, absent);
  if (!patched->failure.empty() && !request.force)
    return refuse_failing(request, machine, needed, patched->failure);
  return write_scaled(library, request, machine, *patched, {});
}

}  // namespace oblique::cli
