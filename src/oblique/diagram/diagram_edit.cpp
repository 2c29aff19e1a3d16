// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram_edit.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/names.h>
#include <oblique/text/expression.h>
#include <oblique/text/toml_edit.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {
namespace {

using text::TomlChange;
using text::TomlPath;
using text::Value;
using Changes = std::vector<TomlChange>;

[[noreturn]] void refuse_edit(const std::string& file, std::string what, std::string expected,
                              text::Remedy remedy = {}) {
  throw DiagramError(text::Diagnostic{{file, {}}, std::move(what), std::move(expected), std::move(remedy)});
}

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// The names in an expression that are no functions, each with where it begins: "c", "b.cos".
std::vector<std::pair<std::size_t, std::string>> written_names(const std::string& text) {
  std::vector<std::pair<std::size_t, std::string>> names;
  for (std::size_t at = 0; at < text.size();) {
    if (!is_name_character(text[at])) {
      ++at;
      continue;
    }
    std::size_t end = at;
    while (end < text.size() && (is_name_character(text[end]) || text[end] == '.')) ++end;
    const bool is_number = text[at] >= '0' && text[at] <= '9';
    const std::size_t next = text.find_first_not_of(' ', end);
    const bool is_function = next != std::string::npos && text[next] == '(';
    if (!is_number && !is_function) names.emplace_back(at, text.substr(at, end - at));
    at = end;
  }
  return names;
}

/// The block that a path of names begins with.
std::string_view block_of(std::string_view signal) {
  return signal.substr(0, signal.find('.'));
}

std::string signal_in(const std::string& wire) {
  std::string signal;
  for (const auto& [at, name] : written_names(wire)) {
    if (name == "pi" || name == "inf") continue;
    if (!signal.empty()) return {};
    signal = name;
  }
  return signal;
}

/// An expression in which a block has another name.
std::string with_other_name(const std::string& text, const std::string& block, const std::string& name) {
  std::string result;
  std::size_t copied = 0;
  for (const auto& [at, written] : written_names(text)) {
    if (block_of(written) != block) continue;
    result += text.substr(copied, at - copied) + name;
    copied = at + block.size();
  }
  return result + text.substr(copied);
}

bool is_toml_number(const std::string& text) {
  std::size_t at = !text.empty() && (text[0] == '-' || text[0] == '+') ? 1 : 0;
  const auto digits = [&] {
    const std::size_t begin = at;
    while (at < text.size() && text[at] >= '0' && text[at] <= '9') ++at;
    return at > begin;
  };
  const std::size_t first = at;
  if (!digits()) return false;
  if (text[first] == '0' && at > first + 1) return false;
  if (at < text.size() && text[at] == '.') {
    ++at;
    if (!digits()) return false;
  }
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    ++at;
    if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
    if (!digits()) return false;
  }
  constexpr std::size_t kLongest = 300;  // longer ones are texts, which tell what is wrong with them
  return at == text.size() && at < kLongest;
}

/// What a person writes as a value, as TOML has it.
std::string value_as_toml(const std::string& value) {
  if (is_toml_number(value) || value == "true" || value == "false") return value;
  if (value.front() == '[' || value.front() == '{') {
    try {
      text::parse_document("value = " + value, {});
      return value;
    } catch (const text::ReadError&) {
      return text::toml_string(value);
    }
  }
  return text::toml_string(value);
}

std::string trimmed_value(std::string_view value) {
  const auto first = value.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return {};
  return std::string(value.substr(first, value.find_last_not_of(" \t\r\n") - first + 1));
}

/// A text as it is read, wrong or not.
class Content {
 public:
  Content(const std::string& text, const std::string& file, const BlockLibrary& library)
      : file_(file), library_(library), root_(text::parse_document(text, file).root) {}

