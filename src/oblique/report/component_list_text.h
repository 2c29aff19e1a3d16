// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/machine/component_list.h>

#include <oblique/report/text_table.h>

namespace oblique::report {

/// The elements that a diagram takes, those that its machine has, and the verdict.
std::string to_text(const machine::ComponentList& components);

/// The same as a table: element, needed, available, missing.
Table component_list_table(const machine::ComponentList& components);
std::string verdict_text(const machine::ComponentList& components);  ///< "it fits"

}  // namespace oblique::report
