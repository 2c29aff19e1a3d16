// SPDX-License-Identifier: MIT
#include <oblique/text/operations.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <oblique/text/noise.h>

namespace oblique::text {
namespace {

constexpr std::size_t kAnyNumber = 1000;

constexpr std::array kOperations{
#define OBLIQUE_OPERATION(name, operands, traits, ...) \
  OperationInfo{Operation::name, #name, operands, traits},
#include <oblique/text/operations.def>
};

constexpr std::array kFunctions{
#define OBLIQUE_FUNCTION(name, operands, traits, scaling, value, by_a, by_b, doc) \
  FunctionInfo{Function::name, #name, operands, operands, false, scaling, doc},
#define OBLIQUE_CHOICE(name, spelling, least, most, switches, scaling, value, doc) \
  FunctionInfo{Function::name, spelling, least, most, switches, scaling, doc},
#include <oblique/text/operations.def>
};

double interpolate(std::span<const double> table) {
  const double x = table[0];
  const std::size_t points = (table.size() - 1) / 2;
  if (points < 2) return std::numeric_limits<double>::quiet_NaN();
  std::size_t right = 1;
  while (right + 1 < points && table[1 + 2 * right] <= x) ++right;
  const double x1 = table[2 * right - 1], y1 = table[2 * right];
  const double x2 = table[2 * right + 1], y2 = table[2 * right + 2];
  return y1 + (y2 - y1) * (x - x1) / (x2 - x1);
}

}  // namespace

std::span<const OperationInfo> operations() {
  return kOperations;
}

const OperationInfo& info_of(Operation operation) {
  return kOperations[static_cast<std::size_t>(operation)];
}

std::span<const FunctionInfo> functions() {
  return kFunctions;
}

const FunctionInfo& info_of(Function function) {
  return kFunctions[static_cast<std::size_t>(function)];
}

std::optional<Operation> smooth_operation(Function function) {
  switch (function) {
#define OBLIQUE_FUNCTION(name, ...) \
  case Function::name:              \
    return Operation::name;
#define OBLIQUE_CHOICE(name, ...) \
  case Function::name:            \
    return std::nullopt;
#include <oblique/text/operations.def>
  }
  return std::nullopt;
}

double evaluate(Operation operation, double a, double b) {
  switch (operation) {
#define OBLIQUE_OPERATION(name, operands, traits, value, by_a, by_b) \
  case Operation::name:                                              \
    return value;
#include <oblique/text/operations.def>
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double evaluate(Function function, std::span<const double> x) {
  switch (function) {
#define OBLIQUE_FUNCTION(name, operands, ...) \
  case Function::name:                        \
    return evaluate(Operation::name, x[0], x[operands - 1]);
#define OBLIQUE_CHOICE(name, spelling, least, most, switches, scaling, value, doc) \
  case Function::name:                                                             \
    return value;
#include <oblique/text/operations.def>
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace oblique::text
