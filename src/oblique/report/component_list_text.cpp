// SPDX-License-Identifier: MIT
#include <oblique/report/component_list_text.h>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace oblique::report {
namespace {

std::string available_text(const machine::ComponentListRow& row) {
  if (!row.exists) return "none";
  if (!row.available) return "not published";
  return std::isinf(*row.available) ? "as many as it takes" : fmt::format("{}", *row.available);
}

}  // namespace

std::string verdict_text(const machine::ComponentList& components) {
  std::vector<std::string> named, blocks;
  switch (components.verdict()) {
    case machine::ComponentList::Verdict::fits:
      return "it fits";
    case machine::ComponentList::Verdict::does_not_fit:
      for (const machine::ComponentListRow& row : components.rows) {
        if (row.missing() > 0)
          (row.is_block ? blocks : named).push_back(fmt::format("{} ({})", row.element, row.missing()));
      }
      if (blocks.empty()) return fmt::format("it does not fit; missing: {}", fmt::join(named, ", "));
      return fmt::format("as it is drawn it has blocks that are no elements: {}{}{}", fmt::join(blocks, ", "),
                         named.empty() ? "" : "; missing: ", fmt::join(named, ", "));
    case machine::ComponentList::Verdict::cannot_tell:
      break;
  }
  for (const machine::ComponentListRow& row : components.rows) {
    if (row.at_least) {
      named.emplace_back("what its inputs weigh");
    } else if (!row.available) {
      named.push_back("how many " + row.element);
    }
  }
  return fmt::format("whether it fits cannot be told; not published: {}", fmt::join(named, ", "));
}

Table component_list_table(const machine::ComponentList& components) {
  Table table({"element", "needed", "available", "missing"});
  for (const machine::ComponentListRow& row : components.rows) {
    table.add({row.note.empty() ? row.element : fmt::format("{} ({})", row.element, row.note),
               fmt::format("{}{}", row.at_least ? "≥ " : "", row.needed), available_text(row),
               row.missing() > 0 ? fmt::format("{}", row.missing()) : ""});
  }
  return table;
}

std::string to_text(const machine::ComponentList& components) {
  return fmt::format("elements of {}\n{}{}\n", components.machine, component_list_table(components).text(1),
                     verdict_text(components));
}

}  // namespace oblique::report
