// SPDX-License-Identifier: MIT
#pragma once

#include "binding.h"

#include <map>
#include <mutex>
#include <optional>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/diagram/flatten.h>
#include <oblique/network/program/program.h>
#include <oblique/report/expectation_check.h>
#include <oblique/solve/run.h>

namespace oblique::python {

/// A diagram with its pots where they were turned to, compiled. It never changes, so runs in threads share
/// it.
struct Compiled {
  Library library;
  diagram::FlatDiagram flat;
  network::Program program;
};

/// A diagram as it was read, and the last one that was compiled of it.
class DiagramModel {
 public:
  DiagramModel(diagram::Diagram read, Library library)
      : diagram_(std::move(read)), library_(std::move(library)) {}

  const diagram::Diagram& diagram() const { return diagram_; }
  const Library& library() const { return library_; }
  /// Compiles, if the last time was with other overrides. Safe in threads.
  std::shared_ptr<const Compiled> compiled(const std::vector<diagram::ParameterOverride>& overrides) const;

 private:
  diagram::Diagram diagram_;
  Library library_;
  mutable std::mutex mutex_;
  mutable std::shared_ptr<const Compiled> last_;
  mutable std::vector<std::pair<std::string, std::string>> last_overrides_;
};

using Settings = std::vector<std::pair<std::string, std::string>>;
std::vector<diagram::ParameterOverride> overrides_of(const Settings& settings);

/// What came out of a run, with what is needed to tell of it.
struct FinishedRun {
  std::shared_ptr<const Compiled> compiled;
  solve::RunOptions options;
  solve::Run run;
  std::string title;
  std::vector<report::ExpectationResult> expectations;
};

/// Runs a diagram as its [run] says, and what is `asked` beside it: until, tolerance, …, check, trust, state.
std::shared_ptr<FinishedRun> run_diagram(const DiagramModel& model, const Settings& settings,
                                         const py::dict& asked);

/// A number of a run and its derivatives by parameters: an output at a time, or its integral until the end.
std::pair<double, std::vector<double>> gradient_of(const DiagramModel& model, const Settings& settings,
                                                   const std::string& output, std::optional<double> at,
                                                   std::optional<double> until,
                                                   const std::vector<std::string>& by);

}  // namespace oblique::python
