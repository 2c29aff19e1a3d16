// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/table_format.h>

namespace oblique::text {

/// Comma-separated values, and JSON.
MakeTableFormat make_csv_format, make_json_format;

}  // namespace oblique::text
