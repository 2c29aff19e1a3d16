// SPDX-License-Identifier: MIT
#include <oblique/console/console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/console/carried_state.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/run.h>
#include <oblique/solve/runner.h>

namespace oblique::console {
namespace {

solve::RunOptions options_of(const diagram::RunSettings& settings, double until,
                             std::optional<solve::RunState> from) {
  solve::RunOptions options = solve::options_of(settings);
  options.until = until;
  options.samples = 2;
  options.from = std::move(from);
  return options;
}

/// A diagram with its pots as they are turned, compiled, on its way from a start or a state.
struct Machine {
  std::shared_ptr<const diagram::FlatDiagram> flat;
  std::shared_ptr<const network::Program> program;
  solve::RunOptions options;
  solve::StartChoice start;
  solve::Refinement refinement;
  solve::Runner runner;

  Machine(std::shared_ptr<const diagram::FlatDiagram> flat_diagram,
          std::shared_ptr<const network::Program> compiled, solve::RunOptions how)
      : flat(std::move(flat_diagram)),
        program(std::move(compiled)),
        options(std::move(how)),
        start(solve::start_of(*program, *flat, options)),
        runner(*program, *flat, options, start.from, refinement, false) {
    runner.start();
  }
};

diagram::Phase whole_phase(diagram::OperatingMode mode) {
  diagram::Phase phase;
  phase.mode = mode;
  phase.duration = std::numeric_limits<double>::infinity();
  return phase;
}

/// The modes that a console without a timeline has, each in an endless phase; the first is a run's own.
constexpr diagram::OperatingMode kModes[] = {diagram::OperatingMode::operate, diagram::OperatingMode::initial,
                                             diagram::OperatingMode::hold, diagram::OperatingMode::potset};

}  // namespace

class Console::Held {
 public:
  Held(diagram::Diagram diagram, const diagram::BlockLibrary& library)
      : diagram_(std::move(diagram)),
        library_(library),
        has_timeline_(!diagram_.timeline.phases.empty()),
        horizon_(diagram_.run.until) {
    const Compiled made = compiled(diagram_, overrides_);
    machine_ = std::make_unique<Machine>(made.flat, made.program, options_of(diagram_.run, horizon_, {}));
  }

  double time() const { return time_; }

  void advance(double until) {
    if (!(until >= time_) || !std::isfinite(until)) {
      throw ConsoleError(text::Diagnostic{{diagram_.file, {}},
                                          fmt::format("the machine cannot run until {} s", until),
                                          fmt::format("a time from {} s on, where it stands", time_),
                                          "restore an earlier state to run from there again"});
    }
    known_ = false;
    while (until > machine_->runner.piece_end()) {
      time_ = machine_->runner.piece_end();
      if (std::exchange(looks_ahead_, false)) machine_->runner.pass();
      looks_ahead_ = machine_->runner.look_ahead();
      if (!looks_ahead_) go_on_beyond(until);
    }
    time_ = until;
  }

  Reading read(std::string_view name) {
    for (const diagram::FlatOutput& output : machine_->flat->outputs) {
      if (output.name != name) continue;
      const double signal = signals()[machine_->program->signal_index(output.signal)];
      return {output.scale * signal + output.offset, output.unit};
    }
    if (const auto known = signal_named(name)) return {*known, "machine unit"};
    if (const auto pot = pot_reading(name)) return *pot;
    std::vector<std::string> candidates = output_names();
    const std::vector<std::string>&names = signal_names(), pots = pot_names();
    candidates.insert(candidates.end(), names.begin(), names.end());
    candidates.insert(candidates.end(), pots.begin(), pots.end());
    throw ConsoleError(text::Diagnostic{{diagram_.file, {}},
                                        fmt::format("there is no signal or pot '{}'", name),
                                        "the name of an output, a block, one of its outputs or a parameter",
                                        text::suggest(name, candidates)});
  }

