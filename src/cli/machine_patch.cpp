// SPDX-License-Identifier: MIT
#include "machine_patch.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/realise.h>
#include <oblique/network/assembly/network.h>

#include "output_files.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

std::string available_text(const machine::BillRow& row) {
  if (!row.exists) return "none";
  if (!row.available) return "not published";
  return std::isinf(*row.available) ? "as many as it takes" : fmt::format("{}", *row.available);
}

constexpr std::array<const char*, 4> kSheetEndings{"-patch.csv", "-pots.csv", "-static.csv", ".txt"};

std::string table_of(const machine::Sheet& sheet) {
  Table table(sheet.columns);
  for (const auto& row : sheet.rows) table.add(row);
  return sheet.title + "\n" + table.text(sheet.columns.size());
}

/// Readings of the ideal machine: what the elements should show.
std::vector<solve::StaticReading> expected_readings(diagram::Diagram diagram,
                                                    const diagram::BlockLibrary& library) {
  diagram.machine.profile = "ideal";
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  return solve::static_test(network::Program(network::assemble(flat)), diagram.file);
}

std::vector<Written> sheet_files(const PatchRequest& request, const diagram::Diagram& diagram,
                                 const diagram::FlatDiagram& flat, const machine::Bill& bill,
                                 const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine) {
  const machine::MachineSheets sheets = sheets_of(diagram, flat, library, machine);
  const std::string text =
      fmt::format("{}\n\n{}\n{}\n{}\n{}", diagram.title, cli::to_text(bill), table_of(sheets.connections),
                  table_of(sheets.potentiometers), table_of(sheets.static_test));
  const std::array<std::string, 4> texts{machine::to_csv(sheets.connections),
                                         machine::to_csv(sheets.potentiometers),
                                         machine::to_csv(sheets.static_test), text};
  std::vector<Written> files;
  for (std::size_t k = 0; k < texts.size(); ++k)
    files.push_back({request.sheets + kSheetEndings[k], texts[k]});
  return files;
}

}  // namespace

std::string verdict_text(const machine::Bill& bill) {
  std::vector<std::string> named;
  switch (bill.verdict()) {
    case machine::Bill::Verdict::fits:
      return "it fits";
    case machine::Bill::Verdict::does_not_fit:
      for (const machine::BillRow& row : bill.rows) {
        if (row.missing() > 0) named.push_back(fmt::format("{} ({})", row.element, row.missing()));
      }
      return fmt::format("it does not fit; missing: {}", fmt::join(named, ", "));
    case machine::Bill::Verdict::cannot_tell:
      break;
  }
  for (const machine::BillRow& row : bill.rows) {
    if (row.at_least) {
      named.emplace_back("what its inputs weigh");
    } else if (!row.available) {
      named.push_back("how many " + row.element);
    }
  }
  return fmt::format("whether it fits cannot be told; not published: {}", fmt::join(named, ", "));
}

Table bill_table(const machine::Bill& bill) {
  Table table({"element", "needed", "available", "missing"});
  for (const machine::BillRow& row : bill.rows) {
    table.add({row.note.empty() ? row.element : fmt::format("{} ({})", row.element, row.note),
               fmt::format("{}{}", row.at_least ? "≥ " : "", row.needed), available_text(row),
               row.missing() > 0 ? fmt::format("{}", row.missing()) : ""});
  }
  return table;
}

std::string to_text(const machine::Bill& bill) {
  return fmt::format("elements of {}\n{}{}\n", bill.machine, bill_table(bill).text(1), verdict_text(bill));
}

machine::MachineSheets sheets_of(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                                 const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine) {
  return machine::make_sheets(flat, expected_readings(diagram, library), machine);
}

void check_machine_request(const PatchRequest& request) {
  if (request.machine.empty()) {
    if (request.sheets.empty()) return;
    throw text::ReadError(text::Diagnostic{{}, "--sheets is for a machine", "--machine NAME beside it", {}});
  }
  if (diagram::find_machine(request.machine) == nullptr)
    throw text::ReadError(diagram::unknown_machine(request.machine));
  if (request.sheets.empty()) return;
  for (const std::string ending : kSheetEndings) {
    check_output(request.sheets + ending, ending.substr(ending.find('.')));
  }
}

std::string bandwidth_text(const commission::MachinePatch& patch, const diagram::MachineProfile& machine) {
  if (!patch.usual) return "";
  return fmt::format("servo amplifiers of {:g} Hz here: with {:g} Hz on the elements of {}, {}\n",
                     *patch.options.bandwidth, patch.usual->bandwidth, machine.title, patch.usual->fault);
}

ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const mechanism::Mechanism& mechanism, const commission::JudgedPatch& patched) {
  const diagram::MachineProfile& machine = *diagram::find_machine(request.machine);
  const machine::Bill needed = machine::bill_of(
      diagram::flatten(machine::realise(patched.diagram, library, machine).diagram, library), machine);
  if (const auto absent = needed.absent(); !absent.empty() && !request.force) {
    note(to_text(needed));
    print_error(text::to_string(text::Diagnostic{
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
  const machine::Bill bill = machine::bill_of(flat, machine);
  note(to_text(bill));
  note(bandwidth_text(on_machine, machine));
  note(judgement_text(on_machine.judgement));
  std::vector<Written> files;
  if (!request.sheets.empty()) files = sheet_files(request, realised, flat, bill, library, machine);
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
