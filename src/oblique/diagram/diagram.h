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
  enum class Kind {
    at_time,
    maximum,
    minimum,
    /// [s], the mean time from rise to rise through the middle between the extremes, over the second half of
    /// the run, or all of it where that is too short
    period,
  };
  std::string text;  ///< the key as written, "side at pi"
  std::string output;
  Kind kind = Kind::at_time;
  double time = 0;  ///< [s], for `at_time`
  double value = 0;
  double within = 0;
  text::Place place;
  bool operator==(const Expectation& other) const;  ///< without places
};

/// A parameter to replace, by path, or the weight of a wire; the value is a quantity in the parameter's unit.
struct ParameterOverride {
  std::string path;  ///< "block.parameter", "block.input[2]" or "block.input[signal]"
  std::string value;
  text::Place place = {};  ///< where a file has it; without a file it is a setting of the caller
  bool operator==(const ParameterOverride& other) const;  ///< without places
};

/// A result as it was published; a run is held against it as against an expectation.
struct PublishedValue {
  Expectation expected;  ///< `value` and `within` in `unit`; `within` is the uncertainty that was stated
  std::string label;     ///< what people call it; empty: the text of `expected`
  std::string unit;      ///< in which it was published; empty: that of the output
  double factor = 1;     ///< what one of `unit` is in the unit of the output
  std::vector<ParameterOverride> set;  ///< what is set for it, in a run of its own; empty: nothing
  std::string because;                 ///< why the run differs from it by more than `within`
  std::string tried;                   ///< what was tried to explain that, where nothing did
  bool operator==(const PublishedValue&) const = default;
};

/// Where a programme was published, and what was published of it.
struct Published {
  enum class Kind {
    programme,  ///< the circuit as it was patched
    equations,  ///< equations alone: the circuit is composed here
  };
  Kind kind = Kind::programme;
  std::string author;
  std::string title;
  std::string in;  ///< the journal, book or series
  std::optional<int> year;
  std::string number;   ///< in the series
  std::string page;     ///< or pages
  std::string address;  ///< where it can be read
  std::string machine;  ///< on which it ran
  std::string subject;  ///< the field that its problem belongs to
  std::string picture;  ///< what a published picture shows
  bool leads = false;   ///< whether lists begin with it
  std::vector<std::string>
      plot;  ///< outputs as on the plotter: the last is the horizontal axis; empty: `t` is
  std::vector<std::string> errata;
  std::vector<PublishedValue> values;
  text::Place place;
  bool operator==(const Published& other) const;  ///< without places
};

/// Something to change in a lesson's diagram as it is shipped, and what is then to be seen.
struct LessonStep {
  std::string action;  ///< in words; `do` in the file
  std::string guess;   ///< what to ask oneself before it is done
  std::vector<ParameterOverride> set;
  std::string see;  ///< in words
  std::vector<Expectation> expectations;
  bool operator==(const LessonStep&) const = default;
};

/// A question that is answered by setting a parameter: right where the run then gives what is expected.
struct LessonQuestion {
  std::string ask;
  std::string answer;  ///< the parameter, by path
  std::string hint;    ///< for who answers it wrongly
  std::vector<Expectation> expectations;
  text::Place place;
  bool operator==(const LessonQuestion& other) const;  ///< without places
};

/// What a diagram is to teach.
struct Lesson {
  std::string title;
  std::string text;  ///< paragraphs before the first step
  std::vector<LessonStep> steps;
  std::optional<LessonQuestion> question;
  bool operator==(const Lesson&) const = default;
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
  std::optional<Published> published;
  std::optional<Lesson> lesson;
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
