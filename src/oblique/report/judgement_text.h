// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/commission/on_machine.h>
#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// What `patch` tells of a patch that it has run: whether its servo loops come to rest, its largest signal.
std::string judgement_text(const commission::Judgement& judgement,
                           const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// Where a patch has slower amplifiers on this machine than elsewhere, and why; or nothing.
std::string bandwidth_text(const commission::MachinePatch& patch, const diagram::MachineProfile& machine);

}  // namespace oblique::report
