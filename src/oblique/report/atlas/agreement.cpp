// SPDX-License-Identifier: MIT
#include <oblique/report/atlas/agreement.h>

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/flatten.h>
#include <oblique/diagram/published.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/report/run_chart.h>
#include <oblique/text/document.h>

namespace oblique::report {

std::vector<std::filesystem::path> programmes_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  std::error_code trouble;
  for (std::filesystem::recursive_directory_iterator entry(folder, trouble), end; !trouble && entry != end;
       entry.increment(trouble)) {
    if (entry->path().extension() != ".toml") continue;
    const text::Document document = text::read_document(entry->path());
    const text::Value* const format = document.root.find("format");
    if (format != nullptr && format->text == "oblique-diagram/1" &&
        document.root.find("published") != nullptr)
      files.push_back(entry->path());
  }
  if (trouble)
    throw text::ReadError(text::Diagnostic{
        {folder.string(), {}}, fmt::format("cannot read the folder: {}", trouble.message()), {}, {}});
  if (files.empty())
    throw text::ReadError(text::Diagnostic{{folder.string(), {}},
                                           "no diagram in this folder says where it was published",
                                           "diagrams with [published]",
                                           {}});
  std::sort(files.begin(), files.end());
  std::map<std::string, std::filesystem::path> names;
  for (const std::filesystem::path& file : files) {
    const auto [other, is_new] = names.emplace(file.stem().string(), file);
    if (is_new) continue;
    throw text::ReadError(
        text::Diagnostic{{file.string(), {}},
                         fmt::format("this programme is called as that of {}", other->second.string()),
                         "another name of the file",
                         {}});
  }
  return files;
}

Programme run_programme(const std::filesystem::path& file, std::string text,
                        const diagram::BlockLibrary& library) {
  Programme programme;
  programme.name = file.stem().string();
  programme.text = std::move(text);
  programme.diagram = diagram::parse_diagram(programme.text, file.string());
  const diagram::Diagram& diagram = programme.diagram;
  const diagram::FlatDiagram flat = diagram::flatten(diagram, library);
  std::vector<diagram::Expectation> asked = published_expectations(diagram);
  asked.insert(asked.end(), diagram.expectations.begin(), diagram.expectations.end());
  solve::RunOptions options = solve::options_of(diagram.run);
  ask_for_expectations(asked, diagram.file, options);
  ask_for_curves(options, flat.outputs.size() + 1);
  programme.run = solve::run(network::Program(network::assemble(flat)), flat, options);
  programme.results = check_published(diagram, library, {}, programme.run);
  programme.expected = check_expectations(diagram, programme.run);
  return programme;
}

Table agreement_table(const std::vector<Programme>& programmes) {
  Table table({"programme", "value", "published", "±", "unit", "computed", "difference/±", ""});
  for (const Programme& programme : programmes) {
    for (const PublishedResult& result : programme.results) {
      const diagram::PublishedValue& value = result.value;
      const auto output =
          std::find_if(programme.diagram.outputs.begin(), programme.diagram.outputs.end(),
                       [&](const diagram::OutputSpec& spec) { return spec.name == value.expected.output; });
      const std::string own =
          output == programme.diagram.outputs.end() ? diagram::OutputSpec{}.unit : output->unit;
      const std::string unit = value.unit.empty() ? own : value.unit;
      table.add({programme.name, diagram::name_of(value), fmt::format("{}", value.expected.value),
                 fmt::format("{}", value.expected.within), unit == "1" ? "" : unit,
                 number_within(result.actual, value.expected.within),
                 fmt::format("{:.2g}", result.in_uncertainties()),
                 result.met()            ? ""
                 : result.is_explained() ? "explained"
                 : result.is_known()     ? "not explained"
                                         : "DIFFERS"});
    }
  }
  return table;
}

std::string agreement_summary(const std::vector<Programme>& programmes) {
  std::size_t values = 0, agree = 0, explained = 0, pictures = 0, composed = 0;
  for (const Programme& programme : programmes) {
    for (const PublishedResult& result : programme.results) {
      ++values;
      if (result.met()) ++agree;
      if (!result.met() && result.is_explained()) ++explained;
    }
    if (programme.results.empty() && !programme.diagram.published->picture.empty()) ++pictures;
    if (programme.diagram.published->kind == diagram::Published::Kind::equations) ++composed;
  }
  std::string text =
      fmt::format("{}, {}: {} within their uncertainty, {} beyond it and explained, {} unexplained",
                  count(programmes.size(), "programme", "programmes"),
                  count(values, "published value", "published values"), agree, explained,
                  agree + explained == values ? "none" : fmt::format("{}", values - agree - explained));
  if (pictures > 0)
    text += fmt::format("; {} held against a picture alone", count(pictures, "programme", "programmes"));
  if (composed > 0)
    text += fmt::format("; {} without a published result", count(composed, "programme", "programmes"));
  return text;
}

bool all_known(const std::vector<Programme>& programmes) {
  return std::all_of(programmes.begin(), programmes.end(), [](const Programme& programme) {
    return std::all_of(programme.results.begin(), programme.results.end(),
                       [](const PublishedResult& result) { return result.is_known(); });
  });
}

}  // namespace oblique::report
