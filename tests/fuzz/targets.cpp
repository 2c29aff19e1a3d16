// SPDX-License-Identifier: MIT
#include "targets.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include <oblique/text/document.h>
#include <oblique/text/expression_parser.h>
#include <oblique/text/expression_printer.h>
#include <oblique/text/quantity.h>

#include "whole_way.h"

namespace oblique::fuzz {
namespace {

void require(bool promise, const char* what) {
  if (promise) return;
  std::fprintf(stderr, "broken promise: %s\n", what);
  std::abort();
}

bool holds_infinite_number(const text::Expression& e) {
  if (e.kind == text::Expression::Kind::number && !std::isfinite(e.number)) return true;
  for (const text::Expression& operand : e.operands) {
    if (holds_infinite_number(operand)) return true;
  }
  return false;
}

}  // namespace

void document(std::string_view bytes) {
  try {
    text::parse_document(bytes, "fuzz.toml");
  } catch (const text::ReadError& error) {
    require(error.diagnostics().size() == 1, "broken TOML is one finding");
    require(error.diagnostics()[0].place.position.line > 0, "broken TOML has a place");
  }
}

void expression(std::string_view bytes) {
  try {
    const text::Expression e = text::parse_expression(bytes);
    require(!holds_infinite_number(e), "a number in the text of an expression is finite");
    const std::string text = text::to_string(e);
    require(text::parse_expression(text) == e, "an expression is printed and read back unchanged");
    text::evaluate(e, [](std::string_view name) { return std::optional(static_cast<double>(name.size())); });
  } catch (const text::ExpressionError& error) {
    require(error.column >= 1 && static_cast<std::size_t>(error.column) <= bytes.size() + 1,
            "a column lies in the text");
  }
  try {
    text::parse_quantity(bytes, text::parse_unit("rad/s").value());
  } catch (const text::ExpressionError& error) {
    require(error.column >= 1 && static_cast<std::size_t>(error.column) <= bytes.size() + 1,
            "a column lies in the text");
  }
}

void diagram(std::string_view bytes) {
  const Verdict verdict = examine_diagram(bytes);
  require(verdict.fault.empty(), verdict.fault.c_str());
}

void mechanism(std::string_view bytes) {
  const Verdict verdict = examine_mechanism(bytes);
  require(verdict.fault.empty(), verdict.fault.c_str());
}

}  // namespace oblique::fuzz
