// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <oblique/draw/chart.h>
#include <oblique/network/program.h>
#include <oblique/solve/linearisation.h>

namespace oblique::cli {

/// The eigenvalues of a diagram in the complex plane at these instants of its run: those of the modes in
/// which servo amplifiers have the greater share apart from those of the problem, each kind to its own scale.
/// Groups of more than 200 states that act on each other are left out, as `check` does.
Chart pole_chart(const Program& program, const std::vector<Instant>& instants, const std::string& title);

}  // namespace oblique::cli
