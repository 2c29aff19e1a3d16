// SPDX-License-Identifier: MIT
#pragma once

#include <numbers>
#include <string>

#include <fmt/format.h>

#include <oblique/mechanism/analysis/analysis.h>
#include <oblique/mechanism/structure/structure.h>

#include "mechanism_text.h"

// The mechanisms that the tests of their analysis share.
namespace oblique::mechanism::analysed {

inline constexpr double kPi = std::numbers::pi;
/// Zeros of a rate are found to the last bits of the place; their times carry a few roundings more.
inline constexpr double kExact = 1e-9;

inline MechanismAnalysis analysis_of(const Mechanism& mechanism) {
  return analyse(mechanism, decompose(mechanism));
}

inline Mechanism four_bar(double crank, double coupler, double rocker, double frame,
                          const std::string& start = "0 deg", const std::string& sketch = "[3, 3]") {
  return mechanism(fmt::format(R"([frame]
A = [0, 0]
D = [{}, 0]
[bodies]
AB = {{ points = ["A", "B"], length = {} }}
BC = {{ points = ["B", "C"], length = {} }}
CD = {{ points = ["C", "D"], length = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = 1, start = "{}" }}
[sketch]
C = {}
)",
                               frame, crank, coupler, rocker, start, sketch));
}

/// r = 50, l = 150; masses of crank and rod.
inline Mechanism slider_crank(double offset, const std::string& speed = "1 rad/s") {
  return mechanism(fmt::format(R"([units]
length = "mm"
[frame]
A = [0, 0]
X = [250, 0]
[bodies]
AB = {{ points = ["A", "B"], length = 50, mass = 0.4, width = 10 }}
BC = {{ points = ["B", "C"], length = 150, mass = 0.9 }}
[slides]
piston = {{ point = "C", along = ["A", "X"], offset = {} }}
[drives]
crank = {{ turns = "AB", about = "A", speed = "{}" }}
[sketch]
C = [190, 40]
)",
                               offset, speed));
}

}  // namespace oblique::mechanism::analysed