  std::optional<double> signal_named(std::string_view name) {
    const std::vector<std::string>& names = signal_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return signals()[static_cast<std::size_t>(found - names.begin())];
  }

  double signal(std::string_view name) {
    if (const auto known = signal_named(name)) return *known;
    throw ConsoleError(text::Diagnostic{{diagram_.file, {}},
                                        fmt::format("there is no signal '{}'", name),
                                        "the name of a block, or of one of its outputs",
                                        text::suggest(name, signal_names())});
  }

  std::vector<std::string> output_names() const {
    std::vector<std::string> names;
    for (const diagram::FlatOutput& output : machine_->flat->outputs) names.push_back(output.name);
    return names;
  }

  const std::vector<std::string>& signal_names() const { return machine_->program->signal_names(); }

  std::vector<std::string> pot_names() const {
    std::vector<std::string> names;
    for (const diagram::FlatBlock& block : machine_->flat->blocks) {
      for (const auto& parameter : block.definition->parameters)
        names.push_back(fmt::format("{}.{}", block.path, parameter.name));
    }
    return names;
  }

  void turn(const std::string& pot, const std::string& value) {
    std::vector<diagram::ParameterOverride> overrides = overrides_;
    std::erase_if(overrides, [&](const diagram::ParameterOverride& other) { return other.path == pot; });
    overrides.push_back({pot, value});
    go_on_as(diagram_, overrides);
    overrides_ = std::move(overrides);
  }

  void set_mode(diagram::OperatingMode mode) {
    if (has_timeline_) {
      throw ConsoleError(text::Diagnostic{{diagram_.file, {}},
                                          "the timeline of the diagram says which mode is on",
                                          "a diagram without [timeline]",
                                          "remove the timeline to set the modes by hand"});
    }
    const auto phase =
        static_cast<std::size_t>(std::find(std::begin(kModes), std::end(kModes), mode) - std::begin(kModes));
    if (!diagram_.timeline.phases.empty()) {
      solve::RunState state = save();
      state.position.phase = phase;
      return go_on_from(machine_->flat, machine_->program, std::move(state));
    }
    diagram::Diagram with_modes = diagram_;
    for (const diagram::OperatingMode each : kModes) with_modes.timeline.phases.push_back(whole_phase(each));
    go_on_as(with_modes, overrides_, phase);
    diagram_ = std::move(with_modes);
  }

  solve::RunState save() { return machine_->runner.state_at(time_); }

  void restore(const solve::RunState& state) {
    solve::check_run_state(state, *machine_->program, diagram_.file);
    horizon_ = std::max(horizon_, 2 * state.time);
    go_on_from(machine_->flat, machine_->program, state);
  }

  std::vector<solve::EventRecord> events() const {
    std::vector<solve::EventRecord> all = events_;
    const std::vector<solve::EventRecord> now = machine_->runner.events();
    all.insert(all.end(), now.begin(), now.end());
    return all;
  }

  std::vector<text::Diagnostic> warnings() const {
    std::vector<text::Diagnostic> all = warnings_;
    const auto add = [&](const std::vector<text::Diagnostic>& some) {
      all.insert(all.end(), some.begin(), some.end());
    };
    add(machine_->start.warnings);
    add(machine_->runner.warnings());
    add(solve::warnings_of(machine_->runner.unseen(), *machine_->program, *machine_->flat));
    return all;
  }

 private:
  struct Compiled {
    std::shared_ptr<const diagram::FlatDiagram> flat;
    std::shared_ptr<const network::Program> program;
  };

  Compiled compiled(const diagram::Diagram& diagram,
                    const std::vector<diagram::ParameterOverride>& overrides) const {
    auto flat = std::make_shared<const diagram::FlatDiagram>(diagram::flatten(diagram, library_, overrides));
    auto program = std::make_shared<const network::Program>(network::assemble(*flat));
    return {std::move(flat), std::move(program)};
  }

