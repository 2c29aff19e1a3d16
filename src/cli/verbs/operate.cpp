// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <sstream>

#include <unistd.h>

#include <fmt/format.h>

#include <oblique/console/console.h>
#include <oblique/diagram/diagram_reader.h>
#include <oblique/draw/chart/chart.h>
#include <oblique/text/file.h>
#include <oblique/text/output_claim.h>
#include <oblique/text/trimmed.h>
#include "terminal/output_files.h"
#include "terminal/plot_output.h"
#include "terminal/terminal.h"
#include "verbs/command.h"

namespace oblique::cli {
namespace {

constexpr const char* kCommands =
    "ic, operate, hold                  put the machine into a mode\n"
    "rep-op INITIAL, OPERATE            repeat: so long in initial condition, so long in operation\n"
    "advance TIME                       run until then, for example 2*pi or \"500 ms\"\n"
    "turn BLOCK.PARAMETER VALUE         turn a pot; BLOCK.in[2] is the weight of the second wire\n"
    "read NAME                          the voltmeter: an output, a signal or a pot\n"
    "scope NAME,…                       show these while the machine runs; without names: no more\n"
    "overloads                          the lamps: which signals are beyond ±1 machine unit now\n"
    "events                             what has happened so far\n"
    "save FILE.toml, restore FILE.toml  keep the state, and go back to it\n"
    "quit\n";

/// A machine that obeys lines of text.
class Operator {
 public:
  /// `inputs`: the files that the machine was made from.
  Operator(console::Console console, std::vector<std::filesystem::path> inputs)
      : console_(std::move(console)), inputs_(std::move(inputs)) {}

  double time() const { return console_.time(); }

  /// Whether there is more to do after this line. Throws text::Error.
  bool obey(const std::string& line) {
    const std::string text = text::trimmed(line.substr(0, line.find('#')));
    const std::size_t space = std::min(text.find_first_of(" \t"), text.size());
    const std::string verb = text.substr(0, space), rest = text::trimmed(text.substr(space));
    if (verb.empty()) return true;
    if (verb == "quit") return expect_nothing(verb, rest), false;
    if (verb == "ic" || verb == "operate" || verb == "hold") {
      expect_nothing(verb, rest);
      console_.set_mode(verb == "ic"     ? diagram::OperatingMode::initial
                        : verb == "hold" ? diagram::OperatingMode::hold
                                         : diagram::OperatingMode::operate);
    } else if (verb == "rep-op") {
      const std::string& times = needed(verb, rest, "INITIAL, OPERATE");
      const std::size_t comma = std::min(times.find(','), times.size());
      if (comma == times.size())
        throw text::ReadError(text::Diagnostic{{},
                                               fmt::format("'rep-op {}' names one time", times),
                                               "rep-op INITIAL, OPERATE",
                                               "rep-op 100 ms, 2 s"});
      console_.repeat(quantity_option("rep-op", text::trimmed(times.substr(0, comma)), "s"),
                      quantity_option("rep-op", text::trimmed(times.substr(comma + 1)), "s"));
    } else if (verb == "advance") {
      advance(quantity_option("advance", needed(verb, rest, "TIME"), "s"));
    } else if (verb == "turn") {
      turn(needed(verb, rest, "BLOCK.PARAMETER VALUE"));
    } else if (verb == "read") {
      const console::Console::Reading reading = console_.read(needed(verb, rest, "NAME"));
      const std::string unit = reading.unit == "1" ? "" : " " + reading.unit;
      print(fmt::format("{} = {}{}\n", rest, reading.value, unit));
    } else if (verb == "scope") {
      set_scope(rest);
    } else if (verb == "overloads") {
      expect_nothing(verb, rest);
      show_overloads();
    } else if (verb == "events") {
      expect_nothing(verb, rest);
      for (const solve::EventRecord& event : console_.events())
        print(fmt::format("t = {:.12g} s: {}\n", event.time, event.what));
    } else if (verb == "save") {
      save_state(needed(verb, rest, "FILE.toml"));
    } else if (verb == "restore") {
      console_.restore(solve::parse_run_state(text::read_file(needed(verb, rest, "FILE.toml")), rest));
    } else if (verb == "help") {
      print(kCommands);
    } else {
      throw text::ReadError(text::Diagnostic{
          {},
          fmt::format("there is no command '{}'", verb),
          {},
          text::suggest(verb, {"ic", "operate", "hold", "rep-op", "advance", "turn", "read", "scope",
                               "overloads", "events", "save", "restore", "help", "quit"})});
    }
    tell_warnings();
    return true;
  }