  const Value* find_table(const char* name) const {
    const Value* const table = root_.find(name);
    return table != nullptr && table->kind == Value::Kind::table ? table : nullptr;
  }
  std::vector<std::string> block_names() const {
    std::vector<std::string> names;
    if (const Value* const blocks = find_table("blocks")) {
      names.reserve(blocks->entries.size());
      for (const text::Entry& entry : blocks->entries) names.push_back(entry.key);
    }
    return names;
  }
  const Value* find_block(const std::string& name) const {
    const Value* const blocks = find_table("blocks");
    return blocks == nullptr ? nullptr : blocks->find(name);
  }
  const Value& block(const std::string& name) const {
    if (const Value* const found = find_block(name)) return *found;
    refuse_edit(file_, fmt::format("there is no block '{}'", name), "the name of a block of this file",
                text::suggest(name, block_names()));
  }
  const BlockDefinition* definition(const Value& block) const {
    const Value* const type = block.find("type");
    return type == nullptr ? nullptr : library_.find(type->text);
  }
  std::vector<WrittenWire> wires(const std::string& name) const {
    const Value& found = block(name);
    std::vector<text::Entry> settings;
    for (const text::Entry& entry : found.entries) {
      if (entry.key != "type" && entry.key != "label") settings.push_back(entry);
    }
    return wires_of(settings, definition(found));
  }
  std::vector<WrittenWire> wires(const std::string& name, const std::string& port) const {
    std::vector<WrittenWire> all = wires(name);
    std::erase_if(all, [&](const WrittenWire& wire) { return wire.port != port; });
    return all;
  }
  WrittenWire wire(const std::string& name, const std::string& port, std::size_t term) const {
    const auto all = wires(name, port);
    if (term < all.size()) return all[term];
    refuse_edit(file_, fmt::format("input '{}.{}' has no wire number {}", name, port, term + 1),
                fmt::format("one of its {} wires", all.size()));
  }

  /// Takes a wire away; the others of a list that counts inputs then stand under the names of theirs.
  void cut(const std::string& name, const WrittenWire& wire, Changes& changes) const {
    const TomlPath setting{"blocks", name, wire.key};
    std::vector<WrittenWire> others = wires(name);
    std::erase_if(others, [&](const WrittenWire& other) {
      return other.key != wire.key || other.element == wire.element;
    });
    if (others.empty()) {
      changes.push_back({TomlChange::Kind::remove, setting, {}});
      return;
    }
    const bool counts_inputs = others.front().port != wire.port || others.back().port != wire.port;
    if (!counts_inputs || *wire.element == others.size()) {
      TomlPath element = setting;
      element.emplace_back(*wire.element);
      changes.push_back({TomlChange::Kind::remove, std::move(element), {}});
      return;
    }
    changes.push_back({TomlChange::Kind::remove, setting, {}});
    for (const WrittenWire& other : others)
      changes.push_back({TomlChange::Kind::set, {"blocks", name, other.port}, text::toml_string(other.text)});
  }

 private:
  const std::string& file_;
  const BlockLibrary& library_;
  Value root_;
};

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

std::vector<WrittenWire> wires_of(const std::vector<text::Entry>& settings,
                                  const BlockDefinition* definition) {
  std::vector<WrittenWire> wires;
  const auto add = [&](const text::Entry& entry, std::optional<std::size_t> input, const Value& value,
                       std::optional<std::size_t> element) {
    if (value.kind != Value::Kind::string && value.kind != Value::Kind::number) return;
    WrittenWire wire;
    if (definition != nullptr && input && *input < definition->inputs.size())
      wire.port = definition->inputs[*input].name;
    if (definition == nullptr) wire.port = entry.key;
    wire.key = entry.key;
    wire.element = element;
    wire.text = value.kind == Value::Kind::string ? value.text : fmt::format("{}", value.number);
    wire.signal = signal_in(wire.text);
    wire.position = value.position;
    wires.push_back(std::move(wire));
  };
  for (const text::Entry& entry : settings) {
    const bool is_list = entry.value.kind == Value::Kind::array;
    std::optional<std::size_t> input;
    bool counts_inputs = false;
    if (definition != nullptr) {
      if (definition->find_parameter(entry.key)) continue;
      input = definition->find_input(entry.key);
      if (!input && entry.key != "in") continue;
      counts_inputs = !input && definition->inputs.size() > 1;
      if (!input) input = 0;
    } else if (!is_list && entry.value.kind != Value::Kind::string) {
      continue;
    }
    if (!is_list) {
      add(entry, input, entry.value, std::nullopt);
      continue;
    }
    for (std::size_t k = 0; k < entry.value.elements.size(); ++k)
      add(entry, counts_inputs ? std::optional(k) : input, entry.value.elements[k], k);
  }
  const auto order = [&](const WrittenWire& wire) {
    return definition == nullptr ? 0 : definition->find_input(wire.port).value_or(definition->inputs.size());
  };
  std::stable_sort(wires.begin(), wires.end(),
                   [&](const WrittenWire& a, const WrittenWire& b) { return order(a) < order(b); });
  for (std::size_t k = 1; k < wires.size(); ++k) {
    if (wires[k].port == wires[k - 1].port) wires[k].term = wires[k - 1].term + 1;
  }
  return wires;
}

