// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace oblique::console {

/// What starts a trace of an oscilloscope: a signal that passes a level.
struct Trigger {
  std::string name;  ///< of an output or a signal
  double level = 0;  ///< in its unit
  enum class Slope { rising, falling, either } slope = Slope::rising;
  double hold_off = 0;  ///< [s] after a trace has begun, in which nothing starts another
};

/// What is to be recorded while a machine runs.
struct ProbeSettings {
  std::vector<std::string> names;  ///< of outputs and signals
  /// [s] between the rows of a trace; 0: a row at every step, and where something jumps before and after.
  double interval = 0;
  /// Without one there is a single trace, from where the probe is set.
  std::optional<Trigger> trigger;
  double length = std::numeric_limits<double>::infinity();            ///< [s] of a trace
  std::size_t most_traces = std::numeric_limits<std::size_t>::max();  ///< 1: a single shot
};

/// What was recorded between one trigger and the end of the trace.
struct Trace {
  double begin = 0;                         ///< [s] when it was triggered
  std::vector<double> times;                ///< [s]
  std::vector<std::vector<double>> values;  ///< of each name, one for each time
};

/// A probe of a machine that is held: the oscilloscope. It is shown every smooth piece of the way once, and
/// records from it what it was asked for.
class Probe {
 public:
  Probe(ProbeSettings settings, double now);

  /// Gives the values of all names at a time of the piece, in their order, and that of the trigger.
  using Read = std::function<void(double t, std::vector<double>& values)>;
  /// Looks at the piece from `begin` to `end`, which go on from where the last one ended. `whole`: a step or
  /// an event ends there, not only the way that was asked for.
  void look(double begin, double end, bool whole, const Read& read);
  /// The machine stands at another time now: a new trace begins there, by its trigger if it has one.
  void jump(double now);

  const ProbeSettings& settings() const { return settings_; }
  const std::vector<Trace>& traces() const { return traces_; }
  /// The traces that have ended, which are forgotten: what a screen takes off in every frame.
  std::vector<Trace> take_ended();

 private:
  void begin_trace(double t);
  void record(double begin, double end, bool to_row, const Read& read);
  std::optional<double> triggered(double begin, double end, const Read& read);
  double beyond_level(double t, const Read& read);
  void add_row(double t, const Read& read);

  ProbeSettings settings_;
  std::vector<Trace> traces_;
  bool recording_ = false;              ///< the last of them
  std::size_t begun_ = 0;               ///< traces, those that were taken off too
  std::optional<double> triggered_at_;  ///< [s] the last time
  std::optional<double> last_side_;     ///< of the trigger's signal to its level, where the last piece ended
  std::vector<double> values_;
};

}  // namespace oblique::console
