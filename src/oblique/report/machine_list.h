// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/machine_profile.h>
#include <oblique/text/diagnostic.h>

namespace oblique::report {

/// The machines that there are, a line each, and how many elements they have.
std::string machine_list(const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// All that is known of one.
std::string to_text(const diagram::MachineProfile& machine, const diagram::BlockLibrary& library);
nlohmann::ordered_json to_json(const diagram::MachineProfile& machine);

}  // namespace oblique::report
