// SPDX-License-Identifier: MIT
#include <oblique/text/expression.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <fmt/format.h>

namespace oblique {
namespace {

constexpr std::size_t kAny = 1000;

constexpr std::array<FunctionInfo, 20> kFunctions{{
    {Function::sin, "sin", 1, 1, false, "sine of an angle in radians"},
    {Function::cos, "cos", 1, 1, false, "cosine of an angle in radians"},
    {Function::tan, "tan", 1, 1, false, "tangent of an angle in radians"},
    {Function::asin, "asin", 1, 1, false, "arc sine, in [-pi/2, pi/2]"},
    {Function::acos, "acos", 1, 1, false, "arc cosine, in [0, pi]"},
    {Function::atan, "atan", 1, 1, false, "arc tangent, in (-pi/2, pi/2)"},
    {Function::atan2, "atan2", 2, 2, false, "atan2(y, x): angle of the vector (x, y)"},
    {Function::exp, "exp", 1, 1, false, "exponential"},
    {Function::log, "log", 1, 1, false, "natural logarithm"},
    {Function::sqrt, "sqrt", 1, 1, false, "square root"},
    {Function::abs, "abs", 1, 1, true, "absolute value"},
    {Function::min, "min", 1, kAny, true, "smallest argument"},
    {Function::max, "max", 1, kAny, true, "largest argument"},
    {Function::hypot, "hypot", 2, 2, false, "hypot(x, y): length of the vector (x, y)"},
    {Function::sign, "sign", 1, 1, true, "-1, 0 or 1"},
    {Function::clip, "clip", 3, 3, true, "clip(x, low, high): x held between low and high"},
    {Function::deadzone, "deadzone", 2, 2, true, "deadzone(x, w): 0 within ±w, shifted by w outside"},
    {Function::step, "step", 1, 1, true, "0 below zero, 1 from zero on"},
    {Function::table, "table", 5, kAny, true, "table(x, x1, y1, x2, y2, …): straight lines through the points"},
    {Function::if_, "if", 3, 3, true, "if(condition, a, b): a where the condition holds, else b"},
}};

const FunctionInfo* find_function(std::string_view name) {
  const auto* const found = std::find_if(kFunctions.begin(), kFunctions.end(),
                                         [&](const FunctionInfo& f) { return f.name == name; });
  return found == kFunctions.end() ? nullptr : found;
}

[[noreturn]] void fail(std::size_t offset, std::string what, std::string expected = {}, std::string remedy = {}) {
  throw ExpressionError{static_cast<int>(offset) + 1, std::move(what), std::move(expected), std::move(remedy)};
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Binary operators by precedence; `^` binds tightest and to the right, everything else to the left.
enum Precedence { kOr = 1, kAnd, kNot, kComparison, kSum, kProduct, kNegation, kPower, kAtom };

struct BinaryOperator {
  std::string_view text;
  Expression::Kind kind;
  int precedence;
};

// Longer spellings first: "<=" is not "<".
constexpr std::array<BinaryOperator, 13> kBinaryOperators{{
    {"<=", Expression::Kind::less_equal, kComparison},
    {">=", Expression::Kind::greater_equal, kComparison},
    {"==", Expression::Kind::equal, kComparison},
    {"!=", Expression::Kind::not_equal, kComparison},
    {"<", Expression::Kind::less, kComparison},
    {">", Expression::Kind::greater, kComparison},
    {"+", Expression::Kind::add, kSum},
    {"-", Expression::Kind::subtract, kSum},
    {"*", Expression::Kind::multiply, kProduct},
    {"/", Expression::Kind::divide, kProduct},
    {"^", Expression::Kind::power, kPower},
    {"or", Expression::Kind::logical_or, kOr},
    {"and", Expression::Kind::logical_and, kAnd},
}};

const BinaryOperator* operator_of(Expression::Kind kind) {
  const auto* const found = std::find_if(kBinaryOperators.begin(), kBinaryOperators.end(),
                                         [&](const BinaryOperator& op) { return op.kind == kind; });
  return found == kBinaryOperators.end() ? nullptr : found;
}

class Parser {
 public:
  explicit Parser(std::string_view text) : text_(text) {}

  Expression parse(int loosest = kOr) {
    if (++depth_ > kDeepest) {
      fail(at_, "the expression is nested too deeply", fmt::format("at most {} levels", kDeepest));
    }
    Expression left = prefix(loosest);
    bool compared = false;
    while (const BinaryOperator* op = peek_operator()) {
      if (op->precedence < loosest) break;
      const std::size_t offset = at_;
      // A chain of operators is a tree as deep as it is long, and whoever walks it does so by recursion.
      if (++operators_ > kMostOperators) {
        fail(offset, "the expression is too long", fmt::format("at most {} operators", kMostOperators),
             "split it over several blocks");
      }
      if (op->precedence == kComparison && std::exchange(compared, true)) {
        fail(offset, "comparisons do not chain", {}, "join two comparisons with 'and': a < b and b < c");
      }
      at_ += op->text.size();
      Expression node;
      node.kind = op->kind;
      node.column = static_cast<int>(offset) + 1;
      node.operands.push_back(std::move(left));
      node.operands.push_back(parse(op->kind == Expression::Kind::power ? kNegation : op->precedence + 1));
      left = std::move(node);
    }
    --depth_;
    return left;
  }

  std::size_t position() {
    skip_space();
    return at_;
  }

 private:
  static constexpr int kDeepest = 200;
  static constexpr int kMostOperators = 1000;

  void skip_space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' ||
                                  text_[at_] == '\r')) {
      ++at_;
    }
  }

