// SPDX-License-Identifier: MIT
#include <oblique/ensemble/study/measure_program.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>
#include <oblique/text/expression_grammar.h>
#include <oblique/text/expression_parser.h>

namespace oblique::ensemble {
namespace {

using text::Expression;
using Kind = Expression::Kind;

[[noreturn]] void fail(std::size_t offset, std::string what, std::string expected = {},
                       std::string remedy = {}) {
  throw text::ExpressionError{static_cast<int>(offset) + 1, std::move(what), std::move(expected),
                              std::move(remedy)};
}

/// "name(…)" in a text.
struct Call {
  std::string_view name;
  std::size_t begin = 0, open = 0, end = 0;  ///< of the name, of its parenthesis, past the closing one
  std::size_t arguments = 0;                 ///< so many, by their commas
};

/// The calls that stand in no other call, and in no parenthesis of one.
std::optional<Call> next_call(std::string_view text, std::size_t from) {
  for (std::size_t at = from; at < text.size(); ++at) {
    if (!text::is_letter(text[at])) continue;
    Call call{{}, at, 0, 0, 1};
    while (at < text.size() && (text::is_letter(text[at]) || text::is_digit(text[at]) || text[at] == '.'))
      ++at;
    call.name = text.substr(call.begin, at - call.begin);
    while (at < text.size() && text[at] == ' ') ++at;
    call.open = at;
    if (at >= text.size() || text[at] != '(') {
      --at;
      continue;
    }
    int depth = 0;
    for (; at < text.size(); ++at) {
      if (text[at] == '(') ++depth;
      if (text[at] == ',' && depth == 1) ++call.arguments;
      if (text[at] == ')' && --depth == 0) {
        call.end = at + 1;
        return call;
      }
    }
    return std::nullopt;  // a parenthesis is not closed: the parser says so
  }
  return std::nullopt;
}

bool is_comparison(Kind kind) {
  return kind == Kind::less || kind == Kind::less_equal || kind == Kind::greater ||
         kind == Kind::greater_equal || kind == Kind::equal || kind == Kind::not_equal;
}

bool is_condition(const Expression& e) {
  return is_comparison(e.kind) || e.kind == Kind::logical_and || e.kind == Kind::logical_or ||
         e.kind == Kind::logical_not;
}

/// Puts the difference of the two sides of each comparison into `sides`.
void find_sides(const Expression& e, std::vector<Expression>& sides) {
  if (is_comparison(e.kind)) {
    sides.push_back(e);
    sides.back().kind = Kind::subtract;
    return;
  }
  for (const Expression& operand : e.operands) find_sides(operand, sides);
}

void move_columns(Expression& e, std::size_t by) {
  e.column += static_cast<int>(by);
  for (Expression& operand : e.operands) move_columns(operand, by);
}

}  // namespace

/// Takes the functions of the run out of a text, in which names of the same length stand for them: the rest
/// is an expression as any other.
class MeasureProgram::Reader {
 public:
  Reader(std::string_view text, bool mechanism, std::span<const std::string> outputs,
         const ColumnOf& column_of)
      : text_(text), mechanism_(mechanism), outputs_(outputs), column_of_(column_of) {}

  void read(MeasureProgram& program) {
    std::string outer(text_);
    std::vector<std::size_t> places;  // of the numbers of the run, from 0
    for (std::size_t from = 0; const auto call = next_call(outer, from);) {
      const auto function = function_of(*call);
      if (!function) {
        from = call->open + 1;  // "abs(end(x))"
        continue;
      }
      program.numbers_.push_back(number_of(*function, *call));
      places.push_back(call->begin);
      stand_in(outer, call->begin, call->end, places.size() - 1);
      from = call->end;
    }
    const Expression whole = text::parse_expression(outer);
    program.combination_ = RowExpression(whole, [&](const Expression& name) -> std::size_t {
      const auto place = std::find(places.begin(), places.end(), static_cast<std::size_t>(name.column - 1));
      if (place != places.end()) return static_cast<std::size_t>(place - places.begin());
      refuse_name(name);
    });
    program.is_distance_ = whole.kind == Kind::name && program.asks_for_errors();
    if (places.empty())
      fail(0, fmt::format("'{}' takes nothing from the run", text_), "max(x), end(x), mean(x) …");
  }

