// SPDX-License-Identifier: MIT
#include <oblique/diagram/edit/written_wires.h>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <oblique/diagram/edit/written_names.h>

namespace oblique::diagram {
namespace {

/// The signal that a wire names; empty where it names none or several.
std::string signal_in(const std::string& wire) {
  std::string signal;
  for (const auto& [at, name] : written_names(wire)) {
    if (name == "pi" || name == "inf") continue;
    if (!signal.empty()) return {};
    signal = name;
  }
  return signal;
}

}  // namespace

std::vector<WrittenWire> wires_of(const std::vector<text::Entry>& settings,
                                  const BlockDefinition* definition) {
  std::vector<WrittenWire> wires;
  const auto add = [&](const text::Entry& entry, std::optional<std::size_t> input, const text::Value& value,
                       std::optional<std::size_t> element) {
    if (value.kind != text::Value::Kind::string && value.kind != text::Value::Kind::number) return;
    WrittenWire wire;
    if (definition != nullptr && input && *input < definition->inputs.size())
      wire.port = definition->inputs[*input].name;
    if (definition == nullptr) wire.port = entry.key;
    wire.key = entry.key;
    wire.element = element;
    wire.text = value.kind == text::Value::Kind::string ? value.text : fmt::format("{}", value.number);
    wire.signal = signal_in(wire.text);
    wire.position = value.position;
    wires.push_back(std::move(wire));
  };
  for (const text::Entry& entry : settings) {
    const bool is_list = entry.value.kind == text::Value::Kind::array;
    std::optional<std::size_t> input;
    bool counts_inputs = false;
    if (definition != nullptr) {
      if (definition->find_parameter(entry.key)) continue;
      input = definition->find_input(entry.key);
      if (!input && entry.key != "in") continue;
      counts_inputs = !input && definition->inputs.size() > 1;
      if (!input) input = 0;
    } else if (!is_list && entry.value.kind != text::Value::Kind::string) {
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

}  // namespace oblique::diagram