DiagramEdit::DiagramEdit(std::string text, std::string file, const BlockLibrary& library)
    : text_(std::move(text)), file_(std::move(file)), library_(&library) {}

std::string DiagramEdit::add(const std::string& type, const std::string& name) {
  const Content content(text_, file_, *library_);
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
    const auto wire_from_it = [&](const Content& content) -> std::optional<Changes> {
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
    Content(text, file_, *library_).block(block);
    while (const auto changes = wire_from_it(Content(text, file_, *library_)))
      text = text::edit_toml(text, file_, *changes);
  }
  const Content content(text, file_, *library_);
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
  const Content content(text_, file_, *library_);
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
  const auto rename_key = [&](const Value* table, const TomlPath& path, const std::string& key,
                              const std::string& to) {
    if (table == nullptr || table->find(key) == nullptr) return;
    TomlPath entry = path;
    entry.emplace_back(key);
    changes.push_back({TomlChange::Kind::rename, std::move(entry), to});
  };
  rename_key(content.find_table("layout"), {"layout"}, block, name);
  if (const Value* const run = content.find_table("run")) {
    if (const Value* const tolerances = run->find("tolerances")) {
      for (const text::Entry& entry : tolerances->entries) {
        if (block_of(entry.key) == block)
          rename_key(tolerances, {"run", "tolerances"}, entry.key, with_other_name(entry.key, block, name));
      }
    }
  }
  text::Diagnostics ignored;
  const Diagram diagram = parse_diagram(text_, file_, ignored);
  for (const Expectation& expectation : diagram.expectations) {
    if (diagram.outputs.empty() && block_of(expectation.output) == block)
      rename_key(content.find_table("expect"), {"expect"}, expectation.text,
                 name + expectation.text.substr(block.size()));
  }
  rename_key(content.find_table("blocks"), {"blocks"}, block, name);
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::connect(const std::string& signal, const std::string& block, const std::string& port,
                          double weight) {
  const Content content(text_, file_, *library_);
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
  const Content content(text_, file_, *library_);
  Changes changes;
  content.cut(block, content.wire(block, port, term), changes);
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::weigh(const std::string& block, const std::string& port, std::size_t term, double weight) {
  const Content content(text_, file_, *library_);
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
  const Content content(text_, file_, *library_);
  const Value& found = content.block(block);
  const std::string written = trimmed_value(value);
  if (written.empty()) {
    if (found.find(key) != nullptr)
      text_ = text::edit_toml(text_, file_, {{TomlChange::Kind::remove, {"blocks", block, key}, {}}});
    return;
  }
  const bool is_word = key == "label" || key == "type";
  text_ = text::edit_toml(text_, file_,
                          {{TomlChange::Kind::set,
                            {"blocks", block, key},
                            is_word ? text::toml_string(written) : value_as_toml(written)}});
}

void DiagramEdit::set_head(const std::string& path, const std::string& value) {
  const auto dot = path.find('.');
  TomlPath entry;
  if (dot != std::string::npos) entry.emplace_back(path.substr(0, dot));
  entry.emplace_back(dot == std::string::npos ? path : path.substr(dot + 1));
  const std::string written = trimmed_value(value);
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
                                        : value_as_toml(written)}});
}

void DiagramEdit::place(const std::vector<BlockPlace>& places) {
  const Content content(text_, file_, *library_);
  Changes changes;
  changes.reserve(places.size());
  for (const BlockPlace& at : places) {
    content.block(at.name);
    changes.push_back({TomlChange::Kind::set, {"layout", at.name}, fmt::format("[{}, {}]", at.x, at.y)});
  }
  text_ = text::edit_toml(text_, file_, changes);
}

void DiagramEdit::show(const std::string& output, const std::string& signal) {
  const Content content(text_, file_, *library_);
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
