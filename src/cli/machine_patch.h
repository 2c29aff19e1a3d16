// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/compare/on_machine.h>
#include <oblique/machine/bill.h>
#include <oblique/machine/sheets.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {

/// The bill as a table with its verdict, for people.
std::string to_text(const Bill& bill);
Table bill_table(const Bill& bill);
std::string verdict_text(const Bill& bill);  ///< "it fits"

/// The sheets of a diagram that is in the machine's elements; `flat` is flattened from it.
MachineSheets sheets_of(const Diagram& diagram, const FlatDiagram& flat, const BlockLibrary& library,
                        const MachineProfile& machine);

/// Whether --machine, --sheets and -o can be served, before any work is done. Throws ReadError and
/// DiagramError.
void check_machine_request(const PatchRequest& request);

/// Puts a patch into the elements of the machine of --machine and writes it, with the sheets where they are
/// asked for; the bill goes to stderr. Where the machine has no elements of a kind that is needed nothing is
/// written, unless forced, and the status is `no`.
ExitStatus patch_for_machine(const BlockLibrary& library, const PatchRequest& request,
                             const Mechanism& mechanism, const JudgedPatch& patched);

/// Says that a patch on a machine has other amplifiers than it would by itself; empty where it has not.
std::string bandwidth_text(const MachinePatch& patch, const MachineProfile& machine);

}  // namespace oblique::cli