 private:
  static constexpr std::array<std::pair<std::string_view, Function>, 10> kFunctions{{
      {"max", Function::max},
      {"min", Function::min},
      {"mean", Function::mean},
      {"rms", Function::rms},
      {"end", Function::end},
      {"start", Function::start},
      {"integral", Function::integral},
      {"time", Function::time},
      {"error", Function::error},
      {"rms_error", Function::rms_error},
  }};

  static std::optional<Function> function_of(const Call& call) {
    const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                           [&](const auto& known) { return known.first == call.name; });
    if (found == kFunctions.end()) {
      const bool is_operator = call.name == "and" || call.name == "or" || call.name == "not";
      if (is_operator || text::find_function(call.name) != nullptr || call.name == "exact")
        return std::nullopt;
      std::vector<std::string> names;
      names.reserve(kFunctions.size());
      for (const auto& known : kFunctions) names.emplace_back(known.first);
      const auto near = text::nearest_name(call.name, names);
      fail(call.begin, fmt::format("there is no function '{}'", call.name), {},
           near ? fmt::format("did you mean '{}'?", *near)
                : "of a run: max, min, mean, rms, end, start, integral, time");
    }
    const bool of_numbers = call.arguments > 1 && (call.name == "max" || call.name == "min");
    return of_numbers ? std::nullopt : std::optional(found->second);
  }

  /// A name for something that takes the text from `begin` to `end`.
  static void stand_in(std::string& text, std::size_t begin, std::size_t end, std::size_t number) {
    std::string name = fmt::format("_{}", number);
    name.resize(end - begin, ' ');
    text.replace(begin, end - begin, name);
  }

  RunNumber number_of(Function function, const Call& call) const {
    RunNumber number;
    number.function = function;
    const std::size_t begin = call.open + 1;
    const std::string_view argument = text_.substr(begin, call.end - 1 - begin);
    const bool is_empty = argument.find_first_not_of(' ') == std::string_view::npos;
    if (function == Function::error || function == Function::rms_error) {
      if (!mechanism_) {
        fail(call.begin,
             fmt::format("{}() compares a mechanism with its exact motion, and this is a diagram", call.name),
             "a measure of its outputs, such as max(abs(x))");
      }
      if (!is_empty) fail(begin, fmt::format("{}() is of all moving points and has no argument", call.name));
      return number;
    }
    if (is_empty)
      fail(call.begin, fmt::format("{}() says not of what", call.name), fmt::format("{}(x)", call.name));
    if (is_output(argument) && function != Function::time) {
      Expression output;
      output.kind = Kind::name;
      output.name = "output";
      number.argument =
          RowExpression(output, [&](const Expression&) { return column_of_(std::string(argument)); });
      return number;
    }
    if (call.arguments > 1)
      fail(call.begin, fmt::format("{} was given {} arguments", call.name, call.arguments), "1");
    const Expression expression = argument_of(argument, begin, call.name);
    const auto column_of = [&](const Expression& name) { return column(name); };
    if (function == Function::time && !is_condition(expression)) {
      fail(begin, "time(…) is when a condition first holds, and this is none",
           fmt::format("time({} > 0), for example", argument));
    }
    number.argument = RowExpression(expression, column_of);
    if (function == Function::time) {
      std::vector<Expression> sides;
      find_sides(expression, sides);
      for (const Expression& side : sides) number.sides.emplace_back(side, column_of);
    }
    return number;
  }

  bool is_output(std::string_view name) const {
    return std::find(outputs_.begin(), outputs_.end(), name) != outputs_.end();
  }

