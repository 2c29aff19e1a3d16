// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <oblique/console/console.h>

#include "studio/engine/answer.h"
#include "studio/engine/engine.h"

namespace oblique::studio {

/// A machine that a page holds (console::Console): as its functions, and as those of Engine throws nothing.
/// Before `open` has succeeded every function refuses.
class LiveConsole {
 public:
  /// The engine must outlive it.
  explicit LiveConsole(const Engine& engine) : engine_(engine) {}

  /// A machine of this diagram, at t = 0, in place of the one before; where that fails the one before stays:
  /// {"time", "outputs", "signals", "pots"}.
  Answer open(const std::string& text, const std::string& name);

  /// "potset", "initial", "operate" or "hold": {"time"}.
  Answer set_mode(const std::string& mode);
  /// Initial condition for so long, then operation, and again [s]: {"time"}.
  Answer repeat(double initial, double operate);

  /// Goes on by so much [s], or as far as it comes in the engine's time: {"time", "complete", "rows",
  /// "seconds" of ours, "warnings"}, and as numbers `rows` rows, the last at the end, with the time and the values of `names`.
  Answer advance(double duration, const std::vector<std::string>& names, int rows);

  /// {"how": "at_once" or "compiled_anew"}.
  Answer turn(const std::string& pot, const std::string& value);
  /// {"units"}, and the values as numbers.
  Answer read(const std::vector<std::string>& names);
  /// The values of all signals as numbers, in the order in which `open` has named them [machine unit].
  Answer signals();
  /// Of those beyond 1 machine unit: {"signals"}, and their values as numbers.
  Answer overloads();
  /// {"events": [{"time", "what"}]}.
  Answer events();

  /// Records these signals and outputs from now on (console::Probe): {"probe"}, its number. Options:
  /// "interval" [s], "length" [s], "trigger", the name of a signal or an output, with "level", "slope"
  /// ("rising", "falling", "either") and "hold_off" [s], and "most", how many traces. A probe ends with its
  /// machine.
  Answer set_probe(const std::vector<std::string>& names, const std::string& options);
  /// What it has recorded since it was last asked: {"traces": [{"begin", "rows", "ended"}]}, and the rows of
  /// all as numbers, the time first. One that has not ended is given again, as far as it is.
  Answer take_traces(double probe);
  /// Takes a probe away.
  Answer remove_probe(double probe);

  /// {"state"}: a text with which `restore`, or the program, goes on.
  Answer save();
  Answer restore(const std::string& state);

 private:
  console::Console& held();
  Answer stands();
  bool go(double until, double deadline);

  const Engine& engine_;
  std::shared_ptr<const diagram::BlockLibrary> library_;  ///< of the machine
  std::optional<console::Console> console_;
};

}  // namespace oblique::studio
