// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <oblique/solve/run_records.h>
#include <oblique/text/diagnostic.h>

namespace oblique::network {
class Program;
}

namespace oblique::solve {

/// All that a run needs to be gone on with: the solver's own past is not kept, so that what follows agrees
/// with an uninterrupted run to the solver's tolerance.
struct RunState {
  double time = 0;  ///< [s]
  using Named = std::vector<std::pair<std::string, double>>;
  Named states;
  Named unknowns;  ///< of algebraic loops: where the next search begins
  Named memories;
  std::vector<bool> conditions;  ///< of events, in the program's order
  /// Of each switch, in the program's order, whether it slides or rests at zero along with what does. Empty
  /// where that is not known.
  std::vector<bool> sliding;
  PhasePosition position;
  /// Pots may have been turned since: what the mode of a group has put somewhere is put there anew. (Not in
  /// the file.)
  bool turned = false;
};

/// The text of a state file (oblique-state/1); `parse_run_state` gives the same numbers back.
std::string to_text(const RunState& state);

/// Throws ReadError for what is no state file.
RunState parse_run_state(std::string_view text, const std::string& file);

/// Whether the state is one of this program: throws ReadError where names differ, with the first that do.
void check_run_state(const RunState& state, const network::Program& program, const std::string& file);

}  // namespace oblique::solve
