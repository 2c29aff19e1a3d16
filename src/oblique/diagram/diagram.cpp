// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram.h>

#include <algorithm>

#include <fmt/format.h>

namespace oblique::diagram {
namespace {

bool same(const text::Value& a, const text::Value& b);

bool same_entry(const text::Entry& a, const text::Entry& b) {
  return a.key == b.key && same(a.value, b.value);
}

/// Equality without positions.
bool same(const text::Value& a, const text::Value& b) {
  return a.kind == b.kind && a.boolean == b.boolean && a.number == b.number && a.text == b.text &&
         std::equal(a.elements.begin(), a.elements.end(), b.elements.begin(), b.elements.end(), same) &&
         std::equal(a.entries.begin(), a.entries.end(), b.entries.begin(), b.entries.end(), same_entry);
}

text::Value text_value(std::string text) {
  text::Value value;
  value.kind = text::Value::Kind::string;
  value.text = std::move(text);
  return value;
}

}  // namespace

std::string_view method_name(IntegrationMethod method) {
  switch (method) {
    case IntegrationMethod::automatic:
      return "auto";
    case IntegrationMethod::bdf:
      return "bdf";
    case IntegrationMethod::adams:
      return "adams";
    case IntegrationMethod::rodas:
      return "rodas";
  }
  return "auto";
}

bool BlockInstance::operator==(const BlockInstance& other) const {
  return name == other.name && type == other.type && label == other.label &&
         std::equal(settings.begin(), settings.end(), other.settings.begin(), other.settings.end(),
                    same_entry);
}

bool BlockPlace::operator==(const BlockPlace& other) const {
  return name == other.name && x == other.x && y == other.y;
}

bool OutputSpec::operator==(const OutputSpec& other) const {
  return name == other.name && signal == other.signal && scale == other.scale && unit == other.unit &&
         offset == other.offset;
}

bool Expectation::operator==(const Expectation& other) const {
  return text == other.text && output == other.output && kind == other.kind && time == other.time &&
         value == other.value && within == other.within;
}

bool ParameterOverride::operator==(const ParameterOverride& other) const {
  return path == other.path && value == other.value;
}

bool Published::operator==(const Published& other) const {
  return kind == other.kind && author == other.author && title == other.title && in == other.in &&
         year == other.year && number == other.number && page == other.page && address == other.address &&
         machine == other.machine && subject == other.subject && picture == other.picture &&
         leads == other.leads && plot == other.plot && errata == other.errata && values == other.values;
}

bool LessonQuestion::operator==(const LessonQuestion& other) const {
  return ask == other.ask && answer == other.answer && hint == other.hint &&
         expectations == other.expectations;
}

std::string_view mode_name(OperatingMode mode) {
  switch (mode) {
    case OperatingMode::potset:
      return "potset";
    case OperatingMode::initial:
      return "initial";
    case OperatingMode::operate:
      return "operate";
    case OperatingMode::hold:
      break;
  }
  return "hold";
}

bool ModeGroup::operator==(const ModeGroup& other) const {
  return name == other.name && blocks == other.blocks && initial == other.initial && hold == other.hold;
}

bool Phase::operator==(const Phase& other) const {
  return mode == other.mode && modes == other.modes && duration == other.duration && until == other.until;
}

bool Diagram::operator==(const Diagram& other) const {
  return title == other.title && source == other.source && machine == other.machine && run == other.run &&
         groups == other.groups && timeline == other.timeline && blocks == other.blocks &&
         outputs == other.outputs && expectations == other.expectations && published == other.published &&
         lesson == other.lesson && layout == other.layout;
}

text::Entry number_setting(std::string key, double value) {
  text::Entry entry;
  entry.key = std::move(key);
  entry.value.kind = text::Value::Kind::number;
  entry.value.number = value;
  return entry;
}

text::Entry text_setting(std::string key, std::string text) {
  return {std::move(key), {}, text_value(std::move(text))};
}

text::Entry points_setting(std::string key, const text::PointTable& points) {
  const auto list = [](std::vector<text::Value> elements) {
    text::Value value;
    value.kind = text::Value::Kind::array;
    value.elements = std::move(elements);
    return value;
  };
  std::vector<text::Value> all;
  for (std::size_t i = 0; i < points.x.size(); ++i)
    all.push_back(list({number_setting({}, points.x[i]).value, number_setting({}, points.y[i]).value}));
  return {std::move(key), {}, list(std::move(all))};
}

std::string to_string(const WeightedSignal& term) {
  if (term.weight == 1) return term.signal;
  if (term.weight == -1) return "-" + term.signal;
  return fmt::format("{}*{}", term.weight, term.signal);
}

text::Entry wire_setting(std::string key, const std::vector<WeightedSignal>& terms) {
  if (terms.size() == 1) return text_setting(std::move(key), to_string(terms.front()));
  text::Entry entry;
  entry.key = std::move(key);
  entry.value.kind = text::Value::Kind::array;
  for (const WeightedSignal& term : terms) entry.value.elements.push_back(text_value(to_string(term)));
  return entry;
}

}  // namespace oblique::diagram
