// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/block_definition.h>

namespace oblique::diagram {

/// Thrown by the `diagram` stage: a block or diagram file that is wrong, or wiring that is.
class DiagramError : public text::Error {
 public:
  using text::Error::Error;
};

/// The machine a diagram is for.
struct MachineSettings {
  std::string profile = "ideal";
  bool inverting = false;  ///< summers and integrators invert
  bool operator==(const MachineSettings&) const = default;
};

/// The family of formulas with which a diagram is integrated.
enum class IntegrationMethod {
  automatic,  ///< chosen for the diagram; the run says which and why
  bdf,        ///< backward differentiation: for servo loops and everything that holds fast decays
  adams,      ///< Adams-Moulton: for oscillators, whose amplitude it keeps better
  rodas,      ///< Rodas5P, linearly implicit: for fast decays too; keeps nothing of the steps before
};
inline constexpr IntegrationMethod kIntegrationMethods[] = {
    IntegrationMethod::automatic, IntegrationMethod::bdf, IntegrationMethod::adams, IntegrationMethod::rodas};

/// "auto", "bdf", "adams", "rodas".
std::string_view method_name(IntegrationMethod method);

/// How a diagram is run unless the request says otherwise.
struct RunSettings {
  double until = 1;         ///< end of the run [s]
  double tolerance = 1e-8;  ///< of the solver, relative
  IntegrationMethod method = IntegrationMethod::automatic;
  int samples = 1001;                   ///< rows of the trajectory, both ends included
  std::int64_t max_steps = 10'000'000;  ///< of the solver, over the whole run
  bool settle = true;                   ///< servo loops are brought to rest before the clock starts
  /// Absolute tolerances of single states [machine unit]: of a block (a composite stands for all in it) by
  /// its path.
  std::vector<std::pair<std::string, double>> tolerances;
  std::optional<double>
      absolute_tolerance;          ///< [machine unit] of all other states; else it follows `tolerance`
  std::optional<double> max_step;  ///< [s] the longest step of the run
  bool operator==(const RunSettings&) const = default;
};

/// A column of the trajectory: `scale` · signal + `offset`, in `unit`.
struct OutputSpec {
  std::string name;
  std::string signal;
  double scale = 1;
  std::string unit = "machine unit";
  text::Place place;
  double offset = 0;                               ///< in `unit`
  bool operator==(const OutputSpec& other) const;  ///< without places
};

/// What a diagram is known to give: an output at a time, or its extreme over the run.
struct Expectation {
  enum class Kind { at_time, maximum, minimum };
  std::string text;  ///< the key as written, "side at pi"
  std::string output;
  Kind kind = Kind::at_time;
  double time = 0;  ///< [s], for `at_time`
  double value = 0;
  double within = 0;
  text::Place place;
  bool operator==(const Expectation& other) const;  ///< without places
};

/// Mode of operation of integrators. Setting the potentiometers, the machine holds its initial condition.
enum class OperatingMode { potset, initial, operate, hold };

/// "potset", "initial", "operate", "hold".
std::string_view mode_name(OperatingMode mode);

/// Integrators (and whatever else knows modes) with a mode line of their own.
struct ModeGroup {
  std::string name;
  std::vector<std::string> blocks;  ///< paths; a composite stands for all in it
  std::string initial;              ///< a signal: above 0.5 it holds the group in initial condition
  std::string hold;                 ///< a signal: above 0.5 it holds the group
  text::Place place;
  bool operator==(const ModeGroup& other) const;  ///< without places
};

/// A part of the run in which every group keeps its mode.
struct Phase {
  OperatingMode mode = OperatingMode::operate;  ///< of all that `modes` does not name
  std::vector<std::pair<std::string, OperatingMode>> modes;
  double duration = 0;  ///< [s] at most; infinite where only `until` ends it
  std::string until;    ///< "signal > number" or "signal < number" that ends it earlier, or empty
  text::Place place;
  bool operator==(const Phase& other) const;  ///< without places
};

/// The phases of a run, one after the other; the last stays until the run ends.
struct Timeline {
  std::vector<Phase> phases;
  double cycles = 1;  ///< how often they are gone through
  bool operator==(const Timeline&) const = default;
};

/// A block diagram as its file has it (oblique-diagram/1).
struct Diagram {
  std::string file;
  std::string title;
  std::string source;
  std::string comment;  ///< lines that `write_diagram` puts at the head
  MachineSettings machine;
  RunSettings run;
  std::vector<ModeGroup> groups;
  Timeline timeline;  ///< without phases: the whole run is one phase "operate"
  std::vector<BlockInstance> blocks;
  std::vector<OutputSpec> outputs;
  std::vector<Expectation> expectations;
  std::vector<BlockPlace> layout;  ///< of the blocks whose place the drawing is not to choose

  bool operator==(const Diagram& other) const;  ///< without file, places and comments
};

/// Whether the expressions keep this name for themselves, so that no block can have it: `time`, `pi`, `or` …
bool is_reserved(std::string_view name);

/// Builds the value of a `settings` entry: a number, a signal, a list of weighted signals, points.
text::Entry number_setting(std::string key, double value);
text::Entry text_setting(std::string key, std::string text);
text::Entry points_setting(std::string key, const text::PointTable& points);
struct WeightedSignal {
  double weight = 1;
  std::string signal;
};
/// "2*abc", "-a2": one signal with its weight, as a file writes it.
std::string to_string(const WeightedSignal& term);
text::Entry wire_setting(std::string key, const std::vector<WeightedSignal>& terms);

}  // namespace oblique::diagram
