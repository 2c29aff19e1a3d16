// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/commission/diagram_on_machine.h>
#include <oblique/commission/on_machine.h>

#include "verbs/command.h"

namespace oblique::cli {

/// Whether --machine, --sheets and -o can be served, before any work is done. Throws ReadError and
/// DiagramError.
void check_machine_request(const PatchRequest& request);

/// Puts a patch into the elements of the machine of --machine and writes it, with the sheets where they are
/// asked for; the component list goes to stderr. Where the machine has no elements of a kind that is needed
/// nothing is written, unless forced, and the status is `no`.
ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const mechanism::Mechanism& mechanism, const commission::JudgedPatch& patched);

/// The same of a diagram, which is scaled for the machine too; one that does not run on the machine's
/// elements is not written either. Forced, one with blocks that no machine has is written unscaled.
ExitStatus patch_for_machine(const diagram::BlockLibrary& library, const PatchRequest& request,
                             const diagram::Diagram& diagram, const machine::ScalingOptions& options);

}  // namespace oblique::cli
