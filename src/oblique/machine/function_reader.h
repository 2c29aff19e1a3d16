// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/text/expression.h>

// Not installed.
namespace oblique::machine {

/// Finds what a block computes from its one argument, be it by a formula or by points.
class FunctionReader {
 public:
  explicit FunctionReader(diagram::FlatBlock block);

  /// Whether its outputs depend on one input or on time alone, or on nothing, and on nothing that was before.
  bool is_function();

  /// The input that is the argument, where there is one.
  std::optional<std::size_t> input() const { return input_; }

  /// Whether time is the argument.
  bool is_of_time() const { return is_of_time_; }

  /// Throws text::ExpressionError where a name has no value.
  double value(std::size_t output, double argument) const;

  /// What an output is of `time` and numbers alone, where time is the argument.
  text::Expression formula(std::size_t output) const;

 private:
  void write_out_tables(text::Expression& expression) const;
  const text::Expression* assigned(std::string_view name) const;
  std::optional<double> constant(std::string_view name) const;
  double value_of(const text::Expression& expression, double argument) const;
  text::Expression written_out(text::Expression expression) const;

  diagram::FlatBlock block_;
  const diagram::BlockDefinition& definition_;
  std::vector<diagram::Equation> equations_;
  std::optional<std::size_t> input_;
  bool is_of_time_ = false;
};

}  // namespace oblique::machine
