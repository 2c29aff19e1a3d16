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
  /// "warnings"}, and as numbers `rows` rows, the last at the end, with the time and the values of `names`.
  Answer advance(double duration, const std::vector<std::string>& names, int rows);

  /// {"how": "at_once" or "compiled_anew"}.
  Answer turn(const std::string& pot, const std::string& value);
  /// {"units"}, and the values as numbers.
  Answer read(const std::vector<std::string>& names);
  /// {"signals"}, and their values as numbers.
  Answer overloads();
  /// {"events": [{"time", "what"}]}.
  Answer events();

  /// {"state"}: a text with which `restore`, or the program, goes on.
  Answer save();
  Answer restore(const std::string& state);

 private:
  console::Console& held();
  Answer stands();
  Answer set_up();
  diagram::Diagram read_text(const std::string& text, const std::string& name) const;
  bool go(double until, double deadline);

  const Engine& engine_;
  std::shared_ptr<const diagram::BlockLibrary> library_;  ///< of the machine
  std::optional<console::Console> console_;
};

}  // namespace oblique::studio
