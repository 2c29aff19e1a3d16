// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <oblique/network/program.h>

namespace oblique {

/// A warning for each loop of elements without memory that has another solution at (t, states) than the one
/// that the workspace holds. Nothing in such a loop says which one is meant: a servo amplifier has its
/// `initial`, and an equation of a block its guess, so loops with these are left out. Sought from points that
/// fill the machine's range evenly; one that lies in no reach of them is not seen. The workspace is as it
/// was.
std::vector<Diagnostic> other_solutions(const Program& program, Workspace& workspace, double t,
                                        const std::vector<double>& states, const std::string& file);

}  // namespace oblique