  bool take(char c) {
    skip_space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }

  std::string_view peek_word() const {
    std::size_t end = at_;
    while (end < text_.size() && (is_letter(text_[end]) || (end > at_ && is_digit(text_[end])))) ++end;
    return text_.substr(at_, end - at_);
  }

  const BinaryOperator* peek_operator() {
    skip_space();
    const std::string_view word = peek_word();
    for (const BinaryOperator& op : kBinaryOperators) {
      if (is_letter(op.text[0]) ? word == op.text : text_.substr(at_).starts_with(op.text)) return &op;
    }
    return nullptr;
  }

  Expression prefix(int loosest) {
    skip_space();
    const std::size_t offset = at_;
    if (take('-')) return negation(offset);
    if (take('+')) return parse(kNegation);
    if (loosest <= kNot && peek_word() == "not") {
      at_ += 3;
      return unary(Expression::Kind::logical_not, kNot, offset);
    }
    return atom();
  }

  /// A minus before a number that stands alone belongs to the number: "-2" is a number, "-2^2" is not.
  Expression negation(std::size_t offset) {
    skip_space();
    const bool before_number = at_number();
    Expression node = unary(Expression::Kind::negate, kNegation, offset);
    Expression& operand = node.operands[0];
    if (!before_number || operand.kind != Expression::Kind::number) return node;
    operand.number = -operand.number;
    operand.column = node.column;
    return Expression(std::move(operand));
  }

  Expression unary(Expression::Kind kind, int precedence, std::size_t offset) {
    Expression node;
    node.kind = kind;
    node.column = static_cast<int>(offset) + 1;
    node.operands.push_back(parse(precedence));
    return node;
  }

  Expression atom() {
    skip_space();
    if (at_ >= text_.size()) fail(at_, "the expression ends too early", "a number, a name or '('");
    if (take('(')) {
      Expression inner = parse();
      if (!take(')')) fail(at_, "a parenthesis is not closed", "')'");
      return inner;
    }
    if (at_number()) return number();
    if (is_letter(text_[at_])) return name_or_call();
    fail(at_, fmt::format("'{}' cannot start a value", text_.substr(at_, utf8_length(text_[at_]))),
         "a number, a name or '('");
  }

  static std::size_t utf8_length(char first) {
    const auto byte = static_cast<unsigned char>(first);
    return byte >= 0xF0 ? 4 : byte >= 0xE0 ? 3 : byte >= 0xC0 ? 2 : 1;
  }

  bool at_number() const { return at_ < text_.size() && (is_digit(text_[at_]) || text_[at_] == '.'); }

  Expression number() {
    Expression node;
    node.column = static_cast<int>(at_) + 1;
    const char* const begin = text_.data() + at_;
    const auto [end, error] = std::from_chars(begin, text_.data() + text_.size(), node.number);
    if (error != std::errc{}) {
      if (error == std::errc::result_out_of_range) {
        fail(at_, "the number is out of range", "a magnitude between 2.3e-308 and 1.7e308");
      }
      fail(at_, "'.' is not a number", "a digit before or after the point");
    }
    at_ += static_cast<std::size_t>(end - begin);
    return node;
  }

  Expression name_or_call() {
    Expression node;
    node.kind = Expression::Kind::name;
    node.column = static_cast<int>(at_) + 1;
    const std::size_t start = at_;
    if (const std::string_view word = peek_word(); word == "and" || word == "or" || word == "not") {
      fail(start, fmt::format("'{}' is an operator and cannot stand here", word), "a number, a name or '('");
    }
    at_ += peek_word().size();
    while (at_ + 1 < text_.size() && text_[at_] == '.' && is_letter(text_[at_ + 1])) {
      ++at_;
      at_ += peek_word().size();
    }
    node.name = std::string(text_.substr(start, at_ - start));
    skip_space();
    if (at_ >= text_.size() || text_[at_] != '(') return node;
    ++at_;
    return call(std::move(node), start);
  }

