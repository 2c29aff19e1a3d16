// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <oblique/machine/bill.h>

#include <oblique/report/text_table.h>

namespace oblique::report {

/// The elements that a diagram takes, those that its machine has, and the verdict.
std::string to_text(const machine::Bill& bill);

/// The same as a table: element, needed, available, missing.
Table bill_table(const machine::Bill& bill);
std::string verdict_text(const machine::Bill& bill);  ///< "it fits"

}  // namespace oblique::report
