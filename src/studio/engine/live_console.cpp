// SPDX-License-Identifier: MIT
#include "studio/engine/live_console.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/solve/run_state.h>

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

Answer LiveConsole::open(const std::string& text, const std::string& name) {
  return answer([&] {
    if (static_cast<double>(text.size()) > engine_.limits().text)
      throw text::ReadError(Diagnostic{{name, {}},
                                       fmt::format("the file has {} bytes", text.size()),
                                       fmt::format("{} at most", engine_.limits().text),
                                       {}});
    diagram::Diagram diagram = diagram::parse_diagram(text, name);
    diagram.run.max_steps =
        std::min(diagram.run.max_steps, static_cast<std::int64_t>(engine_.limits().steps));
    std::shared_ptr<const diagram::BlockLibrary> library = engine_.library();
    console_ = console::Console(std::move(diagram), *library);
    library_ = std::move(library);
    begin(diagram::OperatingMode::operate, 0);
    Answer opened = stands();
    opened.object["outputs"] = console_->output_names();
    opened.object["signals"] = console_->signal_names();
    opened.object["pots"] = console_->pot_names();
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
    const double deadline = seconds_now() + engine_.limits().seconds;
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
