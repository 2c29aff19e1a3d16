// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace oblique::text {

// Made of the rows of the table, in their order.

/// The smooth operations, written as an operator or as a function; what a graph, a tape and a derivative are
/// made of.
enum class Operation : std::uint8_t {
#define OBLIQUE_OPERATION(name, ...) name,
#include <oblique/text/operations.def>
};

/// The functions of the expression language, the smooth ones and the rest.
enum class Function : std::uint8_t {
#define OBLIQUE_FUNCTION(name, ...) name,
#define OBLIQUE_CHOICE(name, ...) name,
#include <oblique/text/operations.def>
};

/// What is special of a smooth operation.
enum Trait : std::uint8_t {
  kPlain = 0,
  kCommutative = 1,
  kPeriodic = 2,  ///< repeats, or nearly, along its first operand: a step of a solver may pass over a period
  kPeaks = 4,     ///< can be next to nothing here and a peak there
  kPeaksByDivisor = 8,  ///< so where the second operand varies
};

/// How the value of a function is scaled when its arguments are.
enum class Scaling : std::uint8_t {
  pure,         ///< arguments and value are pure numbers, or it is not known
  alike,        ///< arguments have one factor, the value has it too
  ratio,        ///< arguments have one factor, the value is a pure number
  root,         ///< the value has the root of the argument's factor
  indifferent,  ///< any argument, the value is a pure number
  branches,     ///< as `if`: both branches have one factor, the value has it too
};

/// What is known of a smooth operation.
struct OperationInfo {
  Operation operation;
  std::string_view name;  ///< as in the table; the language has some of them under another name or none
  int operands;           ///< 1 or 2
  unsigned traits;        ///< of Trait

  constexpr bool is(Trait trait) const { return (traits & trait) != 0; }
};

/// What the language knows of one function.
struct FunctionInfo {
  Function function;
  std::string_view name;
  std::size_t min_arguments;
  std::size_t max_arguments;
  bool switches;  ///< has a kink or a jump: an event where its argument varies, never part of a smooth step
  Scaling scaling;
  std::string_view doc;
};

/// All smooth operations, in the order of `Operation`.
std::span<const OperationInfo> operations();
const OperationInfo& info_of(Operation operation);

/// All functions, in the order of `Function`.
std::span<const FunctionInfo> functions();
const FunctionInfo& info_of(Function function);

/// A function as a smooth operation, where it is one.
std::optional<Operation> smooth_operation(Function function);

/// Value of a smooth operation; of one operand, `b` is not looked at.
double evaluate(Operation operation, double a, double b = 0);

/// Value of one function; `x` has the number of arguments that FunctionInfo allows.
double evaluate(Function function, std::span<const double> x);

}  // namespace oblique::text
