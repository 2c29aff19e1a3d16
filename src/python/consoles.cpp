// SPDX-License-Identifier: MIT
#include "runs.h"

#include <cmath>
#include <mutex>

#include <oblique/console/console.h>
#include <oblique/solve/run_state.h>

namespace oblique::python {
namespace {

/// A console that threads may share: one after the other.
class HeldConsole {
 public:
  explicit HeldConsole(const DiagramModel& model)
      : library_(model.library()), console_(model.diagram(), *library_) {}

  /// Does `work(console)` while nobody else does.
  template <class Work>
  auto with(Work&& work) {
    return unlocked([&](SignalWatch&) {
      const std::scoped_lock lock(mutex_);
      return work(console_);
    });
  }

  void advance(double until) {
    unlocked([&](SignalWatch& watch) {
      const std::scoped_lock lock(mutex_);
      go(until, watch);
      return 0;
    });
  }

  /// The values of `names` at `times`, row by row.
  std::vector<double> scope(const std::vector<std::string>& names, const std::vector<double>& times) {
    return unlocked([&](SignalWatch& watch) {
      const std::scoped_lock lock(mutex_);
      std::vector<double> values;
      values.reserve(names.size() * times.size());
      for (const double time : times) {
        go(time, watch);
        for (const std::string& name : names) values.push_back(console_.value(name));
      }
      return values;
    });
  }

 private:
  /// In pieces of about a fiftieth of a second of ours, since a console knows no interruption: where it is
  /// asked in between changes none of its steps.
  void go(double until, SignalWatch& watch) {
    double piece = std::ldexp(until - console_.time(), -30);
    while (piece > 0 && until - console_.time() > piece) {
      const auto begin = std::chrono::steady_clock::now();
      console_.advance(console_.time() + piece);
      watch.check();
      const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
      if (took.count() < 0.01) piece *= 2;
      if (took.count() > 0.04) piece /= 2;
    }
    console_.advance(until);
    watch.check();
  }

  Library library_;
  std::mutex mutex_;
  console::Console console_;
};

diagram::OperatingMode mode_of(const std::string& name) {
  for (const auto mode : {diagram::OperatingMode::potset, diagram::OperatingMode::initial,
                          diagram::OperatingMode::operate, diagram::OperatingMode::hold}) {
    if (diagram::mode_name(mode) == name) return mode;
  }
  throw console::ConsoleError(
      text::Diagnostic{{},
                       "there is no mode of operation '" + name + "'",
                       "potset, initial, operate or hold",
                       text::suggest(name, {"potset", "initial", "operate", "hold"})});
}

std::size_t set_probe(HeldConsole& held, const std::vector<std::string>& names, const py::dict& asked) {
  console::ProbeSettings settings;
  settings.names = names;
  settings.interval = entry(asked, "interval", settings.interval);
  settings.length = entry(asked, "length", settings.length);
  settings.most_traces = entry(asked, "most_traces", settings.most_traces);
  if (const auto name = entry<std::string>(asked, "trigger", ""); !name.empty()) {
    const auto slope = entry<std::string>(asked, "slope", "rising");
    settings.trigger = {name, entry(asked, "level", 0.0),
                        slope == "falling"  ? console::Trigger::Slope::falling
                        : slope == "either" ? console::Trigger::Slope::either
                                            : console::Trigger::Slope::rising,
                        entry(asked, "hold_off", 0.0)};
  }
  return held.with([&](auto& c) { return c.set_probe(std::move(settings)); });
}

/// Of each trace when it was triggered, and its rows: the time, then the values.
py::list traces_of(HeldConsole& held, std::size_t probe) {
  py::list list;
  for (const console::Trace& trace : held.with([&](auto& c) { return c.traces(probe); })) {
    std::vector<double> rows;
    for (std::size_t row = 0; row < trace.times.size(); ++row) {
      rows.push_back(trace.times[row]);
      for (const std::vector<double>& values : trace.values) rows.push_back(values[row]);
    }
    list.append(py::make_tuple(trace.begin, to_array(std::move(rows), 1 + trace.values.size())));
  }
  return list;
}

}  // namespace

void bind_consoles(py::module_& module) {
  py::class_<HeldConsole, std::shared_ptr<HeldConsole>>(module, "Console")
      .def(py::init([](const DiagramModel& model) {
        return unlocked([&](SignalWatch&) { return std::make_shared<HeldConsole>(model); });
      }))
      .def_property_readonly("time",
                             [](HeldConsole& held) { return held.with([](auto& c) { return c.time(); }); })
      .def("advance", &HeldConsole::advance)
      .def("scope",
           [](HeldConsole& held, const std::vector<std::string>& names, const std::vector<double>& times) {
             return to_array(held.scope(names, times), names.size());
           })
      .def("read",
           [](HeldConsole& held, const std::string& name) {
             const auto reading = held.with([&](auto& c) { return c.read(name); });
             return py::make_tuple(reading.value, to_str(reading.unit));
           })
      .def("turn",
           [](HeldConsole& held, const std::string& pot, const std::string& value) {
             return held.with([&](auto& c) { return c.turn(pot, value) == console::Turned::at_once; });
           })
      .def("set_probe", &set_probe)
      .def("traces", &traces_of)
      .def("remove_probe",
           [](HeldConsole& held, std::size_t probe) {
             held.with([&](auto& c) {
               c.remove_probe(probe);
               return 0;
             });
           })
      .def("set_mode",
           [](HeldConsole& held, const std::string& name) {
             const diagram::OperatingMode mode = mode_of(name);
             held.with([&](auto& c) {
               c.set_mode(mode);
               return 0;
             });
           })
      .def("repeat",
           [](HeldConsole& held, double initial, double operate) {
             held.with([&](auto& c) {
               c.repeat(initial, operate);
               return 0;
             });
           })
      .def("save",
           [](HeldConsole& held) { return held.with([](auto& c) { return solve::to_text(c.save()); }); })
      .def("restore",
           [](HeldConsole& held, const std::string& state) {
             held.with([&](auto& c) {
               c.restore(solve::parse_run_state(state, "state"));
               return 0;
             });
           })
      .def("outputs", [](HeldConsole& held) { return held.with([](auto& c) { return c.output_names(); }); })
      .def("signals", [](HeldConsole& held) { return held.with([](auto& c) { return c.signal_names(); }); })
      .def("pots", [](HeldConsole& held) { return held.with([](auto& c) { return c.pot_names(); }); })
      .def("overloads",
           [](HeldConsole& held) {
             return held.with([](auto& c) {
               std::vector<std::pair<std::string, double>> beyond;
               for (const auto& [signal, value] : c.overloads()) beyond.emplace_back(signal, value);
               return beyond;
             });
           })
      .def("events",
           [](HeldConsole& held) {
             py::list list;
             for (const solve::EventRecord& event : held.with([](auto& c) { return c.events(); }))
               list.append(py::make_tuple(event.time, to_str(event.what)));
             return list;
           })
      .def("warnings",
           [](HeldConsole& held) { return to_list(held.with([](auto& c) { return c.warnings(); })); });
}

}  // namespace oblique::python
