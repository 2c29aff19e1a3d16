// SPDX-License-Identifier: MIT
#include "terminal/table_output.h"

#include <algorithm>

#include <fmt/format.h>

#include <oblique/text/diagnostic.h>

#include "terminal/output_files.h"
#include "terminal/terminal.h"

namespace oblique::cli {

void check_table_output(const std::string& file, const std::vector<std::string>& columns) {
  if (!file.empty()) check_output(file, text::kTableEndings);
  if (file.empty() && !columns.empty()) {
    throw text::ReadError(text::Diagnostic{
        {}, "--columns chooses what a file holds, and there is none", "-o FILE beside it", {}});
  }
}

ColumnChoice::ColumnChoice(std::vector<text::TableColumn> all, const std::vector<std::string>& names)
    : width_(all.size()) {
  if (names.empty()) {
    columns_ = std::move(all);
    return;
  }
  for (const std::string& name : names) {
    const auto found =
        std::find_if(all.begin(), all.end(), [&](const text::TableColumn& c) { return c.name == name; });
    if (found == all.end()) {
      std::vector<std::string> known;
      known.reserve(all.size());
      for (const text::TableColumn& column : all) known.push_back(column.name);
      throw text::ReadError(text::Diagnostic{
          {}, fmt::format("--columns: there is no column '{}'", name), {}, text::suggest(name, known)});
    }
    columns_.push_back(*found);
    indices_.push_back(static_cast<std::size_t>(found - all.begin()));
  }
}

TableOutput::TableOutput(const std::filesystem::path& path, const ColumnChoice& choice, std::size_t rows)
    : path_(path), choice_(choice), file_(path, choice.columns(), rows) {}

void TableOutput::add(std::span<const double> rows) {
  if (choice_.indices().empty()) {
    file_.add(rows);
    return;
  }
  for (; !rows.empty(); rows = rows.subspan(choice_.width())) {
    row_.clear();
    for (const std::size_t index : choice_.indices()) row_.push_back(rows[index]);
    file_.add(row_);
  }
}

void TableOutput::finish() {
  file_.finish();
  note(fmt::format("wrote {}\n", path_.string()));
}

}  // namespace oblique::cli