 private:
  static void expect_nothing(const std::string& verb, const std::string& rest) {
    if (rest.empty()) return;
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("'{}' is followed by '{}'", verb, rest), fmt::format("'{}' alone", verb), {}});
  }

  static const std::string& needed(const std::string& verb, const std::string& rest, std::string_view what) {
    if (!rest.empty()) return rest;
    throw text::ReadError(text::Diagnostic{
        {}, fmt::format("'{}' is followed by nothing", verb), fmt::format("{} {}", verb, what), {}});
  }

  void turn(const std::string& rest) {
    const std::size_t space = rest.find_first_of(" \t");
    if (space == std::string::npos) {
      throw text::ReadError(text::Diagnostic{{},
                                             fmt::format("'turn {}' names no value", rest),
                                             "turn BLOCK.PARAMETER VALUE",
                                             fmt::format("'read {}' shows what it is", rest)});
    }
    const std::string pot = rest.substr(0, space);
    if (console_.turn(pot, text::trimmed(rest.substr(space))) == console::Turned::compiled_anew)
      note(fmt::format("turned '{}' by compiling anew\n", pot));
  }

  void save_state(const std::string& file) {
    constexpr std::array<std::string_view, 1> kEndings{".toml"};
    check_writable(file, kEndings);
    text::refuse_output(file, inputs_);
    save(file, solve::to_text(console_.save()));
  }

  void set_scope(const std::string& names) {
    std::vector<std::string> probes;
    std::istringstream list(names);
    for (std::string name; std::getline(list, name, ',');) {
      probes.push_back(text::trimmed(name));
      console_.read(probes.back());
    }
    probes_ = std::move(probes);
  }

  /// As `Console::advance`, with the scope on its way.
  void advance(double until) {
    constexpr int kPoints = 240;  // two dots of Braille a column
    const double from = console_.time();
    if (probes_.empty() || !(until > from) || !std::isfinite(until)) return console_.advance(until);
    console::ProbeSettings settings;
    settings.names = probes_;
    settings.interval = (until - from) / kPoints;
    const std::size_t probe = console_.set_probe(settings);
    try {
      console_.advance(until);
    } catch (...) {
      console_.remove_probe(probe);
      throw;
    }
    const console::Trace& trace = console_.traces(probe).front();
    draw::Panel panel;
    panel.x = {"t", "s"};
    for (const std::string& name : probes_) {
      draw::Curve curve;
      curve.name = name;
      curve.number = panel.curves.size();
      for (std::size_t row = 0; row < trace.times.size(); ++row)
        curve.points.emplace_back(trace.times[row], trace.values[curve.number][row]);
      panel.curves.push_back(std::move(curve));
    }
    console_.remove_probe(probe);
    draw::Chart chart;
    chart.panels.push_back(std::move(panel));
    plot(chart, "-", draw::Theme::automatic);
  }

  void show_overloads() {
    const std::vector<console::Console::Overload> lit = console_.overloads();
    for (const auto& [signal, value] : lit) print(fmt::format("{} = {:.6g} machine unit\n", signal, value));
    if (lit.empty()) print("no signal is beyond ±1 machine unit\n");
  }

  void tell_warnings() {
    for (const text::Diagnostic& warning : console_.warnings()) {
      const std::string told = text::to_string(warning);
      if (std::find(told_.begin(), told_.end(), told) != told_.end()) continue;
      told_.push_back(told);
      note("warning: " + told + "\n");
    }
  }

  console::Console console_;
  std::vector<std::filesystem::path> inputs_;
  std::vector<std::string> probes_, told_;
};

}  // namespace

ExitStatus operate(const Session& session, const OperateRequest& request) {
  const text::InputRecord inputs;
  const diagram::BlockLibrary library = session.blocks();
  console::Console console(diagram::read_diagram(request.diagram), library);
  Operator machine(std::move(console), inputs.files());
  const bool at_terminal = isatty(STDIN_FILENO) == 1;
  ExitStatus status = ExitStatus::done;
  std::string line;
  for (long number = 1;; ++number) {
    if (at_terminal) note(fmt::format("t = {:.6g} s> ", machine.time()));
    if (!std::getline(std::cin, line)) break;
    try {
      if (!machine.obey(line)) break;
    } catch (const text::Error& error) {
      if (!at_terminal) status = ExitStatus::bad_request;
      print_error(at_terminal ? std::string(error.what()) : fmt::format("line {}: {}", number, error.what()));
    }
    std::cout.flush();
  }
  return status;
}

}  // namespace oblique::cli
