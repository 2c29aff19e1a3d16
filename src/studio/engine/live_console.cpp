// SPDX-License-Identifier: MIT
#include "studio/engine/live_console.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/solve/run_state.h>

#include "studio/engine/options.h"

namespace oblique::studio {
namespace {

using text::Diagnostic;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

diagram::OperatingMode mode_of(const std::string& name) {
  using Mode = diagram::OperatingMode;
  for (const Mode mode : {Mode::potset, Mode::initial, Mode::operate, Mode::hold}) {
    if (diagram::mode_name(mode) == name) return mode;
  }
  throw console::ConsoleError(Diagnostic{{},
                                         fmt::format("there is no mode of operation '{}'", name),
                                         "potset, initial, operate or hold",
                                         text::suggest(name, {"potset", "initial", "operate", "hold"})});
}

console::Trigger::Slope slope_of(const std::string& name) {
  using Slope = console::Trigger::Slope;
  if (name == "rising") return Slope::rising;
  if (name == "falling") return Slope::falling;
  if (name == "either") return Slope::either;
  throw console::ConsoleError(Diagnostic{{},
                                         fmt::format("there is no slope '{}'", name),
                                         "rising, falling or either",
                                         text::suggest(name, {"rising", "falling", "either"})});
}

/// What is no number of a probe is one that none has.
std::size_t probe_of(double number) {
  constexpr double kMost = 1e9;
  return number >= 0 && number < kMost && number == std::floor(number) ? static_cast<std::size_t>(number)
                                                                       : static_cast<std::size_t>(kMost);
}

}  // namespace

console::Console& LiveConsole::held() {
  if (console_) return *console_;
  throw console::ConsoleError(Diagnostic{{}, "no machine is held", "a diagram", "open one"});
}

Answer LiveConsole::stands() {
  Answer now;
  now.object["time"] = held().time();
  return now;
}

diagram::Diagram LiveConsole::read_text(const std::string& text, const std::string& name) const {
  if (static_cast<double>(text.size()) > engine_.limits().text)
    throw text::ReadError(Diagnostic{{name, {}},
                                     fmt::format("the file has {} bytes", text.size()),
                                     fmt::format("{} at most", engine_.limits().text),
                                     {}});
  diagram::Diagram diagram = diagram::parse_diagram(text, name);
  diagram.run.max_steps = std::min(diagram.run.max_steps, static_cast<std::int64_t>(engine_.limits().steps));
  return diagram;
}

Answer LiveConsole::set_up() {
  Answer opened = stands();
  opened.object["outputs"] = console_->output_names();
  opened.object["signals"] = console_->signal_names();
  opened.object["pots"] = console_->pot_names();
  return opened;
}

Answer LiveConsole::open(const std::string& text, const std::string& name) {
  return answer([&] {
    diagram::Diagram diagram = read_text(text, name);
    std::shared_ptr<const diagram::BlockLibrary> library = engine_.library();
    console_ = console::Console(std::move(diagram), *library);
    library_ = std::move(library);
    begin(diagram::OperatingMode::operate, 0);
    return set_up();
  });
}

Answer LiveConsole::exchange(const std::string& text, const std::string& name, const std::string& renamed) {
  return answer([&] {
    const Json asked = Json::parse(renamed, nullptr, false);
    std::vector<std::pair<std::string, std::string>> names;
    for (const Json& one : asked.is_array() ? asked : Json::array()) {
      if (one.is_array() && one.size() == 2 && one[0].is_string() && one[1].is_string())
        names.emplace_back(one[0].get<std::string>(), one[1].get<std::string>());
    }
    diagram::Diagram diagram = read_text(text, name);
    std::shared_ptr<const diagram::BlockLibrary> library = engine_.library();
    const auto kept = held().exchange(std::move(diagram), *library, names);
    library_ = std::move(library);
    Answer opened = set_up();
    opened.object["turned"] = Json::object();
    for (const diagram::ParameterOverride& pot : kept) opened.object["turned"][pot.path] = pot.value;
    return opened;
  });
}

Answer LiveConsole::set_mode(const std::string& mode) {
  return answer([&] {
    const diagram::OperatingMode wanted = mode_of(mode);
    held().set_mode(wanted);
    begin(wanted, time_of_operation());
    return stands();
  });
}

Answer LiveConsole::repeat(double initial, double operate) {
  return answer([&] {
    held().repeat(initial, operate);
    begin(diagram::OperatingMode::initial, 0);
    repetition_ = Repetition{initial, operate};
    return stands();
  });
}

/// In pieces of about a fiftieth of a second of ours, since a console knows no interruption: where it is
/// asked in between changes none of its steps. Whether it came there before the deadline.
bool LiveConsole::go(double until, double deadline) {
  constexpr int kSmallest = -20;  // of the way, as a power of two
  constexpr double kShort = 0.01, kLong = 0.04;
  console::Console& console = held();
  double piece = std::ldexp(until - console.time(), kSmallest);
  while (piece > 0 && until - console.time() > piece) {
    const double begin = seconds_now();
    if (begin >= deadline) return false;
    console.advance(console.time() + piece);
    const double took = seconds_now() - begin;
    if (took < kShort) piece *= 2;
    if (took > kLong) piece /= 2;
  }
  console.advance(until);
  return true;
}

Answer LiveConsole::advance(double duration, const std::vector<std::string>& names, int rows) {
  return answer([&] {
    console::Console& console = held();
    const double from = console.time();
    if (!(duration >= 0) || !std::isfinite(from + duration))
      throw console::ConsoleError(
          Diagnostic{{}, fmt::format("the machine cannot go on by {} s", duration), "0 or more seconds", {}});
    if (!(rows >= 1) ||
        static_cast<double>(rows) * static_cast<double>(names.size() + 1) > engine_.limits().numbers)
      throw console::ConsoleError(
          Diagnostic{{},
                     fmt::format("{} rows of {} values", rows, names.size()),
                     fmt::format("1 row or more, and {} numbers at most", engine_.limits().numbers),
                     {}});
    for (const std::string& name : names) console.read(name);
    const double begin = seconds_now(), deadline = begin + engine_.limits().seconds;
    Answer went;
    bool complete = true;
    int made = 0;
    while (complete && made < rows) {
      const double until = made + 1 == rows ? from + duration : from + duration * (made + 1) / rows;
      complete = go(std::max(until, console.time()), deadline);
      went.numbers.push_back(console.time());
      for (const std::string& name : names) went.numbers.push_back(console.value(name));
      ++made;
    }
    went.object["time"] = console.time();
    went.object["complete"] = complete;
    went.object["rows"] = made;
    went.object["seconds"] = seconds_now() - begin;
    went.object["warnings"] = to_json(console.warnings());
    return went;
  });
}

Answer LiveConsole::turn(const std::string& pot, const std::string& value) {
  return answer([&] {
    Answer turned;
    turned.object["how"] = held().turn(pot, value) == console::Turned::at_once ? "at_once" : "compiled_anew";
    return turned;
  });
}

Answer LiveConsole::read(const std::vector<std::string>& names) {
  return answer([&] {
    Answer shown;
    shown.object["units"] = Json::array();
    for (const std::string& name : names) {
      const console::Console::Reading reading = held().read(name);
      shown.object["units"].push_back(reading.unit);
      shown.numbers.push_back(reading.value);
    }
    return shown;
  });
}

Answer LiveConsole::signals() {
  return answer([&] {
    Answer all;
    all.numbers = held().signals();
    return all;
  });
}

Answer LiveConsole::overloads() {
  return answer([&] {
    Answer lit;
    lit.object["signals"] = Json::array();
    for (const console::Console::Overload& overload : held().overloads()) {
      lit.object["signals"].push_back(overload.signal);
      lit.numbers.push_back(overload.value);
    }
    return lit;
  });
}

Answer LiveConsole::events() {
  return answer([&] {
    Answer happened;
    happened.object["events"] = Json::array();
    for (const solve::EventRecord& event : held().events())
      happened.object["events"].push_back({{"time", event.time}, {"what", event.what}});
    return happened;
  });
}

Answer LiveConsole::set_probe(const std::vector<std::string>& names, const std::string& options) {
  return answer([&] {
    const Options asked(options, {"interval", "length", "most", "trigger", "level", "slope", "hold_off"});
    console::ProbeSettings settings;
    settings.names = names;
    settings.interval = asked.quantity("interval", "s").value_or(0);
    settings.length = asked.quantity("length", "s").value_or(settings.length);
    constexpr int kMostTraces = 1'000'000;
    if (const auto most = asked.whole("most", 1, kMostTraces))
      settings.most_traces = static_cast<std::size_t>(*most);
    if (auto trigger = asked.word("trigger"))
      settings.trigger = {std::move(*trigger), asked.quantity("level", "1").value_or(0),
                          slope_of(asked.word("slope").value_or("rising")),
                          asked.quantity("hold_off", "s").value_or(0)};
    const double rows = settings.interval > 0 ? settings.length / settings.interval : 0;
    if (std::isfinite(rows) && rows * static_cast<double>(names.size() + 1) > engine_.limits().numbers)
      throw console::ConsoleError(
          Diagnostic{{},
                     fmt::format("traces of {:.0f} rows of {} values", rows, names.size()),
                     fmt::format("{} numbers at most", engine_.limits().numbers),
                     "a longer interval, or a shorter trace"});
    Answer set;
    set.object["probe"] = held().set_probe(std::move(settings));
    return set;
  });
}

Answer LiveConsole::take_traces(double probe) {
  return answer([&] {
    const std::size_t number = probe_of(probe);
    Answer taken;
    taken.object["traces"] = Json::array();
    const auto add = [&](const std::vector<console::Trace>& traces, bool ended) {
      for (const console::Trace& trace : traces) {
        taken.object["traces"].push_back(
            {{"begin", trace.begin}, {"rows", trace.times.size()}, {"ended", ended}});
        for (std::size_t row = 0; row < trace.times.size(); ++row) {
          taken.numbers.push_back(trace.times[row]);
          for (const std::vector<double>& values : trace.values) taken.numbers.push_back(values[row]);
        }
      }
    };
    add(held().take_traces(number), true);
    add(held().traces(number), false);
    return taken;
  });
}

Answer LiveConsole::remove_probe(double probe) {
  return answer([&] {
    held().remove_probe(probe_of(probe));
    return stands();
  });
}

void LiveConsole::begin(diagram::OperatingMode mode, double operated) {
  using Mode = diagram::OperatingMode;
  mode_ = mode;
  operated_ = mode == Mode::initial || mode == Mode::potset ? 0 : operated;
  since_ = console_->time();
  repetition_.reset();
}

double LiveConsole::time_of_operation() const {
  if (!console_) return 0;
  const double way = console_->time() - since_;
  if (repetition_) {
    const double within = std::fmod(way, repetition_->initial + repetition_->operate);
    return std::max(0.0, within - repetition_->initial);
  }
  return mode_ == diagram::OperatingMode::operate ? operated_ + way : operated_;
}

std::optional<std::vector<double>> LiveConsole::outputs(const std::vector<std::string>& names) {
  const std::vector<std::string> all = held().output_names();
  std::vector<double> values;
  values.reserve(names.size());
  for (const std::string& name : names) {
    if (std::find(all.begin(), all.end(), name) == all.end()) return std::nullopt;
    values.push_back(held().value(name));
  }
  return values;
}

Answer LiveConsole::save() {
  return answer([&] {
    Answer saved = stands();
    saved.object["state"] = solve::to_text(held().save());
    return saved;
  });
}

Answer LiveConsole::restore(const std::string& state) {
  return answer([&] {
    held().restore(solve::parse_run_state(state, "state"));
    begin(mode_, held().time());
    return stands();
  });
}

}  // namespace oblique::studio
