// SPDX-License-Identifier: MIT
#include <oblique/solve/run_state.h>

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/network/program/program.h>
#include <oblique/text/table_reader.h>

namespace oblique::solve {
namespace {

void write_numbers(std::string_view table, const RunState::Named& values, std::string& out) {
  out += fmt::format("\n[{}]\n", table);
  for (const auto& [name, value] : values) {
    std::string key;
    for (const char c : name) {
      if (c == '"' || c == '\\') key += '\\';
      key += c;
    }
    out += fmt::format("\"{}\" = {}\n", key, value);
  }
}

void write_flags(std::string_view key, const std::vector<bool>& flags, std::string& out) {
  out += fmt::format("{} = [{}]\n", key, fmt::join(std::vector<int>(flags.begin(), flags.end()), ", "));
}

RunState::Named read_numbers(text::TableReader& reader, std::string_view name, const std::string& file,
                             text::Diagnostics& diagnostics) {
  RunState::Named values;
  const text::Value* const table = reader.table(name);
  if (table == nullptr) {
    if (reader.table().find(name) == nullptr) reader.report(name, fmt::format("the state has no [{}]", name));
    return values;
  }
  for (const text::Entry& entry : table->entries) {
    if (entry.value.kind != text::Value::Kind::number) {
      diagnostics.add({{file, entry.value.position},
                       fmt::format("'{}' is {}", entry.key, text::kind_name(entry.value.kind)),
                       "a number",
                       {}});
    }
    values.emplace_back(entry.key, entry.value.number);
  }
  return values;
}

/// An array of numbers that are 0 or not; empty where there is none.
std::vector<bool> read_flags(text::TableReader& reader, std::string_view key,
                             text::Diagnostics& diagnostics) {
  std::vector<bool> values;
  const text::Value* const list = reader.find(key);
  if (list == nullptr) return values;
  if (list->kind != text::Value::Kind::array) {
    reader.report(key, fmt::format("'{}' is {}", key, text::kind_name(list->kind)), "an array of numbers");
    return values;
  }
  for (const text::Value& element : list->elements) {
    if (element.kind != text::Value::Kind::number)
      diagnostics.add({reader.place(element.position),
                       fmt::format("an element of '{}' is {}", key, text::kind_name(element.kind)),
                       "a number",
                       {}});
    values.push_back(element.number != 0);
  }
  return values;
}

/// The first name in which two lists differ, for a message.
template <class Things>
void compare_names(const RunState::Named& saved, const Things& things, std::string_view what,
                   const std::string& file) {
  const std::size_t common = std::min(saved.size(), things.size());
  std::size_t i = 0;
  while (i < common && saved[i].first == things[i].name) ++i;
  if (i == saved.size() && i == things.size()) return;
  std::string difference;
  if (i < saved.size() && i < things.size()) {
    difference = fmt::format("the {} '{}' where the diagram has '{}'", what, saved[i].first, things[i].name);
  } else if (i < saved.size()) {
    difference = fmt::format("a {} '{}' that the diagram does not have", what, saved[i].first);
  } else {
    difference = fmt::format("no {} '{}'", what, things[i].name);
  }
  throw text::ReadError(text::Diagnostic{{file, {}},
                                         "this is the state of another diagram: it has " + difference,
                                         "the state of a run of this diagram",
                                         "parameters may change between runs, blocks and wires may not"});
}

void compare_counts(std::size_t saved, std::size_t here, std::string_view what, const std::string& file) {
  if (saved == here) return;
  throw text::ReadError(text::Diagnostic{
      {file, {}},
      fmt::format("this is the state of another diagram: it has {} {}, the diagram {}", saved, what, here),
      "the state of a run of this diagram",
      {}});
}

}  // namespace

std::string to_text(const RunState& state) {
  std::string out = "# Where a run stood, and from where it goes on.\nformat = \"oblique-state/1\"\n";
  out += fmt::format("time = {}\n", state.time);
  write_flags("conditions", state.conditions, out);
  write_flags("sliding", state.sliding, out);
  out += fmt::format("\n[timeline]\nphase = {}\ncycle = {}\nbegin = {}\n", state.position.phase,
                     state.position.cycle, state.position.begin);
  write_numbers("states", state.states, out);
  write_numbers("unknowns", state.unknowns, out);
  write_numbers("memories", state.memories, out);
  return out;
}

RunState parse_run_state(std::string_view text, const std::string& file) {
  const text::Document document = text::parse_document(text, file);
  text::Diagnostics diagnostics;
  text::TableReader reader(file, document.root, "the state", diagnostics);
  const auto format = reader.required_string("format", "format = \"oblique-state/1\"");
  if (format && *format != "oblique-state/1")
    reader.report("format", fmt::format("the format is '{}'", *format),
                  "'oblique-state/1', the state of a run");
  diagnostics.throw_if_any<text::ReadError>();
  RunState state;
  state.time = reader.required_quantity("time", "s").value_or(0);
  state.conditions = read_flags(reader, "conditions", diagnostics);
  state.sliding = read_flags(reader, "sliding", diagnostics);
  if (const text::Value* const table = reader.table("timeline")) {
    text::TableReader timeline(file, *table, "[timeline]", diagnostics);
    state.position.phase = static_cast<std::size_t>(timeline.required_quantity("phase", "1").value_or(0));
    state.position.cycle = timeline.required_quantity("cycle", "1").value_or(0);
    state.position.begin = timeline.required_quantity("begin", "s").value_or(0);
    timeline.finish();
  }
  state.states = read_numbers(reader, "states", file, diagnostics);
  state.unknowns = read_numbers(reader, "unknowns", file, diagnostics);
  state.memories = read_numbers(reader, "memories", file, diagnostics);
  reader.finish();
  diagnostics.throw_if_any<text::ReadError>();
  return state;
}

void check_run_state(const RunState& state, const network::Program& program, const std::string& file) {
  compare_names(state.states, program.states(), "state", file);
  compare_names(state.unknowns, program.unknowns(), "unknown", file);
  compare_names(state.memories, program.discrete_states(), "memory", file);
  compare_counts(state.conditions.size(), program.events().size(), "conditions of events", file);
  if (!state.sliding.empty())
    compare_counts(state.sliding.size(), program.switches().size(), "switches", file);
}

}  // namespace oblique::solve
