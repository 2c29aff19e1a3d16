// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/chart/chart.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/stability/linearisation.h>

namespace oblique::report {

/// The eigenvalues of a diagram in the complex plane at these instants of its run: those of the modes that
/// come from the machine apart from those of the problem (see IdealMachine), each kind to its own scale.
/// Groups of more than 200 states that act on each other are left out: of these `check` finds the rightmost.
draw::Chart pole_chart(const diagram::FlatDiagram& diagram, const network::Program& program,
                       const std::vector<solve::Instant>& instants, const std::string& title);

}  // namespace oblique::report
