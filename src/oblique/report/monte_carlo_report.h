// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include <nlohmann/json_fwd.hpp>

#include <oblique/compare/monte_carlo.h>

namespace oblique::report {

/// What was drawn, for people and with its words.
struct MonteCarloReport {
  compare::MonteCarloOptions options;
  compare::MonteCarlo result;
  std::string unit;                                   ///< of lengths
  std::string machine;                                ///< whose elements scatter; empty: by --tolerance
  std::string tolerance;                              ///< as --tolerance has it
  double size = 0;                                    ///< the largest link [length unit]
  std::vector<std::pair<std::string, double>> draws;  ///< "C.cx.tolerance" and its value, of a single run
  double seconds = 0;
};

std::string to_text(const MonteCarloReport& report,
                    const text::Vocabulary& vocabulary = text::plain_vocabulary());

/// The same for `--json` (docs/trust.md), with or without the seconds that were measured.
nlohmann::ordered_json to_json(const MonteCarloReport& report, bool timings);

}  // namespace oblique::report
