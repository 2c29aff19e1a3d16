// SPDX-License-Identifier: MIT
#include "machine_patch.h"

#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/machine/realise.h>
#include <oblique/network/network.h>

#include "output_files.h"
#include "terminal.h"

namespace oblique::cli {
namespace {

std::string available_text(const BillRow& row) {
  if (!row.exists) return "none";
  if (!row.available) return "not published";
  return std::isinf(*row.available) ? "as many as it takes" : fmt::format("{}", *row.available);
}

constexpr std::array<const char*, 4> kSheetEndings{"-patch.csv", "-pots.csv", "-static.csv", ".txt"};

std::string table_of(const Sheet& sheet) {
  Table table(sheet.columns);
  for (const auto& row : sheet.rows) table.add(row);
  return sheet.title + "\n" + table.text(sheet.columns.size());
}

/// Readings of the ideal machine: what the elements should show.
std::vector<StaticReading> expected_readings(Diagram diagram, const BlockLibrary& library) {
  diagram.machine.profile = "ideal";
  const FlatDiagram flat = flatten(diagram, library);
  return static_test(Program(assemble(flat)), diagram.file);
}

std::vector<Written> sheet_files(const PatchRequest& request, const Diagram& diagram, const FlatDiagram& flat,
                                 const Bill& bill, const BlockLibrary& library,
                                 const MachineProfile& machine) {
  const MachineSheets sheets = sheets_of(diagram, flat, library, machine);
  const std::string text =
      fmt::format("{}\n\n{}\n{}\n{}\n{}", diagram.title, cli::to_text(bill), table_of(sheets.connections),
                  table_of(sheets.potentiometers), table_of(sheets.static_test));
  const std::array<std::string, 4> texts{to_csv(sheets.connections), to_csv(sheets.potentiometers),
                                         to_csv(sheets.static_test), text};
  std::vector<Written> files;
  for (std::size_t k = 0; k < texts.size(); ++k)
    files.push_back({request.sheets + kSheetEndings[k], texts[k]});
  return files;
}

}  // namespace

std::string verdict_text(const Bill& bill) {
  std::vector<std::string> named;
  switch (bill.verdict()) {
    case Bill::Verdict::fits:
      return "it fits";
    case Bill::Verdict::does_not_fit:
      for (const BillRow& row : bill.rows) {
        if (row.missing() > 0) named.push_back(fmt::format("{} ({})", row.element, row.missing()));
      }
      return fmt::format("it does not fit; missing: {}", fmt::join(named, ", "));
    case Bill::Verdict::cannot_tell:
      break;
  }
  for (const BillRow& row : bill.rows) {
    if (row.at_least) {
      named.emplace_back("what its inputs weigh");
    } else if (!row.available) {
      named.push_back("how many " + row.element);
    }
  }
  return fmt::format("whether it fits cannot be told; not published: {}", fmt::join(named, ", "));
}

Table bill_table(const Bill& bill) {
  Table table({"element", "needed", "available", "missing"});
  for (const BillRow& row : bill.rows) {
    table.add({row.note.empty() ? row.element : fmt::format("{} ({})", row.element, row.note),
               fmt::format("{}{}", row.at_least ? "≥ " : "", row.needed), available_text(row),
               row.missing() > 0 ? fmt::format("{}", row.missing()) : ""});
  }
  return table;
}

std::string to_text(const Bill& bill) {
  return fmt::format("elements of {}\n{}{}\n", bill.machine, bill_table(bill).text(1), verdict_text(bill));
}

MachineSheets sheets_of(const Diagram& diagram, const FlatDiagram& flat, const BlockLibrary& library,
                        const MachineProfile& machine) {
  return make_sheets(flat, expected_readings(diagram, library), machine);
}

void check_machine_request(const PatchRequest& request) {
  if (request.machine.empty()) {
    if (request.sheets.empty()) return;
    throw ReadError(Diagnostic{{}, "--sheets is for a machine", "--machine NAME beside it", {}});
  }
  if (find_machine(request.machine) == nullptr) throw ReadError(unknown_machine(request.machine));
  if (request.sheets.empty()) return;
  for (const std::string ending : kSheetEndings) {
    check_output(request.sheets + ending, ending.substr(ending.find('.')));
  }
}

std::string bandwidth_text(const MachinePatch& patch, const MachineProfile& machine) {
  if (!patch.usual) return "";
  return fmt::format("servo amplifiers of {:g} Hz here: with {:g} Hz on the elements of {}, {}\n",
                     *patch.options.bandwidth, patch.usual->bandwidth, machine.title, patch.usual->fault);
}

ExitStatus patch_for_machine(const BlockLibrary& library, const PatchRequest& request,
                             const Mechanism& mechanism, const JudgedPatch& patched) {
  const MachineProfile& machine = *find_machine(request.machine);
  const Bill needed = bill_of(flatten(realise(patched.diagram, library, machine).diagram, library), machine);
  if (const auto absent = needed.absent(); !absent.empty() && !request.force) {
    note(to_text(needed));
    print_error(to_string(Diagnostic{
        {request.mechanism, {}},
        fmt::format("the machine {} has no {}, so nothing is written", machine.title,
                    fmt::join(absent, ", no ")),
        {},
        "choose another machine (oblique machines), or write the diagram all the same with --force"}));
    return ExitStatus::no;
  }
  const MachinePatch on_machine = put_on_machine(mechanism, library, machine, patched);
  const Diagram& realised = on_machine.realised;
  const FlatDiagram flat = flatten(realised, library);
  const Bill bill = bill_of(flat, machine);
  note(to_text(bill));
  note(bandwidth_text(on_machine, machine));
  note(judgement_text(on_machine.judgement));
  std::vector<Written> files;
  if (!request.sheets.empty()) files = sheet_files(request, realised, flat, bill, library, machine);
  const std::string text = write_diagram(realised);
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