  Expression call(Expression node, std::size_t start) {
    const FunctionInfo* const info = find_function(node.name);
    if (info == nullptr) {
      std::vector<std::string> names;
      for (const FunctionInfo& f : kFunctions) names.emplace_back(f.name);
      fail(start, fmt::format("there is no function '{}'", node.name), {}, suggest(node.name, names));
    }
    node.kind = Expression::Kind::call;
    node.function = info->function;
    node.name.clear();
    if (!take(')')) {
      do node.operands.push_back(parse());
      while (take(','));
      if (!take(')')) fail(at_, fmt::format("the arguments of {} are not closed", info->name), "',' or ')'");
    }
    const std::size_t count = node.operands.size();
    if (count < info->min_arguments || count > info->max_arguments) {
      fail(start, fmt::format("{} was given {} argument{}", info->name, count, count == 1 ? "" : "s"),
           argument_range(*info), std::string(info->doc));
    }
    if (info->function == Function::table && count % 2 == 0) {
      fail(start, "a point of the table has no second coordinate", {}, std::string(info->doc));
    }
    return node;
  }

  static std::string argument_range(const FunctionInfo& info) {
    if (info.min_arguments == info.max_arguments) return std::to_string(info.min_arguments);
    return fmt::format("{} to {}", info.min_arguments, info.max_arguments);
  }

  std::string_view text_;
  std::size_t at_ = 0;
  int depth_ = 0;
  int operators_ = 0;
};

int precedence_of(const Expression& e) {
  switch (e.kind) {
    case Expression::Kind::negate: return kNegation;
    case Expression::Kind::logical_not: return kNot;
    case Expression::Kind::number: return std::signbit(e.number) ? kNegation : kAtom;
    case Expression::Kind::name:
    case Expression::Kind::call: return kAtom;
    default: return operator_of(e.kind)->precedence;
  }
}

bool is_unsigned_number(const Expression& e) {
  return e.kind == Expression::Kind::number && !std::signbit(e.number);
}

void print(const Expression& e, std::string& out);

void print_operand(const Expression& e, int at_least, std::string& out) {
  const bool wrap = precedence_of(e) < at_least;
  if (wrap) out += '(';
  print(e, out);
  if (wrap) out += ')';
}

void print(const Expression& e, std::string& out) {
  switch (e.kind) {
    case Expression::Kind::number: out += fmt::format("{}", e.number); return;
    case Expression::Kind::name: out += e.name; return;
    case Expression::Kind::call:
      out += functions()[static_cast<std::size_t>(e.function)].name;
      for (std::size_t i = 0; i < e.operands.size(); ++i) {
        out += i == 0 ? "(" : ", ";
        print(e.operands[i], out);
      }
      out += ')';
      return;
    case Expression::Kind::negate:
      out += '-';
      // "-2" would be the number, not the negation of 2.
      print_operand(e.operands[0], is_unsigned_number(e.operands[0]) ? kAtom + 1 : kNegation, out);
      return;
    case Expression::Kind::logical_not:
      out += "not ";
      print_operand(e.operands[0], kNot, out);
      return;
    default: break;
  }
  const BinaryOperator& op = *operator_of(e.kind);
  const bool tight = op.precedence == kProduct || op.precedence == kPower;
  const bool power = op.precedence == kPower;
  const bool chains = op.precedence != kComparison;
  print_operand(e.operands[0], power ? kAtom : op.precedence + (chains ? 0 : 1), out);
  out += tight ? std::string(op.text) : fmt::format(" {} ", op.text);
  print_operand(e.operands[1], power ? kNegation : op.precedence + 1, out);
}

/// The first characters of a text, for a message.
std::string excerpt(std::string_view text) {
  constexpr std::size_t kMost = 20;
  if (text.size() <= kMost) return std::string(text);
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "…";
}

double interpolate(std::span<const double> table) {
  const double x = table[0];
  const std::size_t points = (table.size() - 1) / 2;
  std::size_t right = 1;
  while (right + 1 < points && table[1 + 2 * right] < x) ++right;
  const double x1 = table[2 * right - 1], y1 = table[2 * right];
  const double x2 = table[2 * right + 1], y2 = table[2 * right + 2];
  return y1 + (y2 - y1) * (x - x1) / (x2 - x1);
}

}  // namespace

