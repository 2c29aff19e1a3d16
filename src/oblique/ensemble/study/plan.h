// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <oblique/text/diagnostic.h>

namespace oblique::ensemble {

/// How the values of the varied names are chosen: all combinations, the last name fastest; or `runs` points
/// between the bounds of each.
enum class Sampling { grid, latin_hypercube, sobol };

/// A name of the file ("c.gain", "c.in[2]"; of a mechanism "crank.length") and its values as they were
/// written: "1,2,5", "1e2..1e6:41:log".
struct Variation {
  std::string name;
  std::string values;
  text::Place place;
};

/// Parameters that every machine draws: the given one of each block of a type, uniform within ± half width.
struct Scattered {
  std::string block;      ///< "multiplier"
  std::string parameter;  ///< "error"
  double half_width = 0;  ///< in the parameter's unit; never a part of its value
  text::Place place;
  bool in_percent = false;  ///< written so: of 1, which of a parameter beyond 1 is hardly meant
};

/// A number of each run: "max(abs(side - exact))".
struct Measure {
  std::string name;  ///< the head of its column
  std::string expression;
  text::Place place;
};

/// Everything that defines an ensemble. The same plan gives the same numbers, whatever the lanes, threads,
/// machines and order.
struct Plan {
  std::string file;        ///< of the plan itself; empty where it is made of options
  std::string subject;     ///< path of the diagram or mechanism
  bool mechanism = false;  ///< the subject is one
  /// Of a grid: so many machines a combination, where elements scatter (else 1, and it may not be given).
  /// Otherwise: so many altogether, and it must be given.
  std::optional<std::uint64_t> runs;
  std::uint64_t seed = 1;
  Sampling sampling = Sampling::grid;
  std::vector<Variation> vary;
  std::vector<Scattered> scatter;
  double tolerance_of_elements = 0;  ///< scatter of all elements that are made to a tolerance; 0: none
  std::string machine;               ///< whose figures scatter; empty: none
  std::vector<Measure> measures;
  std::optional<double> tolerance;  ///< of each run, relative; else that of the subject
  std::optional<int> samples;       ///< rows of each run
  // of a mechanism
  std::optional<double> gain;         ///< of its servo loops
  std::optional<std::string> method;  ///< "triangles", "gradient"
};

}  // namespace oblique::ensemble
