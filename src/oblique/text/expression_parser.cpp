// SPDX-License-Identifier: MIT
#include <oblique/text/expression_parser.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/text/decimal.h>
#include <oblique/text/decimal_comma.h>
#include <oblique/text/expression_grammar.h>

namespace oblique::text {
namespace {

[[noreturn]] void fail(std::size_t offset, std::string what, std::string expected = {},
                       std::string remedy = {}) {
  throw ExpressionError{static_cast<int>(offset) + 1, std::move(what), std::move(expected),
                        std::move(remedy)};
}

/// The first characters of a text, for a message.
std::string excerpt(std::string_view text) {
  constexpr std::size_t kMost = 20;
  if (text.size() <= kMost) return std::string(text);
  std::size_t end = kMost;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0) == 0x80) --end;
  return std::string(text.substr(0, end)) + "…";
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
    for (std::size_t space = 1; space > 0; at_ += space) space = space_at(text_, at_);
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
    if (const std::size_t minus = minus_at(text_, at_); minus > 0) {
      at_ += minus;
      return negation(offset);
    }
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
    const auto [end, error] = read_decimal(begin, text_.data() + text_.size(), node.number);
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
      std::vector<std::string> names(functions().size());
      std::transform(functions().begin(), functions().end(), names.begin(),
                     [](const FunctionInfo& f) { return f.name; });
      fail(start, fmt::format("there is no function '{}'", node.name), {}, suggest(node.name, names));
    }
    node.kind = Expression::Kind::call;
    node.function = info->function;
    node.name.clear();
    if (!take(')')) {
      do node.operands.push_back(parse());
      while (take(','));
      if (!take(')'))
        fail(at_, fmt::format("the parenthesis after {} is not closed", info->name), "',' or ')'");
    }
    const std::size_t count = node.operands.size();
    if (count < info->min_arguments || count > info->max_arguments) {
      const bool comma = count > info->max_arguments && has_decimal_comma(text_.substr(start, at_ - start));
      fail(start, fmt::format("{} was given {} argument{}", info->name, count, count == 1 ? "" : "s"),
           argument_range(*info),
           std::string(info->doc) + (comma ? "; a number has a decimal point, not a comma" : ""));
    }
    const bool points = count == 2 && node.operands[1].kind == Expression::Kind::name;
    if (info->function == Function::table && !points && (count < 5 || count % 2 == 0)) {
      fail(start, count < 5 ? "the table has no two points" : "a point of the table has no second coordinate",
           {}, std::string(info->doc));
    }
    return node;
  }

  /// Whether some comma of it stands between two digits.
  static bool has_decimal_comma(std::string_view call) {
    for (std::size_t k = 1; k < call.size(); ++k) {
      if (is_digit(call[k - 1]) && is_decimal_comma(call, k)) return true;
    }
    return false;
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

}  // namespace

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
    if (is_decimal_comma(text, rest)) throw decimal_comma(text, rest);
    const bool product = is_letter(text[rest]) || is_digit(text[rest]) || text[rest] == '(';
    fail(rest, fmt::format("'{}' does not belong here", excerpt(text.substr(rest))), "an operator or the end",
         product ? "a product is written with '*'" : "");
  }
  return expression;
}

}  // namespace oblique::text
