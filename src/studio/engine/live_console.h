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

  /// Another diagram in place of the one that runs, at its time (console::Console::exchange). `renamed` is a
  /// JSON list of [before, now]: {"time", "outputs", "signals", "pots", "turned": {pot: value}}.
  Answer exchange(const std::string& text, const std::string& name, const std::string& renamed);

  /// "potset", "initial", "operate" or "hold": {"time"}.
  Answer set_mode(const std::string& mode);
  /// Initial condition for so long, then operation, and again [s]: {"time"}.
  Answer repeat(double initial, double operate);

  /// Goes on by so much [s], or as far as it comes in the engine's time: {"time", "complete", "rows",
  /// "seconds" of ours, "warnings"}, and as numbers `rows` rows, the last at the end, with the time and the
  /// values of `names`.
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
  /// The outputs of these names, in their units; nothing where the machine has not all of them. Throws where
  /// no machine is held.
  std::optional<std::vector<double>> outputs(const std::vector<std::string>& names);
  /// For how long it has been in operation since it was in initial condition [s].
  double time_of_operation() const;

  /// {"state"}: a text with which `restore`, or the program, goes on.
  Answer save();
  Answer restore(const std::string& state);

 private:
  console::Console& held();
  Answer stands();
  Answer set_up();
  diagram::Diagram read_text(const std::string& text, const std::string& name) const;
  bool go(double until, double deadline);
  void begin(diagram::OperatingMode mode, double operated);

  const Engine& engine_;
  std::shared_ptr<const diagram::BlockLibrary> library_;  ///< of the machine
  std::optional<console::Console> console_;
  diagram::OperatingMode mode_ = diagram::OperatingMode::operate;
  double operated_ = 0;  ///< until the mode was set [s]
  double since_ = 0;     ///< the time at which that was [s]
  struct Repetition {
    double initial = 0, operate = 0;  ///< [s]
  };
  std::optional<Repetition> repetition_;
};

}  // namespace oblique::studio
