// SPDX-License-Identifier: MIT
#include <oblique/diagram/edit/edited_text.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/diagram.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {

void refuse_edit(const std::string& file, std::string what, std::string expected, text::Remedy remedy) {
  throw DiagramError(text::Diagnostic{{file, {}}, std::move(what), std::move(expected), std::move(remedy)});
}

const text::Value* EditedText::find_table(const char* name) const {
  const text::Value* const table = root_.find(name);
  return table != nullptr && table->kind == text::Value::Kind::table ? table : nullptr;
}

std::vector<std::string> EditedText::block_names() const {
  std::vector<std::string> names;
  if (const text::Value* const blocks = find_table("blocks")) {
    names.reserve(blocks->entries.size());
    for (const text::Entry& entry : blocks->entries) names.push_back(entry.key);
  }
  return names;
}

const text::Value* EditedText::find_block(const std::string& name) const {
  const text::Value* const blocks = find_table("blocks");
  return blocks == nullptr ? nullptr : blocks->find(name);
}

const text::Value& EditedText::block(const std::string& name) const {
  if (const text::Value* const found = find_block(name)) return *found;
  refuse_edit(file_, fmt::format("there is no block '{}'", name), "the name of a block of this file",
              text::suggest(name, block_names()));
}

const BlockDefinition* EditedText::definition(const text::Value& block) const {
  const text::Value* const type = block.find("type");
  return type == nullptr ? nullptr : library_.find(type->text);
}

std::vector<WrittenWire> EditedText::wires(const std::string& name) const {
  const text::Value& found = block(name);
  std::vector<text::Entry> settings;
  for (const text::Entry& entry : found.entries) {
    if (entry.key != "type" && entry.key != "label") settings.push_back(entry);
  }
  return wires_of(settings, definition(found));
}

std::vector<WrittenWire> EditedText::wires(const std::string& name, const std::string& port) const {
  std::vector<WrittenWire> all = wires(name);
  std::erase_if(all, [&](const WrittenWire& wire) { return wire.port != port; });
  return all;
}

WrittenWire EditedText::wire(const std::string& name, const std::string& port, std::size_t term) const {
  const auto all = wires(name, port);
  if (term < all.size()) return all[term];
  refuse_edit(file_, fmt::format("input '{}.{}' has no wire number {}", name, port, term + 1),
              fmt::format("one of its {} wires", all.size()));
}

void EditedText::cut(const std::string& name, const WrittenWire& wire,
                     std::vector<text::TomlChange>& changes) const {
  using Kind = text::TomlChange::Kind;
  const text::TomlPath setting{"blocks", name, wire.key};
  std::vector<WrittenWire> others = wires(name);
  std::erase_if(others, [&](const WrittenWire& other) {
    return other.key != wire.key || other.element == wire.element;
  });
  if (others.empty()) {
    changes.push_back({Kind::remove, setting, {}});
    return;
  }
  const bool counts_inputs = others.front().port != wire.port || others.back().port != wire.port;
  if (!counts_inputs || *wire.element == others.size()) {
    text::TomlPath element = setting;
    element.emplace_back(*wire.element);
    changes.push_back({Kind::remove, std::move(element), {}});
    return;
  }
  changes.push_back({Kind::remove, setting, {}});
  for (const WrittenWire& other : others)
    changes.push_back({Kind::set, {"blocks", name, other.port}, text::toml_string(other.text)});
}

}  // namespace oblique::diagram
