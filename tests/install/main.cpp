// SPDX-License-Identifier: MIT
// The whole library: x' = -x from x = 1 is exp(-t), run from a text to a number.
#include <cmath>
#include <cstdio>

#include <oblique/diagram/block_library.h>
#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>

int main() {
  const oblique::diagram::Diagram diagram = oblique::diagram::parse_diagram(R"(
format = "oblique-diagram/1"
title = "Decay"
[run]
until = 1
[blocks]
x = { type = "integrator", in = ["-x"], initial = 1 }
)",
                                                                            "decay.toml");
  const oblique::diagram::BlockLibrary library = oblique::diagram::BlockLibrary::shipped();
  const oblique::diagram::FlatDiagram flat = oblique::diagram::flatten(diagram, library);
  const oblique::network::Program program(oblique::network::assemble(flat));
  const oblique::solve::Run run = oblique::solve::run(program, flat, oblique::solve::options_of(diagram.run));
  const double end = run.trajectory.at(run.trajectory.rows() - 1, run.trajectory.find("x").value());
  std::printf("x(1) = %.9f\n", end);
  // The tolerance of the run is 1e-8 a step; over these few steps errors of that size add up to less than
  // 1e-6.
  return std::abs(end - std::exp(-1.0)) < 1e-6 ? 0 : 1;
}
