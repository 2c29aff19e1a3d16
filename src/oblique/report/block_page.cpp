// SPDX-License-Identifier: MIT
#include <oblique/report/block_page.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/report/text_table.h>
#include <oblique/text/expression_printer.h>

namespace oblique::report {
namespace {

std::string range_of(const diagram::ParameterDefinition& p) {
  std::string text;
  const auto add = [&](std::string_view words, const std::optional<double>& limit) {
    if (limit) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", words, *limit);
  };
  add("above", p.above);
  add("at least", p.at_least);
  add("below", p.below);
  add("at most", p.at_most);
  return text;
}

/// The part of a block's file that says what it does, without the tables that stand above it already.
std::string definition_of(const diagram::BlockDefinition& block) {
  std::size_t begin = block.text.size();
  for (const std::string_view section : {"\n[requires]", "\n[let]", "\n[equations]", "\n[implicit]",
                                         "\n[[cases]]", "\n[machine]", "\n[blocks]"}) {
    begin = std::min(begin, block.text.find(section));
  }
  return begin < block.text.size() ? block.text.substr(begin + 1) : block.text;
}

}  // namespace

std::string block_list(const diagram::BlockLibrary& library, const text::Vocabulary& vocabulary) {
  Table table({"block", "what it does"});
  for (const std::string& name : library.names()) table.add({name, library.find(name)->summary});
  return table.text(2) + "\n" + vocabulary.action({"blocks", "NAME"}) + " tells all about one.\n";
}

std::string to_text(const diagram::BlockDefinition& block) {
  std::string text = fmt::format("{} ({})\n{}\n", block.title, block.name, block.summary);
  if (!block.doc.empty()) text += fmt::format("\n{}\n", block.doc);
  if (!block.inputs.empty()) {
    Table table({"input", "takes", "meaning"});
    for (const diagram::InputPort& p : block.inputs)
      table.add({p.name, p.sum ? "a sum" : "one signal", p.doc});
    text += table.text(3) + "\n";
  }
  Table outputs({"output", "meaning"});
  for (const diagram::OutputPort& p : block.outputs) outputs.add({p.name, p.doc});
  text += outputs.text(2);
  if (!block.parameters.empty()) {
    Table table({"parameter", "default", "unit", "range", "meaning"});
    for (const diagram::ParameterDefinition& p : block.parameters) {
      table.add({p.name, p.formula ? text::to_string(*p.formula) : short_number(p.default_value), p.unit,
                 range_of(p), p.doc});
    }
    text += "\n" + table.text(5);
  }
  if (!block.source.empty()) text += fmt::format("\nsource: {}\n", block.source);
  return text + "\n" + definition_of(block);
}

}  // namespace oblique::report
