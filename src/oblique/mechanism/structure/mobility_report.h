// SPDX-License-Identifier: MIT
#pragma once

#include <oblique/mechanism/model/mechanism.h>
#include <oblique/mechanism/structure/constraint_graph.h>

namespace oblique::mechanism {

/// Throws MechanismError (kind `mobility`) where the degrees of freedom are not as many as the drives.
void check_mobility(const Mechanism& mechanism);

/// The same for the parts of a mechanism: one finding for each place where conditions are too many, and one
/// for what moves freely.
void check_parts(const Mechanism& mechanism, const ConstraintGraph& graph);

}  // namespace oblique::mechanism
