// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/commission/on_machine.h>
#include <oblique/machine/bill.h>
#include <oblique/machine/sheets.h>

#include "command.h"
#include "terminal.h"

namespace oblique::cli {

/// The bill as a table with its verdict, for people.
std::string to_text(const machine::Bill& bill);
Table bill_table(const machine::Bill& bill);
std::string verdict_text(const machine::Bill& bill);  ///< "it fits"

/// The sheets of a diagram that is in the machine's elements; `flat` is flattened from it.
machine::MachineSheets sheets_of(const diagram::Diagram& diagram, const diagram::FlatDiagram& flat,
                                 const diagram::BlockLibrary& library,
                                 const diagram::MachineProfile& machine);

/// Whether --machine, --sheets and -o can be served, before any work is done. Throws ReadError and
/// DiagramError.
void check_machine_request(const PatchRequest& request);

/// Puts a patch into the elements of the machine of --machine and writes it, with the sheets where they are
/// asked for; the bill goes to stderr. Where the machine has no elements of a kind that is needed nothing is
/// written, unless forced, and the status is `no`.
ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const mechanism::Mechanism& mechanism, const commission::JudgedPatch& patched);

/// Says that a patch on a machine has other amplifiers than it would by itself; empty where it has not.
std::string bandwidth_text(const commission::MachinePatch& patch, const diagram::MachineProfile& machine);

}  // namespace oblique::cli
