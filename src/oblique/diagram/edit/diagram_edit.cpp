// SPDX-License-Identifier: MIT
#include <oblique/diagram/edit/diagram_edit.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/edit/edited_text.h>
#include <oblique/diagram/edit/written_names.h>
#include <oblique/diagram/names.h>
#include <oblique/text/toml_edit.h>
#include <oblique/text/toml_text.h>
#include <oblique/text/trimmed.h>

namespace oblique::diagram {
namespace {

using text::TomlChange;
using text::TomlPath;
using text::Value;
using Changes = std::vector<TomlChange>;

/// Renames a block in all strings of a value.
void rename_in(const Value& value, const TomlPath& path, const std::string& block, const std::string& name,
               Changes& changes) {
  if (value.kind == Value::Kind::string) {
    std::string renamed = with_other_name(value.text, block, name);
    if (renamed != value.text) changes.push_back({TomlChange::Kind::set, path, text::toml_string(renamed)});
  }
  for (std::size_t k = 0; k < value.elements.size(); ++k) {
    TomlPath inner = path;
    inner.emplace_back(k);
    rename_in(value.elements[k], inner, block, name, changes);
  }
  for (const text::Entry& entry : value.entries) {
    TomlPath inner = path;
    inner.emplace_back(entry.key);
    rename_in(entry.value, inner, block, name, changes);
  }
}

/// The outputs of a diagram whose signal a block has.
std::vector<std::string> outputs_of(const Diagram& diagram, const std::string& block) {
  std::vector<std::string> names;
  for (const OutputSpec& output : diagram.outputs) {
    if (block_of(output.signal) == block) names.push_back(output.name);
  }
  return names;
}

}  // namespace

DiagramEdit::DiagramEdit(std::string text, std::string file, const BlockLibrary& library)
    : text_(std::move(text)), file_(std::move(file)), library_(&library) {}

std::string DiagramEdit::add(const std::string& type, const std::string& name) {
  const EditedText content(text_, file_, *library_);
  if (library_->find(type) == nullptr)
    refuse_edit(file_, fmt::format("there is no block type '{}'", type), {},
                text::suggest(type, library_->names()));
  std::string chosen = name;
  if (chosen.empty()) {
    std::string stem = type;
    std::replace_if(
        stem.begin(), stem.end(), [](char c) { return !is_name_character(c); }, '_');
    for (int number = 1; chosen.empty() || content.find_block(chosen) != nullptr; ++number)
      chosen = fmt::format("{}{}", stem, number);
  }
  text::Diagnostics diagnostics;
  check_name(chosen, "a block", {file_, {}}, diagnostics);
  diagnostics.throw_if_any<DiagramError>();
  if (content.find_block(chosen) != nullptr)
    refuse_edit(file_, fmt::format("there is a block '{}' already", chosen), "another name");
  text_ = text::edit_toml(
      text_, file_,
      {{TomlChange::Kind::set, {"blocks", chosen}, fmt::format("{{ type = {} }}", text::toml_string(type))}});
  return chosen;
}

void DiagramEdit::remove(const std::string& block) {
  std::string text = text_;
  {
    // one wire after the other: each changes the lists that the next one counts in
    const auto wire_from_it = [&](const EditedText& content) -> std::optional<Changes> {
      for (const std::string& name : content.block_names()) {
        if (name == block) continue;
        for (const WrittenWire& wire : content.wires(name)) {
          if (block_of(wire.signal) != block) continue;
          Changes changes;
          content.cut(name, wire, changes);
          return changes;
        }
      }
      return std::nullopt;
    };
    EditedText(text, file_, *library_).block(block);
    while (const auto changes = wire_from_it(EditedText(text, file_, *library_)))
      text = text::edit_toml(text, file_, *changes);
  }
  const EditedText content(text, file_, *library_);
  text::Diagnostics ignored;
  const Diagram diagram = parse_diagram(text, file_, ignored);
  Changes changes;
  const std::vector<std::string> shown = outputs_of(diagram, block);
  for (const std::string& output : shown)
    changes.push_back({TomlChange::Kind::remove, {"outputs", output}, {}});
  for (const Expectation& expectation : diagram.expectations) {
    const bool is_shown = std::find(shown.begin(), shown.end(), expectation.output) != shown.end();
    if (is_shown || (diagram.outputs.empty() && block_of(expectation.output) == block))
      changes.push_back({TomlChange::Kind::remove, {"expect", expectation.text}, {}});
  }
  if (const Value* const layout = content.find_table("layout")) {
    if (layout->find(block) != nullptr) changes.push_back({TomlChange::Kind::remove, {"layout", block}, {}});
  }
  changes.push_back({TomlChange::Kind::remove, {"blocks", block}, {}});
  text_ = text::edit_toml(text, file_, changes);
}

void DiagramEdit::rename(const std::string& block, const std::string& name) {
  const EditedText content(text_, file_, *library_);
  content.block(block);
  if (name == block) return;
  text::Diagnostics diagnostics;
  check_name(name, "a block", {file_, {}}, diagnostics);
  diagnostics.throw_if_any<DiagramError>();
  if (content.find_block(name) != nullptr)
    refuse_edit(file_, fmt::format("there is a block '{}' already", name), "another name");
  Changes changes;
  for (const std::string& other : content.block_names()) {
    for (const WrittenWire& wire : content.wires(other)) {
      const std::string renamed = with_other_name(wire.text, block, name);
      if (renamed == wire.text) continue;
      TomlPath path{"blocks", other, wire.key};
      if (wire.element) path.emplace_back(*wire.element);
      changes.push_back({TomlChange::Kind::set, std::move(path), text::toml_string(renamed)});
    }
  }
  for (const char* const table : {"outputs", "groups"}) {
    if (const Value* const found = content.find_table(table))
      rename_in(*found, {table}, block, name, changes);
  }
  std::erase_if(changes, [](const TomlChange& change) {  // the unit of an output names no signal
    return change.path.front() == TomlPath::value_type("outputs") && change.path.size() > 2 &&
           change.path.back() != TomlPath::value_type("signal");
  });
  if (const Value* const timeline = content.find_table("timeline")) {
    if (const Value* const phases = timeline->find("phases")) {
      for (std::size_t k = 0; k < phases->elements.size(); ++k) {
        if (const Value* const until = phases->elements[k].find("until"))
          rename_in(*until, {"timeline", "phases", k, "until"}, block, name, changes);
      }
    }
  }
  const auto rename_key = [&](const Value* table, TomlPath path, const std::string& key,
                              const std::string& to) {
    if (table == nullptr || table->find(key) == nullptr) return;
    path.emplace_back(key);
    changes.push_back({TomlChange::Kind::rename, std::move(path), to});
  };
  // "x.in[2]" of settings, "x at 4" of expectations
  const auto rename_keys = [&](const Value* table, const TomlPath& path) {
    if (table == nullptr) return;
    for (const text::Entry& entry : table->entries) {
      if (entry.key.substr(0, entry.key.find_first_of(" .")) == block)
        rename_key(table, path, entry.key, name + entry.key.substr(block.size()));
    }
  };
  rename_key(content.find_table("layout"), {"layout"}, block, name);
  if (const Value* const run = content.find_table("run"))
    rename_keys(run->find("tolerances"), {"run", "tolerances"});
  text::Diagnostics ignored;
  const bool shows_signals = parse_diagram(text_, file_, ignored).outputs.empty();
  if (shows_signals) rename_keys(content.find_table("expect"), {"expect"});
  for (const auto& [table, list] : {std::pair("published", "value"), {"lesson", "step"}}) {
    const Value* const found = content.find_table(table);
    const Value* const elements = found == nullptr ? nullptr : found->find(list);
    if (elements == nullptr) continue;
    for (std::size_t k = 0; k < elements->elements.size(); ++k) {
      const Value& element = elements->elements[k];
      rename_keys(element.find("set"), {table, list, k, "set"});
      if (!shows_signals) continue;
      rename_keys(element.find("expect"), {table, list, k, "expect"});
      if (const Value* const shown = element.find("name"))
        rename_in(*shown, {table, list, k, "name"}, block, name, changes);
    }
  }
  if (const Value* const published = content.find_table("published"); published != nullptr && shows_signals) {
    if (const Value* const plot = published->find("plot"))
      rename_in(*plot, {"published", "plot"}, block, name, changes);
  }
  if (const Value* const lesson = content.find_table("lesson")) {
    if (const Value* const question = lesson->find("question")) {
      if (const Value* const answer = question->find("answer"))
        rename_in(*answer, {"lesson", "question", "answer"}, block, name, changes);
      if (shows_signals) rename_keys(question->find("expect"), {"lesson", "question", "expect"});
    }
  }
  rename_key(content.find_table("blocks"), {"blocks"}, block, name);
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::connect(const std::string& signal, const std::string& block, const std::string& port,
                          double weight) {
  const EditedText content(text_, file_, *library_);
  content.block(std::string(block_of(signal)));
  const BlockDefinition* const definition = content.definition(content.block(block));
  if (definition == nullptr)
    refuse_edit(file_, fmt::format("the type of block '{}' is not known", block),
                "a block type that there is", "set its type first");
  const auto input = definition->find_input(port);
  if (!input) {
    std::vector<std::string> ports;
    for (const InputPort& known : definition->inputs) ports.push_back(known.name);
    refuse_edit(file_, fmt::format("block '{}' ({}) has no input '{}'", block, definition->name, port), {},
                text::suggest(port, ports));
  }
  if (!(std::isfinite(weight) && weight != 0))
    refuse_edit(file_, fmt::format("the weight of a wire is {}", weight), "a finite number other than 0");
  const std::string wire = text::toml_string(to_string(WeightedSignal{weight, signal}));
  const std::vector<WrittenWire> there = content.wires(block, port);
  const bool adds = definition->inputs[*input].sum;
  Changes changes;
  if (there.empty()) {
    // an empty list, or none yet
    const Value* const list = content.block(block).find("in");
    const bool by_in = definition->inputs.size() == 1 && (list != nullptr || port == "in");
    changes.push_back({TomlChange::Kind::set,
                       {"blocks", block, by_in ? std::string("in") : port},
                       adds ? "[" + wire + "]" : wire});
  } else if (const WrittenWire& last = there.back(); !adds || !last.element) {
    TomlPath path{"blocks", block, last.key};
    if (last.element) path.emplace_back(*last.element);
    changes.push_back({TomlChange::Kind::set, std::move(path),
                       adds ? fmt::format("[{}, {}]", text::toml_string(last.text), wire) : wire});
  } else {
    changes.push_back({TomlChange::Kind::set, {"blocks", block, last.key, *last.element + 1}, wire});
  }
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::disconnect(const std::string& block, const std::string& port, std::size_t term) {
  const EditedText content(text_, file_, *library_);
  Changes changes;
  content.cut(block, content.wire(block, port, term), changes);
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::weigh(const std::string& block, const std::string& port, std::size_t term, double weight) {
  const EditedText content(text_, file_, *library_);
  const WrittenWire wire = content.wire(block, port, term);
  if (wire.signal.empty())
    refuse_edit(file_, fmt::format("'{}' names no signal, or several", wire.text), "a wire with one signal",
                "disconnect it, or change it in the text");
  if (!(std::isfinite(weight) && weight != 0))
    refuse_edit(file_, fmt::format("the weight of a wire is {}", weight), "a finite number other than 0",
                "disconnect it where it is to carry nothing");
  TomlPath path{"blocks", block, wire.key};
  if (wire.element) path.emplace_back(*wire.element);
  text_ = text::edit_toml(text_, file_,
                          {{TomlChange::Kind::set, std::move(path),
                            text::toml_string(to_string(WeightedSignal{weight, wire.signal}))}});
}

void DiagramEdit::set(const std::string& block, const std::string& key, const std::string& value) {
  const EditedText content(text_, file_, *library_);
  const Value& found = content.block(block);
  const std::string written = text::trimmed(value);
  if (written.empty()) {
    if (found.find(key) != nullptr)
      text_ = text::edit_toml(text_, file_, {{TomlChange::Kind::remove, {"blocks", block, key}, {}}});
    return;
  }
  const bool is_word = key == "label" || key == "type";
  text_ = text::edit_toml(text_, file_,
                          {{TomlChange::Kind::set,
                            {"blocks", block, key},
                            is_word ? text::toml_string(written) : text::toml_value(written)}});
}

void DiagramEdit::set_head(const std::string& path, const std::string& value) {
  const auto dot = path.find('.');
  TomlPath entry;
  if (dot != std::string::npos) entry.emplace_back(path.substr(0, dot));
  entry.emplace_back(dot == std::string::npos ? path : path.substr(dot + 1));
  const std::string written = text::trimmed(value);
  const text::Document document = text::parse_document(text_, file_);
  const Value* const table =
      dot == std::string::npos ? &document.root : document.root.find(path.substr(0, dot));
  const bool is_there = table != nullptr && table->find(std::get<std::string>(entry.back())) != nullptr;
  if (written.empty() && !is_there) return;
  const bool is_word = path == "title" || path == "source";
  text_ =
      text::edit_toml(text_, file_,
                      {{written.empty() ? TomlChange::Kind::remove : TomlChange::Kind::set, std::move(entry),
                        written.empty() ? ""
                        : is_word       ? text::toml_string(written)
                                        : text::toml_value(written)}});
}

void DiagramEdit::place(const std::vector<BlockPlace>& places) {
  const EditedText content(text_, file_, *library_);
  Changes changes;
  changes.reserve(places.size());
  for (const BlockPlace& at : places) {
    content.block(at.name);
    changes.push_back({TomlChange::Kind::set, {"layout", at.name}, fmt::format("[{}, {}]", at.x, at.y)});
  }
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::show(const std::string& output, const std::string& signal) {
  const EditedText content(text_, file_, *library_);
  const Value* const outputs = content.find_table("outputs");
  const Value* const there = outputs == nullptr ? nullptr : outputs->find(output);
  if (signal.empty()) {
    if (there != nullptr)
      text_ = text::edit_toml(text_, file_, {{TomlChange::Kind::remove, {"outputs", output}, {}}});
    return;
  }
  TomlPath path{"outputs", output};
  if (there != nullptr && there->kind == Value::Kind::table) path.emplace_back("signal");
  text_ =
      text::edit_toml(text_, file_, {{TomlChange::Kind::set, std::move(path), text::toml_string(signal)}});
}

}  // namespace oblique::diagram
