// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/network/program/compilation.h>

namespace oblique::network {

/// Decides where every derivative goes, those of algebraic loops included.
void lay_out_jacobian(Compilation& c);

}  // namespace oblique::network
