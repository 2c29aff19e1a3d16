// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include <oblique/patch/circuit_writer.h>
#include <oblique/patch/group_residuals.h>

namespace oblique::patch {

/// For each unknown signal x the terms of Σ g ∂g/∂x over the residuals g.
using Gradients = std::map<std::string, Terms>;

/// Adds the terms of one residual: `forms` and `gap` are the blocks of its forms and of g. Gradient servos
/// and rate circuits run down them.
void add_gradients(CircuitWriter& writer, const Residual& residual, const std::vector<std::string>& forms,
                   const std::string& gap, Gradients& gradients);

}  // namespace oblique::patch