std::span<const FunctionInfo> functions() { return kFunctions; }

bool Expression::operator==(const Expression& other) const {
  return kind == other.kind && name == other.name && operands == other.operands &&
         (kind != Kind::number || number == other.number) && (kind != Kind::call || function == other.function);
}

Expression parse_expression_prefix(std::string_view text, std::size_t& rest) {
  Parser parser(text);
  Expression expression = parser.parse();
  rest = parser.position();
  return expression;
}

Expression parse_expression(std::string_view text) {
  std::size_t rest = 0;
  Expression expression = parse_expression_prefix(text, rest);
  if (rest < text.size()) {
    const bool product = is_letter(text[rest]) || is_digit(text[rest]) || text[rest] == '(';
    fail(rest, fmt::format("'{}' does not belong here", excerpt(text.substr(rest))), "an operator or the end",
         product ? "a product is written with '*'" : "");
  }
  return expression;
}

std::string to_string(const Expression& expression) {
  std::string out;
  print(expression, out);
  return out;
}

double evaluate(Function function, std::span<const double> a) {
  switch (function) {
    case Function::sin: return std::sin(a[0]);
    case Function::cos: return std::cos(a[0]);
    case Function::tan: return std::tan(a[0]);
    case Function::asin: return std::asin(a[0]);
    case Function::acos: return std::acos(a[0]);
    case Function::atan: return std::atan(a[0]);
    case Function::atan2: return std::atan2(a[0], a[1]);
    case Function::exp: return std::exp(a[0]);
    case Function::log: return std::log(a[0]);
    case Function::sqrt: return std::sqrt(a[0]);
    case Function::abs: return std::abs(a[0]);
    case Function::min: return *std::min_element(a.begin(), a.end());
    case Function::max: return *std::max_element(a.begin(), a.end());
    case Function::hypot: return std::hypot(a[0], a[1]);
    case Function::sign: return a[0] > 0 ? 1 : a[0] < 0 ? -1 : 0;
    case Function::clip: return std::max(a[1], std::min(a[0], a[2]));
    case Function::deadzone: return a[0] > a[1] ? a[0] - a[1] : a[0] < -a[1] ? a[0] + a[1] : 0;
    case Function::step: return a[0] < 0 ? 0 : 1;
    case Function::table: return interpolate(a);
    case Function::if_: return a[0] != 0 ? a[1] : a[2];
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double evaluate(const Expression& e, const NameLookup& lookup) {
  using Kind = Expression::Kind;
  if (e.kind == Kind::number) return e.number;
  if (e.kind == Kind::name) {
    if (e.name == "pi") return std::numbers::pi;
    if (e.name == "inf") return std::numeric_limits<double>::infinity();
    if (lookup) {
      if (const auto value = lookup(e.name)) return *value;
    }
    const FunctionInfo* const function = find_function(e.name);
    throw ExpressionError{e.column, fmt::format("'{}' is not a known constant", e.name),
                          lookup ? "" : "a number, 'pi' or 'inf'",
                          function == nullptr ? "" : fmt::format("a function needs its argument: {}(…)", e.name)};
  }
  std::vector<double> v;
  v.reserve(e.operands.size());
  for (const Expression& operand : e.operands) v.push_back(evaluate(operand, lookup));
  switch (e.kind) {
    case Kind::call: return evaluate(e.function, v);
    case Kind::negate: return -v[0];
    case Kind::add: return v[0] + v[1];
    case Kind::subtract: return v[0] - v[1];
    case Kind::multiply: return v[0] * v[1];
    case Kind::divide: return v[0] / v[1];
    case Kind::power: return std::pow(v[0], v[1]);
    case Kind::less: return v[0] < v[1] ? 1 : 0;
    case Kind::less_equal: return v[0] <= v[1] ? 1 : 0;
    case Kind::greater: return v[0] > v[1] ? 1 : 0;
    case Kind::greater_equal: return v[0] >= v[1] ? 1 : 0;
    case Kind::equal: return v[0] == v[1] ? 1 : 0;
    case Kind::not_equal: return v[0] != v[1] ? 1 : 0;
    case Kind::logical_and: return v[0] != 0 && v[1] != 0 ? 1 : 0;
    case Kind::logical_or: return v[0] != 0 || v[1] != 0 ? 1 : 0;
    case Kind::logical_not: return v[0] == 0 ? 1 : 0;
    case Kind::number:
    case Kind::name: break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

bool is_identifier(std::string_view text) {
  return !text.empty() && is_letter(text[0]) &&
         std::all_of(text.begin(), text.end(), [](char c) { return is_letter(c) || is_digit(c); });
}

}  // namespace oblique
