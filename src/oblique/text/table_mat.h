// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/table_format.h>

namespace oblique::text {

/// MATLAB, level 4.
MakeTableFormat make_mat_format;

}  // namespace oblique::text
