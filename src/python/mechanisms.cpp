// SPDX-License-Identifier: MIT
#include "binding.h"

#include <fmt/format.h>

#include <oblique/mechanism/model/coefficients.h>
#include <oblique/mechanism/model/expectation.h>
#include <oblique/mechanism/model/read_mechanism.h>
#include <oblique/mechanism/motion/motion.h>
#include <oblique/mechanism/structure/structure.h>
#include <oblique/report/expectation_check.h>
#include <oblique/report/mechanism_check.h>
#include <oblique/report/mechanism_check_json.h>
#include <oblique/report/mechanism_check_text.h>
#include <oblique/report/mode_list.h>
#include <oblique/report/motion_text.h>
#include <oblique/synthesis/fit.h>

namespace oblique::python {
namespace {

/// The moment at which the first drive stands at `at` [rad] or [length unit].
double time_at(const mechanism::Mechanism& mechanism, std::optional<double> at) {
  if (!at) return 0;
  if (mechanism.drives.empty()) {
    throw mechanism::MechanismError(
        mechanism::MechanismError::Kind::request,
        text::Diagnostic{
            {mechanism.file, {}}, "at=: the mechanism has no drive", "a file with [drives]", {}});
  }
  if (const auto there = mechanism::time_at_value(mechanism, *at)) return *there;
  throw mechanism::MechanismError(mechanism::MechanismError::Kind::request,
                                  text::Diagnostic{{mechanism.file, {}},
                                                   fmt::format("at={:.6g}: drive '{}' does not reach it", *at,
                                                               mechanism.drives.front().name),
                                                   "a value that it reaches",
                                                   {}});
}

py::dict solve(const MechanismModel& model, int positions, std::optional<double> until,
               const std::string& at_limit, bool analysed) {
  const mechanism::Mechanism& mechanism = model.mechanism;
  mechanism::MotionOptions options;
  options.positions = positions;
  options.until = until;
  if (!at_limit.empty()) options.at_limit = mechanism::parse_at_limit(at_limit);
  std::vector<text::TableColumn> columns;
  std::vector<double> table;
  std::vector<int> status;
  std::string events, remarks;
  unlocked([&](SignalWatch& watch) {
    if (mechanism.drives.empty())
      mechanism::period(mechanism);  // says so, where `decompose` would speak of its mobility
    const mechanism::Structure structure = mechanism::decompose(mechanism);
    columns = report::motion_table_columns(mechanism);
    columns.pop_back();
    const std::size_t n_motion = columns.size();
    std::vector<mechanism::MotionColumn> analysis;
    if (analysed) {
      analysis =
          mechanism::analysis_columns(mechanism, structure, mechanism::solve_motion(mechanism, options));
      for (const mechanism::MotionColumn& column : analysis) columns.push_back({column.name, column.unit});
    }
    report::MotionDigest digest(static_cast<std::size_t>(std::max(positions, 0)));
    std::vector<double> values(n_motion + 1);
    const auto met =
        mechanism::visit_motion(mechanism, structure, options, [&](const mechanism::MotionRow& row) {
          mechanism::motion_values(mechanism, row, values);
          values.back() = static_cast<double>(row.configuration.status);
          digest.add(values, row.configuration.status);
          table.insert(table.end(), values.begin(), values.end() - 1);
          for (const mechanism::MotionColumn& column : analysis)
            table.push_back(column.values[status.size()]);
          status.push_back(static_cast<int>(row.configuration.status));
          watch.check();
        });
    events = report::events_text(mechanism, structure, met);
    remarks = digest.remarks(python_words());
    return 0;
  });
  py::dict all;
  all["columns"] = to_list(columns);
  all["rows"] = to_array(std::move(table), columns.size());
  all["status"] = status;
  all["events"] = to_str(events);
  all["remarks"] = to_str(remarks);
  return all;
}

py::list expectations(const MechanismModel& model) {
  const auto found = unlocked([&](SignalWatch&) { return mechanism::check_expectations(model.mechanism); });
  py::list list;
  for (const mechanism::MechanismFinding& finding : found) {
    list.append(py::make_tuple(to_str(finding.expectation.text), finding.actual, finding.expectation.value,
                               finding.expectation.within, finding.met));
  }
  return list;
}

py::dict check_mechanism(const MechanismModel& model) {
  std::string text, json;
  std::optional<std::string> finding;
  unlocked([&](SignalWatch&) {
    const report::MechanismCheck found = report::examine(model.mechanism, model.file);
    text = report::to_text(found);
    json = report::to_json(found);
    finding = found.finding;
    return 0;
  });
  py::dict all;
  all["text"] = to_str(text);
  all["json"] = to_str(json);
  all["finding"] = finding ? py::object(to_str(*finding)) : py::object(py::none());
  return all;
}

py::tuple modes(const MechanismModel& model, std::optional<double> at) {
  const auto [text, json] = unlocked([&](SignalWatch&) {
    mechanism::Structure structure = mechanism::find_groups(model.mechanism);
    const report::ModesAt position =
        report::modes_at(model.mechanism, structure, time_at(model.mechanism, at));
    return std::pair(report::to_text(model.mechanism, structure, position),
                     report::to_json(model.mechanism, structure, position));
  });
  return py::make_tuple(to_str(text), to_str(json));
}

py::dict fit(const MechanismModel& model, const std::string& csv, const std::string& csv_file,
             const std::vector<std::string>& free, int starts) {
  const synthesis::Fit found = unlocked([&](SignalWatch& watch) {
    const synthesis::TargetPath target = synthesis::read_target_path(csv, csv_file, model.mechanism);
    synthesis::FitOptions options;
    options.starts = starts;
    options.progress = watch.progress();
    return synthesis::fit_path(model.text, model.file, free, target, options);
  });
  py::list dimensions;
  for (const synthesis::FittedDimension& d : found.dimensions)
    dimensions.append(py::make_tuple(to_str(d.name), d.before, d.after, d.lower, d.upper, d.at_bound()));
  py::dict all;
  all["before"] = py::make_tuple(found.before.rms, found.before.largest);
  all["after"] = py::make_tuple(found.after.rms, found.after.largest);
  all["dimensions"] = dimensions;
  all["improved"] = found.improved;
  all["turns_fully"] = found.turns_fully;
  all["sketch_moved"] = found.sketch_moved;
  all["mechanisms_tried"] = found.mechanisms_tried;
  all["text"] = to_str(found.text);
  return all;
}

}  // namespace

void bind_mechanisms(py::module_& module) {
  py::class_<MechanismModel, std::shared_ptr<MechanismModel>> model(module, "Mechanism");
  model
      .def(py::init([](const std::string& text, const std::string& file) {
        return unlocked([&](SignalWatch&) {
          return std::make_shared<MechanismModel>(
              MechanismModel{text, file, mechanism::parse_mechanism(text, file)});
        });
      }))
      .def_property_readonly("title", [](const MechanismModel& m) { return to_str(m.mechanism.title); })
      .def_property_readonly("length_unit", [](const MechanismModel& m) { return m.mechanism.length_unit; })
      .def_property_readonly("points",
                             [](const MechanismModel& m) { return mechanism::names_of(m.mechanism.points); })
      .def_property_readonly("bodies",
                             [](const MechanismModel& m) { return mechanism::names_of(m.mechanism.bodies); })
      .def_property_readonly("slides",
                             [](const MechanismModel& m) { return mechanism::names_of(m.mechanism.slides); })
      .def_property_readonly("drives",
                             [](const MechanismModel& m) { return mechanism::names_of(m.mechanism.drives); })
      .def_property_readonly("drive_unit",
                             [](const MechanismModel& m) -> std::string {
                               if (m.mechanism.drives.empty() || !m.mechanism.drives.front().slide)
                                 return "rad";
                               return m.mechanism.length_unit;
                             })
      .def_property_readonly("expects",
                             [](const MechanismModel& m) { return !m.mechanism.expectations.empty(); })
      .def("solve", &solve)
      .def("expectations", &expectations)
      .def("check", &check_mechanism)
      .def("modes", &modes)
      .def("fit", &fit)
      .def("time_at",
           [](const MechanismModel& m, std::optional<double> at) { return time_at(m.mechanism, at); });
  bind_patches(model);
  bind_comparisons(model);
  bind_pictures(model);
}

}  // namespace oblique::python
