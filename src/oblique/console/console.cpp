// SPDX-License-Identifier: MIT
#include <oblique/console/console.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/console/carried_state.h>
#include <oblique/console/pots.h>
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

diagram::Timeline modes_by_hand() {
  diagram::Timeline timeline;
  for (const diagram::OperatingMode each : kModes) timeline.phases.push_back(whole_phase(each));
  return timeline;
}

solve::PhasePosition position_in(diagram::OperatingMode mode) {
  solve::PhasePosition position;
  position.phase =
      static_cast<std::size_t>(std::find(std::begin(kModes), std::end(kModes), mode) - std::begin(kModes));
  return position;
}

/// Modes that were set by hand are in a state that was saved then: sets those of a machine so that it has
/// them too, and none where the state knows of none.
void take_modes_of(solve::RunState& state, Pots& pots) {
  const auto known = std::find_if(state.memories.begin(), state.memories.end(), [](const auto& memory) {
    return memory.first.starts_with("mode of group ");
  });
  const std::vector<diagram::Phase>& phases = pots.diagram().timeline.phases;
  if (known == state.memories.end()) {
    if (!phases.empty()) pots.set_timeline({});
    return;
  }
  const auto mode = static_cast<diagram::OperatingMode>(static_cast<int>(known->second));
  if (state.position.phase < phases.size() && phases[state.position.phase].mode == mode) return;
  pots.set_timeline(modes_by_hand());
  state.position = position_in(mode);
}

}  // namespace

class Console::Held {
 public:
  Held(diagram::Diagram diagram, const diagram::BlockLibrary& library)
      : pots_(std::move(diagram), library),
        has_timeline_(!pots_.diagram().timeline.phases.empty()),
        horizon_(pots_.diagram().run.until),
        machine_(std::make_unique<Machine>(pots_.flat(), pots_.program(),
                                           options_of(pots_.diagram().run, horizon_, {}))) {}

  double time() const { return time_; }

