// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <oblique/diagram/diagram.h>
#include <oblique/diagram/flat_diagram.h>
#include <oblique/ensemble/study/measure_program.h>
#include <oblique/ensemble/study/plan.h>
#include <oblique/solve/run.h>
#include <oblique/text/quantity.h>

// Of this stage; not installed.
namespace oblique::ensemble {

/// A machine of a study, as its varied names make it.
struct Machine {
  diagram::FlatDiagram flat;  ///< its outputs are those that were asked for
  double until = 0;           ///< [s]
  /// Of a mechanism: the values of an exact column at the rows of the run.
  std::function<std::vector<double>(const std::string& column, std::size_t rows)> exact;
  /// Of a mechanism: how far the outputs, column by column behind the time, are from its exact motion.
  std::function<MotionErrors(std::span<const std::vector<double>> outputs)> errors;
};

/// What a study is of: a diagram or a mechanism. All messages have no place where they are of a varied name
/// or of a measure; the study knows it.
class Subject {
 public:
  Subject() = default;
  Subject(const Subject&) = delete;
  Subject& operator=(const Subject&) = delete;
  virtual ~Subject() = default;

  /// How a single machine is run, unless the plan says otherwise.
  virtual solve::RunOptions run_options() const = 0;
  virtual const diagram::Diagram& diagram() const = 0;
  virtual std::string length_unit() const { return {}; }  ///< of a mechanism
  /// Of a diagram: those of its outputs.
  virtual std::vector<std::string> output_names() const { return {}; }
  /// The measures of a plan that has none.
  virtual std::vector<Measure> usual_measures() const = 0;
  /// The unit in which the values of a name are. Throws where there is no such name.
  virtual text::Unit unit_of(const std::string& name) = 0;
  /// From now on `machine` gets a value for this name, too. Gives one with which there is a machine. Throws
  /// where a machine cannot have one of these two.
  virtual double vary(const std::string& name, double lowest, double highest) = 0;
  /// Has the machines give an output; its place among them. Throws ExpressionError for a name that is none.
  virtual std::size_t add_output(const std::string& name) = 0;
  /// Has them give all outputs that `Machine::errors` takes.
  virtual void add_error_outputs() {}
  /// Of a mechanism: makes sure that there is such a column. Throws ExpressionError.
  virtual void check_exact(const std::string& column) const = 0;

  /// The machine with these values of the names, in the order in which they came. Throws what reading,
  /// patching and flattening throw.
  virtual Machine machine(std::span<const double> values) const = 0;
};

}  // namespace oblique::ensemble
