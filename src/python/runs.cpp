// SPDX-License-Identifier: MIT
#include "runs.h"

#include <algorithm>
#include <span>

#include <oblique/draw/chart/chart.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/network/assembly/network.h>
#include <oblique/report/run_chart.h>
#include <oblique/report/run_text.h>
#include <oblique/solve/run_state.h>
#include <oblique/solve/sensitivity/gradient.h>

namespace oblique::python {
namespace {

/// The rows of a run where they stand: no copy, and not to be written to.
py::array_t<double> rows_of(const py::object& self) {
  const solve::Trajectory& rows = self.cast<const FinishedRun&>().run.trajectory;
  py::array_t<double> array({rows.rows(), rows.columns().size()}, rows.values().data(), self);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::list overloads_of(const FinishedRun& run) {
  py::list list;
  for (const solve::OverloadRecord& overload : run.run.overloads) {
    list.append(py::make_tuple(run.compiled->program.signal_names()[overload.signal], overload.first,
                               overload.duration, overload.peak.value, overload.peak.time,
                               overload.suggested_scale));
  }
  return list;
}

py::object trust_of(const FinishedRun& run) {
  if (!run.run.trust) return py::none();
  const solve::Trust& trust = *run.run.trust;
  py::list outputs;
  for (const solve::OutputError& output : trust.outputs) {
    outputs.append(py::make_tuple(output.name, output.size, output.largest, output.digits(output.largest),
                                  output.at_end, output.digits(output.at_end), output.lost));
  }
  return py::make_tuple(outputs, trust.event_shift, trust.events_part, to_str(trust.failure),
                        to_str(report::trust_text(trust)));
}

py::dict statistics_of(const FinishedRun& run) {
  const solve::SolverStatistics& s = run.run.statistics;
  py::dict dict;
  dict["steps"] = s.steps;
  dict["evaluations"] = s.evaluations;
  dict["jacobians"] = s.jacobians;
  dict["factorizations"] = s.factorizations;
  dict["error_test_failures"] = s.error_test_failures;
  dict["last_step"] = s.last_step;
  dict["method"] = std::string(diagram::method_name(run.run.method.method));
  dict["reason"] = to_str(run.run.method.reason);
  dict["seconds"] = run.run.seconds;
  return dict;
}

std::string chart_of(const FinishedRun& run, const std::vector<std::string>& columns,
                     const std::string& against, const std::string& theme) {
  const report::DrawnColumns drawn =
      report::drawn_columns(solve::run_columns(run.compiled->flat, run.options), {columns, against});
  const draw::Chart chart =
      report::chart_of(run.run, report::rounding_of(run.compiled->flat, run.options), drawn, run.title);
  return draw::to_svg(draw::draw_chart(chart), theme_of(theme));
}

}  // namespace

std::shared_ptr<const Compiled> DiagramModel::compiled(
    const std::vector<diagram::ParameterOverride>& overrides) const {
  Settings wanted;
  for (const diagram::ParameterOverride& one : overrides) wanted.emplace_back(one.path, one.value);
  {
    const std::scoped_lock lock(mutex_);
    if (last_ && wanted == last_overrides_) return last_;
  }
  diagram::FlatDiagram flat = diagram::flatten(diagram_, *library_, overrides);
  network::Program program(network::assemble(flat));
  auto made = std::make_shared<const Compiled>(Compiled{library_, std::move(flat), std::move(program)});
  const std::scoped_lock lock(mutex_);
  last_ = made;
  last_overrides_ = std::move(wanted);
  return made;
}

std::vector<diagram::ParameterOverride> overrides_of(const Settings& settings) {
  std::vector<diagram::ParameterOverride> overrides;
  for (const auto& [path, value] : settings) overrides.push_back({path, value});
  return overrides;
}

std::shared_ptr<FinishedRun> run_diagram(const DiagramModel& model, const Settings& settings,
                                         const py::dict& asked) {
  diagram::Diagram copied;  // only where a check must know of another end
  solve::RunOptions options = solve::options_of(model.diagram().run);
  options.until = entry(asked, "until", options.until);
  options.tolerance = entry(asked, "tolerance", options.tolerance);
  options.absolute_tolerance = entry(asked, "absolute_tolerance", options.absolute_tolerance);
  options.max_step = entry(asked, "max_step", options.max_step);
  options.samples = entry(asked, "samples", options.samples);
  options.max_steps = entry(asked, "max_steps", options.max_steps);
  options.settle = entry(asked, "settle", options.settle);
  options.halt_on_overload = entry(asked, "halt_on_overload", false);
  options.trust = entry(asked, "trust", false);
  options.sensitivity = entry(asked, "sensitivity", options.sensitivity);
  options.watch_overloads = entry(asked, "watch_overloads", model.diagram().machine.profile != "ideal");
  const auto method = entry<std::string>(asked, "method", "");
  for (const diagram::IntegrationMethod known : diagram::kIntegrationMethods) {
    if (method == diagram::method_name(known)) options.method = known;
  }
  const auto state = entry<std::string>(asked, "state", "");
  const bool check = entry(asked, "check", false);

  auto finished = std::make_shared<FinishedRun>();
  finished->title = model.diagram().title;
  unlocked([&](SignalWatch& watch) {
    finished->compiled = model.compiled(overrides_of(settings));
    if (!state.empty()) options.from = solve::parse_run_state(state, "state");
    if (options.from && !(options.until > options.from->time)) {
      throw text::ReadError(text::Diagnostic{{},
                                             "the state is that of a time at or after the end of the run",
                                             "a later end of the run",
                                             text::Remedy{"give a later ", text::Setting{"until"}}});
    }
    if (check) {
      diagram::Diagram ends = model.diagram();
      ends.run.until = options.until;
      report::ask_for_expectations(ends, options);
    }
    // With `interrupted` a run keeps a copy of its state at every step, a tenth of the time of a small
    // diagram: what is thrown here leaves no state behind, which nobody would see. Estimates know no
    // progress.
    if (options.trust) options.interrupted = [&watch] { return watch.asked_often(); };
    options.progress = watch.progress();
    options.on_sample = [&watch](double, std::span<const double>, std::span<const double>) {
      if (watch.asked_often()) throw Interrupt{};
    };
    finished->run = solve::run(finished->compiled->program, finished->compiled->flat, options);
    if (check) finished->expectations = report::check_expectations(model.diagram(), finished->run);
    return 0;
  });
  options.interrupted = nullptr;
  options.progress = nullptr;
  options.on_sample = nullptr;
  finished->options = std::move(options);
  return finished;
}

std::pair<double, std::vector<double>> gradient_of(const DiagramModel& model, const Settings& settings,
                                                   const std::string& output, std::optional<double> at,
                                                   std::optional<double> until,
                                                   const std::vector<std::string>& by) {
  return unlocked([&](SignalWatch& watch) {
    const auto compiled = model.compiled(overrides_of(settings));
    solve::RunOptions options = solve::options_of(model.diagram().run);
    options.until = until.value_or(options.until);
    options.interrupted = [&watch] { return watch.asked_often(); };
    solve::RunNumber number{solve::RunNumber::Kind::integral, output, 0};
    if (at) number = {solve::RunNumber::Kind::value, output, *at};
    solve::Gradient found = solve::gradient(compiled->program, compiled->flat, options, number, by);
    return std::pair(found.value, std::move(found.by_parameter));
  });
}

void bind_runs(py::module_& module) {
  py::class_<FinishedRun, std::shared_ptr<FinishedRun>>(module, "Run")
      .def_property_readonly("rows", &rows_of)
      .def_property_readonly("columns",
                             [](const FinishedRun& run) { return to_list(run.run.trajectory.columns()); })
      .def_property_readonly("title", [](const FinishedRun& run) { return to_str(run.title); })
      .def_property_readonly("events",
                             [](const FinishedRun& run) {
                               py::list list;
                               for (const solve::EventRecord& event : run.run.events)
                                 list.append(py::make_tuple(event.time, to_str(event.what)));
                               return list;
                             })
      .def_property_readonly("event_count", [](const FinishedRun& run) { return run.run.event_count; })
      .def_property_readonly("warnings", [](const FinishedRun& run) { return to_list(run.run.warnings); })
      .def_property_readonly("overloads", &overloads_of)
      .def_property_readonly("halted", [](const FinishedRun& run) { return run.run.halted; })
      .def_property_readonly("statistics", &statistics_of)
      .def_property_readonly("trust", &trust_of)
      .def_property_readonly("state", [](const FinishedRun& run) { return solve::to_text(run.run.state); })
      .def_property_readonly("end", [](const FinishedRun& run) { return run.run.state.time; })
      .def_property_readonly(
          "expectations",
          [](const FinishedRun& run) {
            py::list list;
            for (const report::ExpectationResult& r : run.expectations)
              list.append(py::make_tuple(to_str(r.expectation.text), r.actual, r.expectation.value,
                                         r.expectation.within, r.met));
            return list;
          })
      .def("table",
           [](const FinishedRun& run, std::size_t most_columns) {
             const std::size_t columns = std::min(most_columns, run.run.trajectory.columns().size());
             return to_str(report::rows_of(run.run.trajectory, columns).text());
           })
      .def("solver_text",
           [](const FinishedRun& run) {
             return to_str(report::solver_text(run.compiled->program, run.run, run.options));
           })
      .def("chart", &chart_of);
}

}  // namespace oblique::python
