// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/text/table_format.h>

namespace oblique::text {

/// NumPy.
MakeTableFormat make_npy_format;

}  // namespace oblique::text