  const std::vector<double>& signals() {
    if (!known_) machine_->runner.signals_at(time_, signals_);
    known_ = true;
    return signals_;
  }

  std::optional<Reading> pot_reading(std::string_view name) const {
    const std::size_t dot = name.rfind('.');
    if (dot == std::string_view::npos) return std::nullopt;
    for (const diagram::FlatBlock& block : machine_->flat->blocks) {
      if (block.path != name.substr(0, dot)) continue;
      const auto parameter = block.definition->find_parameter(name.substr(dot + 1));
      if (parameter)
        return Reading{block.parameters[*parameter], block.definition->parameters[*parameter].unit};
    }
    return std::nullopt;
  }

  /// Goes on from the present state as another diagram, in a phase of its timeline if one is given.
  void go_on_as(const diagram::Diagram& diagram, const std::vector<diagram::ParameterOverride>& overrides,
                std::optional<std::size_t> phase = {}) {
    const Compiled made = compiled(diagram, overrides);
    solve::RunState state = carried_state(save(), *machine_->program, signals(), *made.program);
    if (phase) state.position.phase = *phase;
    go_on_from(made.flat, made.program, std::move(state));
  }

  void go_on_from(std::shared_ptr<const diagram::FlatDiagram> flat,
                  std::shared_ptr<const network::Program> program, solve::RunState state) {
    const double from = state.time;
    if (!(horizon_ > from)) horizon_ = 2 * from;
    auto next = std::make_unique<Machine>(std::move(flat), std::move(program),
                                          options_of(diagram_.run, horizon_, std::move(state)));
    events_ = events();
    warnings_ = warnings();
    machine_ = std::move(next);
    time_ = from;
    looks_ahead_ = known_ = false;
  }

  /// The run has come to its end, and is gone on with.
  void go_on_beyond(double until) {
    time_ = machine_->runner.piece_end();
    horizon_ = std::max(2 * horizon_, until);
    go_on_from(machine_->flat, machine_->program, save());
  }

  diagram::Diagram diagram_;
  const diagram::BlockLibrary& library_;
  std::vector<diagram::ParameterOverride> overrides_;
  bool has_timeline_;
  double horizon_, time_ = 0;  ///< [s]
  std::unique_ptr<Machine> machine_;
  bool looks_ahead_ = false;  ///< whether a piece was looked at that has not been passed
  std::vector<double> signals_;
  bool known_ = false;                      ///< whether these are those at `time_`
  std::vector<solve::EventRecord> events_;  ///< of the machines before
  std::vector<text::Diagnostic> warnings_;
};

Console::Console(diagram::Diagram diagram, const diagram::BlockLibrary& library)
    : held_(std::make_unique<Held>(std::move(diagram), library)) {}
Console::Console(Console&&) noexcept = default;
Console& Console::operator=(Console&&) noexcept = default;
Console::~Console() = default;

double Console::time() const {
  return held_->time();
}
void Console::advance(double until) {
  held_->advance(until);
}
Console::Reading Console::read(std::string_view name) const {
  return held_->read(name);
}
double Console::signal(std::string_view name) const {
  return held_->signal(name);
}
std::vector<std::string> Console::output_names() const {
  return held_->output_names();
}
std::vector<std::string> Console::signal_names() const {
  return held_->signal_names();
}
std::vector<std::string> Console::pot_names() const {
  return held_->pot_names();
}
void Console::turn(const std::string& pot, const std::string& value) {
  held_->turn(pot, value);
}
void Console::set_mode(diagram::OperatingMode mode) {
  held_->set_mode(mode);
}
solve::RunState Console::save() const {
  return held_->save();
}
void Console::restore(const solve::RunState& state) {
  held_->restore(state);
}
std::vector<solve::EventRecord> Console::events() const {
  return held_->events();
}
std::vector<text::Diagnostic> Console::warnings() const {
  return held_->warnings();
}

}  // namespace oblique::console