  void advance(double until) {
    if (!(until >= time_) || !std::isfinite(until)) {
      throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                          fmt::format("the machine cannot run until {} s", until),
                                          fmt::format("a time from {} s on, where it stands", time_),
                                          "restore an earlier state to run from there again"});
    }
    take_turned_pots();
    known_ = false;
    while (until > machine_->runner.piece_end()) {
      show_probes(machine_->runner.piece_end());
      time_ = machine_->runner.piece_end();
      if (std::exchange(looks_ahead_, false)) machine_->runner.pass();
      looks_ahead_ = machine_->runner.look_ahead();
      if (!looks_ahead_) go_on_beyond(until);
    }
    show_probes(until);
    time_ = until;
  }

  Reading read(std::string_view name) {
    if (const auto channel = channel_of(name)) return {channel->value(signals()), channel->unit};
    if (const auto pot = pots_.setting_of(name)) return {pot->value, pot->unit};
    std::vector<std::string> candidates = output_names();
    const std::vector<std::string>&names = signal_names(), pots = pots_.names();
    candidates.insert(candidates.end(), names.begin(), names.end());
    candidates.insert(candidates.end(), pots.begin(), pots.end());
    throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                        fmt::format("there is no signal or pot '{}'", name),
                                        "the name of an output, a block, one of its outputs or a parameter",
                                        text::suggest(name, candidates)});
  }

  double signal(std::string_view name) {
    const std::vector<std::string>& names = signal_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found != names.end()) return signals()[static_cast<std::size_t>(found - names.begin())];
    throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                        fmt::format("there is no signal '{}'", name),
                                        "the name of a block, or of one of its outputs",
                                        text::suggest(name, signal_names())});
  }

  const std::vector<double>& signals() {
    take_turned_pots();
    if (!known_) machine_->runner.signals_at(time_, signals_);
    known_ = true;
    return signals_;
  }

  std::vector<std::string> output_names() const {
    std::vector<std::string> names;
    for (const diagram::FlatOutput& output : pots_.flat()->outputs) names.push_back(output.name);
    return names;
  }

  const std::vector<std::string>& signal_names() { return pots_.program()->signal_names(); }

  Pots& pots() { return pots_; }

  std::vector<Overload> overloads() {
    std::vector<Overload> lit;
    const std::vector<double>& values = signals();
    for (std::size_t s = 0; s < values.size(); ++s) {
      if (std::abs(values[s]) > 1) lit.push_back({signal_names()[s], values[s]});
    }
    return lit;
  }

  std::size_t set_probe(ProbeSettings settings) {
    SetProbe made;
    for (const std::string& name : settings.names) made.channels.push_back(known_channel(name));
    if (settings.names.empty()) refuse_probe("it has no names", "at least one");
    if (!(settings.interval >= 0)) refuse_probe("its interval is no time", "0 or more seconds");
    if (!(settings.length > 0)) refuse_probe("its traces have no length", "more than 0 seconds");
    if (const auto& trigger = settings.trigger) {
      made.channels.push_back(known_channel(trigger->name));
      if (!std::isfinite(trigger->level)) refuse_probe("its level is no number", "a finite number");
      if (!(trigger->hold_off >= 0)) refuse_probe("its hold-off is no time", "0 or more seconds");
    }
    take_turned_pots();
    made.probe = std::make_unique<Probe>(std::move(settings), time_);
    probes_.push_back(std::move(made));
    show_probe(probes_.back(), time_);
    return probes_.size() - 1;
  }

  const std::vector<Trace>& traces(std::size_t number) const { return probe(number).probe->traces(); }

  std::vector<Trace> take_traces(std::size_t number) {
    probe(number);
    return probes_[number].probe->take_ended();
  }

  void remove_probe(std::size_t number) {
    probe(number);
    probes_[number].probe.reset();
  }

  std::vector<diagram::ParameterOverride> exchange(diagram::Diagram diagram,
                                                   const diagram::BlockLibrary& library,
                                                   const Renamed& renamed) {
    if (!has_timeline_ && diagram.timeline.phases.empty()) {
      diagram.timeline = pots_.diagram().timeline;  // the mode that is set
    } else if (diagram.timeline != pots_.diagram().timeline || diagram.groups != pots_.diagram().groups) {
      throw ConsoleError(text::Diagnostic{{diagram.file, {}},
                                          "the timeline of the diagram is another one",
                                          "the one with which the machine runs",
                                          "begin again with the new one"});
    }
    const solve::RunState state = save();
    std::vector<diagram::ParameterOverride> kept = kept_pots(diagram, renamed);
    Pots next(std::move(diagram), library, kept);
    go_on(next, carried_state(state, *pots_.program(), signals(), *next.program(), renamed));
    pots_ = std::move(next);
    for (SetProbe& set : probes_) {
      if (set.probe) find_channels_again(set);
    }
    return kept;
  }

  void set_mode(diagram::OperatingMode mode) {
    refuse_with_timeline();
    go_through(modes_by_hand(), position_in(mode));
  }

  void repeat(double initial, double operate) {
    refuse_with_timeline();
    for (const double duration : {initial, operate}) {
      if (duration > 0 && std::isfinite(duration)) continue;
      throw ConsoleError(
          text::Diagnostic{{pots_.diagram().file, {}},
                           fmt::format("the machine cannot repeat with a phase of {} s", duration),
                           "two times above 0: in initial condition, and in operation",
                           {}});
    }
    diagram::Timeline timeline;
    timeline.phases = {whole_phase(diagram::OperatingMode::initial),
                       whole_phase(diagram::OperatingMode::operate)};
    timeline.phases[0].duration = initial;
    timeline.phases[1].duration = operate;
    timeline.cycles = std::numeric_limits<double>::infinity();
    go_through(std::move(timeline), {0, 0, time_});
  }

  solve::RunState save() {
    take_turned_pots();
    return machine_->runner.state_at(time_);
  }

  void restore(solve::RunState state) {
    Pots pots = pots_;
    if (!has_timeline_) take_modes_of(state, pots);
    solve::check_run_state(state, *pots.program(), pots.diagram().file);
    horizon_ = std::max(horizon_, 2 * state.time);
    go_on(pots, std::move(state));
    pots_ = std::move(pots);
    for (const SetProbe& set : probes_) {
      if (set.probe) set.probe->jump(time_);
    }
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
  /// An output or a signal as it is read.
  struct Channel {
    std::size_t signal = 0;
    double scale = 1, offset = 0;
    std::string unit;

    double value(const std::vector<double>& signals) const { return scale * signals[signal] + offset; }
  };
  struct SetProbe {
    std::vector<Channel> channels;  ///< of its names and, at the end, of its trigger
    std::unique_ptr<Probe> probe;   ///< none once it is taken away
  };

  std::optional<Channel> channel_of(std::string_view name) {
    for (const diagram::FlatOutput& output : pots_.flat()->outputs) {
      if (output.name == name)
        return Channel{pots_.program()->signal_index(output.signal), output.scale, output.offset,
                       output.unit};
    }
    const std::vector<std::string>& names = signal_names();
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) return std::nullopt;
    return Channel{static_cast<std::size_t>(found - names.begin()), 1, 0, "machine unit"};
  }

  Channel known_channel(std::string_view name) {
    if (auto channel = channel_of(name)) return *channel;
    std::vector<std::string> candidates = output_names();
    for (const std::string& signal : signal_names()) {
      if (std::find(candidates.begin(), candidates.end(), signal) == candidates.end())
        candidates.push_back(signal);
    }
    throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                        fmt::format("there is no signal '{}' for a probe", name),
                                        "the name of an output, a block or one of its outputs",
                                        text::suggest(name, candidates)});
  }

  /// The pots that are turned and of which another diagram says the same.
  std::vector<diagram::ParameterOverride> kept_pots(const diagram::Diagram& next,
                                                    const Renamed& renamed) const {
    std::vector<diagram::ParameterOverride> kept;
    for (const diagram::BlockInstance& now : next.blocks) {
      const std::string name = path_before(now.name, renamed);
      const auto& blocks = pots_.diagram().blocks;
      const auto before = std::find_if(
          blocks.begin(), blocks.end(),
          [&](const diagram::BlockInstance& block) { return block.name == name && block.type == now.type; });
      if (before == blocks.end()) continue;
      for (const diagram::ParameterOverride& turned : pots_.turned()) {
        if (!turned.path.starts_with(name + ".")) continue;
        const std::string pot = turned.path.substr(name.size() + 1);
        if (says_the_same(*before, now, pot)) kept.push_back({now.name + "." + pot, turned.value});
      }
    }
    return kept;
  }

  /// Whether two files say the same of a parameter of a block; of a weight or of what is inside, of the
  /// whole.
  static bool says_the_same(const diagram::BlockInstance& before, const diagram::BlockInstance& now,
                            const std::string& pot) {
    const auto said = [&](const diagram::BlockInstance& block) {
      diagram::BlockInstance part;
      const bool is_parameter = pot.find_first_of(".[") == std::string::npos;
      for (const text::Entry& setting : block.settings) {
        if (!is_parameter || setting.key == pot) part.settings.push_back(setting);
      }
      return part;
    };
    return said(before) == said(now);
  }

  /// Of a machine in which signals stand elsewhere.
  void find_channels_again(SetProbe& set) {
    const ProbeSettings& settings = set.probe->settings();
    std::vector<std::string> names = settings.names;
    if (settings.trigger) names.push_back(settings.trigger->name);
    set.channels.clear();
    for (const std::string& name : names) {
      if (auto channel = channel_of(name)) {
        set.channels.push_back(*channel);
      } else {
        set.probe.reset();
        return;
      }
    }
  }

  [[noreturn]] void refuse_probe(const std::string& what, const std::string& expected) const {
    throw ConsoleError(
        text::Diagnostic{{pots_.diagram().file, {}}, "a probe cannot be set: " + what, expected, {}});
  }

  const SetProbe& probe(std::size_t number) const {
    if (number < probes_.size() && probes_[number].probe) return probes_[number];
    throw ConsoleError(
        text::Diagnostic{{pots_.diagram().file, {}},
                         fmt::format("there is no probe number {}", number),
                         "a number that 'set_probe' has given, of a probe that is not taken away",
                         {}});
  }

  /// Shows the probes what the machine does from where it stands until `end`, within one piece.
  void show_probes(double end) {
    for (const SetProbe& set : probes_) {
      if (set.probe) show_probe(set, end);
    }
  }

  void show_probe(const SetProbe& set, double end) {
    set.probe->look(time_, end, end == machine_->runner.piece_end(),
                    [&](double t, std::vector<double>& values) {
                      machine_->runner.signals_at(t, probed_);
                      values.clear();
                      for (const Channel& channel : set.channels) values.push_back(channel.value(probed_));
                    });
  }

  void refuse_with_timeline() const {
    if (!has_timeline_) return;
    throw ConsoleError(text::Diagnostic{{pots_.diagram().file, {}},
                                        "the timeline of the diagram says which mode is on",
                                        "a diagram without [timeline]",
                                        "remove the timeline to set the modes by hand"});
  }

  /// Goes on in a phase of these.
  void go_through(diagram::Timeline timeline, const solve::PhasePosition& position) {
    solve::RunState state = save();
    Pots with_modes = pots_;
    if (timeline != pots_.diagram().timeline) {
      with_modes.set_timeline(std::move(timeline));
      state = carried_state(state, *pots_.program(), signals(), *with_modes.program());
    }
    state.position = position;
    go_on(with_modes, std::move(state));
    pots_ = std::move(with_modes);
  }

  /// Lets the machine go on from where it stands, with the pots as they are turned.
  void take_turned_pots() {
    const auto& program = pots_.program();
    if (program == machine_->program) return;
    machine_->runner.signals_at(time_, signals_);
    go_on(pots_, carried_state(machine_->runner.state_at(time_), *machine_->program, signals_, *program));
  }

  void go_on(Pots& pots, solve::RunState state) {
    const double from = state.time;
    if (!(horizon_ > from)) horizon_ = 2 * from;
    auto next = std::make_unique<Machine>(pots.flat(), pots.program(),
                                          options_of(pots.diagram().run, horizon_, std::move(state)));
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
    go_on(pots_, save());
  }

  Pots pots_;
  bool has_timeline_;
  double horizon_, time_ = 0;  ///< [s]
  std::unique_ptr<Machine> machine_;
  bool looks_ahead_ = false;  ///< whether a piece was looked at that has not been passed
  std::vector<double> signals_;
  bool known_ = false;  ///< whether these are those at `time_`
  std::vector<SetProbe> probes_;
  std::vector<double> probed_;
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
std::vector<double> Console::signals() const {
  return held_->signals();
}
std::vector<std::string> Console::output_names() const {
  return held_->output_names();
}
std::vector<std::string> Console::signal_names() const {
  return held_->signal_names();
}
std::vector<std::string> Console::pot_names() const {
  return held_->pots().names();
}
Turned Console::turn(const std::string& pot, const std::string& value) {
  return held_->pots().turn(pot, value);
}
std::vector<diagram::ParameterOverride> Console::exchange(
    diagram::Diagram diagram, const diagram::BlockLibrary& library,
    const std::vector<std::pair<std::string, std::string>>& renamed) {
  return held_->exchange(std::move(diagram), library, renamed);
}
std::vector<Console::Overload> Console::overloads() const {
  return held_->overloads();
}
std::size_t Console::set_probe(ProbeSettings settings) {
  return held_->set_probe(std::move(settings));
}
const std::vector<Trace>& Console::traces(std::size_t probe) const {
  return held_->traces(probe);
}
std::vector<Trace> Console::take_traces(std::size_t probe) {
  return held_->take_traces(probe);
}
void Console::remove_probe(std::size_t probe) {
  held_->remove_probe(probe);
}
void Console::set_mode(diagram::OperatingMode mode) {
  held_->set_mode(mode);
}
void Console::repeat(double initial, double operate) {
  held_->repeat(initial, operate);
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
