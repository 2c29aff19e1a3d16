// SPDX-License-Identifier: MIT
#include <oblique/console/console.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/console/carried_state.h>
#include <oblique/console/kept_pots.h>
#include <oblique/console/modes_by_hand.h>
#include <oblique/console/pots.h>
#include <oblique/console/probe_set.h>
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
      probes_.look(piece_until(machine_->runner.piece_end()));
      time_ = machine_->runner.piece_end();
      if (std::exchange(looks_ahead_, false)) machine_->runner.pass();
      looks_ahead_ = machine_->runner.look_ahead();
      if (!looks_ahead_) go_on_beyond(until);
    }
    probes_.look(piece_until(until));
    time_ = until;
  }

  Reading read(std::string_view name) {
    if (const auto channel = find_channel(pots_, name)) return {channel->value(signals()), channel->unit};
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

  std::vector<std::string> output_names() const { return console::output_names(*pots_.flat()); }

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
    probes_.check(settings);
    take_turned_pots();
    return probes_.set(std::move(settings), piece_until(time_));
  }

  ProbeSet& probes() { return probes_; }

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
    std::vector<diagram::ParameterOverride> kept = kept_pots(pots_, diagram, renamed);
    Pots next(std::move(diagram), library, kept);
    go_on(next, carried_state(state, *pots_.program(), signals(), *next.program(), renamed));
    pots_ = std::move(next);
    probes_.find_again();
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
    go_through(repetition(initial, operate), {0, 0, time_});
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
    probes_.jump(time_);
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
  /// What the machine does from where it stands until `end`, within one piece.
  ProbeSet::Piece piece_until(double end) const {
    return {time_, end, end == machine_->runner.piece_end(),
            [this](double t, std::vector<double>& values) { machine_->runner.signals_at(t, values); }};
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
  ProbeSet probes_{pots_};
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
  return held_->probes().traces(probe);
}
std::vector<Trace> Console::take_traces(std::size_t probe) {
  return held_->probes().take_traces(probe);
}
void Console::remove_probe(std::size_t probe) {
  held_->probes().remove(probe);
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