  /// The argument of a function of the run, with names such as "exact(B.x)" in it.
  Expression argument_of(std::string_view argument, std::size_t begin, std::string_view function) const {
    std::string rest(argument);
    std::vector<std::pair<std::size_t, std::string>> exact;
    for (std::size_t from = 0; const auto call = next_call(rest, from);) {
      from = call->open + 1;
      if (call->name == "exact") {
        if (!mechanism_) {
          fail(begin + call->begin, "exact(…) is of a mechanism's exact motion, and this is a diagram",
               "a mechanism");
        }
        std::string of = rest.substr(call->open + 1, call->end - call->open - 2);
        std::erase(of, ' ');
        exact.emplace_back(call->begin, fmt::format("exact({})", of));
        stand_in(rest, call->begin, call->end, exact.size() - 1);
      } else if (text::find_function(call->name) == nullptr || call->arguments == 1) {
        const bool known = std::any_of(kFunctions.begin(), kFunctions.end(),
                                       [&](const auto& one) { return one.first == call->name; });
        if (known) {
          fail(begin + call->begin,
               fmt::format("{}(…) is one number of the whole run, and stands inside {}(…)", call->name,
                           function),
               "outputs and signals there",
               call->name == "max" || call->name == "min"
                   ? fmt::format("{}(x, y) of two arguments takes the one or the other at every moment",
                                 call->name)
                   : "");
        }
      }
    }
    Expression expression;
    try {
      expression = text::parse_expression(rest);
    } catch (text::ExpressionError& error) {
      error.column += static_cast<int>(begin);
      throw;
    }
    for (const auto& [place, name] : exact) put_name(expression, static_cast<int>(place) + 1, name);
    move_columns(expression, begin);
    return expression;
  }

  static void put_name(Expression& e, int column, const std::string& name) {
    if (e.kind == Kind::name && e.column == column) e.name = name;
    for (Expression& operand : e.operands) put_name(operand, column, name);
  }

  std::size_t column(const Expression& name) const {
    if (name.name == "time") return 0;
    try {
      return column_of_(name.name);
    } catch (text::ExpressionError& error) {
      error.column = name.column;
      throw;
    }
  }

  [[noreturn]] void refuse_name(const Expression& name) const {
    const auto place = static_cast<std::size_t>(name.column - 1);
    if (name.name != "time") column(name);  // throws where there is no such thing
    fail(place,
         fmt::format("'{}' has a value at every moment, and a measure is one number of a run", name.name),
         fmt::format("end({0}), max({0}), mean({0}) …", name.name));
  }

  std::string_view text_;
  bool mechanism_;
  std::span<const std::string> outputs_;
  const ColumnOf& column_of_;
};

MeasureProgram::MeasureProgram(std::string_view text, bool mechanism, std::span<const std::string> outputs,
                               const ColumnOf& column_of) {
  Reader(text, mechanism, outputs, column_of).read(*this);
}

bool MeasureProgram::asks_for_errors() const {
  return std::any_of(numbers_.begin(), numbers_.end(), [](const RunNumber& number) {
    return number.function == Function::error || number.function == Function::rms_error;
  });
}

double MeasureProgram::value_of(const RunNumber& number, const SampledRun& run, const MotionErrors& errors) {
  const auto at = [&](std::size_t row) {
    std::vector<double> values(run.columns());
    for (const std::size_t c : number.argument.columns()) values[c] = run.column(c)[row];
    return number.argument.evaluate(values);
  };
  switch (number.function) {
    case Function::max:
      return run.maximum(number.argument);
    case Function::min:
      return run.minimum(number.argument);
    case Function::mean:
      return run.integral(number.argument) / run.duration();
    case Function::rms:
      return std::sqrt(run.integral_of_square(number.argument) / run.duration());
    case Function::integral:
      return run.integral(number.argument);
    case Function::time:
      return run.first_time(number.argument, number.sides);
    case Function::start:
      return at(0);
    case Function::end:
      return at(run.rows() - 1);
    case Function::error:
      return errors.largest;
    case Function::rms_error:
      break;
  }
  return errors.rms;
}

double MeasureProgram::value(const SampledRun& run, const MotionErrors& errors) const {
  std::vector<double> numbers;
  for (const RunNumber& number : numbers_) numbers.push_back(value_of(number, run, errors));
  return combination_.evaluate(numbers);
}

}  // namespace oblique::ensemble
