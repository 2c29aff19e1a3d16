// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/commission/diagram_on_machine.h>
#include <oblique/commission/on_machine.h>
#include <oblique/machine/coarse_settings.h>
#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// What `patch` tells of a patch that it has run: whether its servo loops come to rest, its largest signal.
std::string judgement_text(const commission::Judgement& judgement,
                           const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// Where a patch has slower amplifiers on this machine than elsewhere, and why; or nothing.
std::string bandwidth_text(const commission::MachinePatch& patch, const diagram::MachineProfile& machine);

/// What `patch` tells of a diagram on a machine: its time, how much of the machine unit it uses, functions
/// that function generators stand for, servo loops, and how it does on ideal and on real elements.
std::string machine_text(const commission::DiagramOnMachine& patched, const diagram::MachineProfile& machine);

/// What `patch` tells of potentiometers whose settings are too small for their steps: each with the step, how
/// far it may be off, and what to do; or nothing.
std::string settings_text(const std::vector<machine::CoarseSetting>& settings,
                          const diagram::MachineProfile& machine);

}  // namespace oblique::report
