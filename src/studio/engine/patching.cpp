// SPDX-License-Identifier: MIT
#include "studio/engine/patching.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <oblique/diagram/diagram_reader.h>
#include <oblique/diagram/edit/diagram_edit.h>
#include <oblique/draw/picture/svg.h>
#include <oblique/draw/schematic/panel.h>

namespace oblique::studio {
namespace {

[[noreturn]] void refuse_step(std::string what, std::string expected) {
  throw text::ReadError(text::Diagnostic{{}, std::move(what), std::move(expected), {}});
}

/// A value as a person would write it; a text within a list or a table is quoted.
std::string written(const text::Value& value, bool is_inside = false) {
  switch (value.kind) {
    case text::Value::Kind::string:
      return is_inside ? to_text(Json(value.text)) : value.text;
    case text::Value::Kind::number:
      return fmt::format("{}", value.number);
    case text::Value::Kind::boolean:
      return value.boolean ? "true" : "false";
    case text::Value::Kind::table: {
      std::string table = "{ ";
      for (const text::Entry& entry : value.entries)
        table += (table.size() > 2 ? ", " : "") + entry.key + " = " + written(entry.value, true);
      return table + " }";
    }
    default: {
      std::string list = "[";
      for (const text::Value& element : value.elements)
        list += (list.size() > 1 ? ", " : "") + written(element, true);
      return list + "]";
    }
  }
}

/// What applies where a file says nothing.
std::string default_text(const diagram::ParameterDefinition& parameter) {
  if (parameter.points) return "points";
  if (parameter.formula) return "a formula of time";
  return fmt::format("{}", parameter.default_value);
}

Json pair_of(const Eigen::Vector2d& at) {
  return Json::array({at.x(), at.y()});
}

Json json_of(const diagram::BlockDefinition& block) {
  Json json{{"name", block.name},
            {"title", block.title},
            {"summary", block.summary},
            {"doc", block.doc},
            {"is_composite", block.is_composite()}};
  json["inputs"] = Json::array();
  for (const diagram::InputPort& input : block.inputs)
    json["inputs"].push_back({{"name", input.name},
                              {"sum", input.sum},
                              {"optional", input.default_value || !input.open_with.empty()},
                              {"doc", input.doc}});
  json["outputs"] = Json::array();
  for (const diagram::OutputPort& output : block.outputs)
    json["outputs"].push_back({{"name", output.name}, {"doc", output.doc}});
  json["parameters"] = Json::array();
  for (const diagram::ParameterDefinition& parameter : block.parameters)
    json["parameters"].push_back({{"name", parameter.name},
                                  {"default", default_text(parameter)},
                                  {"unit", parameter.unit},
                                  {"range", parameter.range()},
                                  {"doc", parameter.doc}});
  json["svg"] = draw::to_svg(draw::draw_symbol_of(block));
  return json;
}

Json json_of(const draw::PatchPanelWire& wire) {
  Json json{{"port", wire.written.port},
            {"term", wire.written.term},
            {"text", wire.written.text},
            {"signal", wire.written.signal},
            {"weight", wire.weight}};
  json["at"] = wire.at ? pair_of(*wire.at) : Json();
  return json;
}

Json json_of(const draw::PatchPanelBlock& block) {
  Json json{{"name", block.instance->name},
            {"type", block.instance->type},
            {"label", block.instance->label},
            {"known", block.definition != nullptr},
            {"is_composite", block.definition != nullptr && block.definition->is_composite()},
            {"place", {block.x, block.y}},
            {"placed", block.is_placed}};
  json["body"] = !block.body ? Json()
                             : Json::array({block.body->corner.x(), block.body->corner.y(),
                                            block.body->size.x(), block.body->size.y()});
  json["settings"] = Json::object();
  for (const text::Entry& setting : block.instance->settings)
    json["settings"][setting.key] = written(setting.value);
  json["wires"] = Json::array();
  for (const draw::PatchPanelWire& wire : block.wires) json["wires"].push_back(json_of(wire));
  json["open"] = Json::array();
  for (const draw::PatchPanelPort& port : block.open_inputs)
    json["open"].push_back({{"port", port.name}, {"at", pair_of(port.at)}});
  json["outputs"] = Json::array();
  for (const draw::PatchPanelPort& port : block.outputs)
    json["outputs"].push_back({{"signal", port.name}, {"at", pair_of(port.at)}});
  return json;
}

std::string panel_svg(const draw::Picture& picture, const Options& options) {
  const bool dark = options.word("theme").value_or("auto") == "dark";
  return draw::to_svg(picture, dark ? draw::Theme::dark : draw::Theme::automatic, 1, options.flag("data"));
}

/// One step of an edit.
class Step {
 public:
  Step(const Json& json, std::string last_added) : json_(json), last_added_(std::move(last_added)) {
    if (!json.is_object()) refuse_step("a step of an edit is no object", "an object");
  }

  std::string word(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || !found->is_string())
      refuse_step(fmt::format("a step of an edit has no '{}'", key), "a text");
    return found->get<std::string>();
  }
  /// The name of a block, or of the one that was just added.
  std::string block(const char* key) const { return json_.contains(key) ? word(key) : last_added_; }
  double number(const char* key) const {
    const auto found = json_.find(key);
    if (found == json_.end() || !found->is_number())
      refuse_step(fmt::format("a step of an edit has no '{}'", key), "a number");
    return found->get<double>();
  }
  std::size_t term() const {
    const double term = number("term");
    constexpr double kMost = 1e6;
    if (!(term >= 0 && term < kMost)) refuse_step("'term' of an edit is no number of a wire", "0 or more");
    return static_cast<std::size_t>(term);
  }
  bool has(const char* key) const { return json_.contains(key); }

  std::vector<diagram::BlockPlace> places() const {
    const auto found = json_.find("places");
    if (found == json_.end() || !found->is_array()) refuse_step("a step 'place' has no 'places'", "a list");
    std::vector<diagram::BlockPlace> places;
    places.reserve(found->size());
    for (const Json& place : *found) {
      const Step one(place, last_added_);
      const auto at = place.find("at");
      if (at == place.end() || !at->is_array() || at->size() != 2 || !(*at)[0].is_number() ||
          !(*at)[1].is_number())
        refuse_step("a place of an edit has no 'at'", "[x, y]");
      const auto rounded = [](double length) { return std::round(length * 4) / 4; };
      places.push_back(
          {one.block("name"), rounded((*at)[0].get<double>()), rounded((*at)[1].get<double>()), {}});
    }
    return places;
  }

 private:
  const Json& json_;
  std::string last_added_;
};

}  // namespace

Json catalogue(const diagram::BlockLibrary& library) {
  Json json;
  json["blocks"] = Json::array();
  for (const std::string& name : library.names()) json["blocks"].push_back(json_of(*library.find(name)));
  return json;
}

Json panel_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
              const Options& options) {
  text::Diagnostics told_elsewhere;
  const diagram::Diagram diagram = diagram::parse_diagram(text, name, told_elsewhere);
  const draw::PatchPanel panel = draw::draw_panel(diagram, library, options.word("held").value_or(""));
  Json json;
  json["svg"] = panel_svg(panel.picture, options);
  json["origin"] = pair_of(panel.origin);
  json["blocks"] = Json::array();
  for (const draw::PatchPanelBlock& block : panel.blocks) json["blocks"].push_back(json_of(block));
  json["moved"] = Json::array();
  for (const diagram::BlockPlace& place : panel.moved)
    json["moved"].push_back({{"name", place.name}, {"at", {place.x, place.y}}});
  json["lost"] = panel.lost;
  json["shown"] = Json::array();
  for (const diagram::OutputSpec& output : diagram.outputs)
    json["shown"].push_back({{"name", output.name}, {"signal", output.signal}});
  json["title"] = diagram.title;
  const text::Document document = text::parse_document(text, name);
  const text::Value* const run = document.root.find("run");
  const text::Value* const until = run == nullptr ? nullptr : run->find("until");
  json["until"] = until == nullptr ? "" : written(*until);
  return json;
}

Json inside_of(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
               const Options& options) {
  const diagram::Diagram diagram = diagram::parse_diagram(text, name);
  return {
      {"svg", panel_svg(draw::draw_inside(diagram, library, options.word("path").value_or("")), options)}};
}

Json edited(const std::string& text, const std::string& name, const diagram::BlockLibrary& library,
            const std::string& options) {
  const Json asked = Json::parse(options, nullptr, false);
  const auto steps = asked.is_object() ? asked.find("steps") : asked.end();
  if (!asked.is_object() || steps == asked.end() || !steps->is_array())
    refuse_step("an edit has no 'steps'", "a list of steps");
  diagram::DiagramEdit edit(text, name, library);
  Json json{{"text", ""}, {"added", ""}, {"renamed", Json::array()}};
  for (const Json& each : *steps) {
    const Step step(each, json["added"].get<std::string>());
    const std::string what = step.word("do");
    if (what == "add") {
      json["added"] = edit.add(step.word("type"), step.has("name") ? step.word("name") : "");
    } else if (what == "remove") {
      edit.remove(step.word("block"));
    } else if (what == "rename") {
      edit.rename(step.word("block"), step.word("name"));
      json["renamed"].push_back({step.word("block"), step.word("name")});
    } else if (what == "connect") {
      edit.connect(step.block("signal"), step.block("block"), step.word("port"),
                   step.has("weight") ? step.number("weight") : 1);
    } else if (what == "disconnect") {
      edit.disconnect(step.word("block"), step.word("port"), step.term());
    } else if (what == "weigh") {
      edit.weigh(step.word("block"), step.word("port"), step.term(), step.number("weight"));
    } else if (what == "set") {
      edit.set(step.block("block"), step.word("key"), step.word("value"));
    } else if (what == "head") {
      edit.set_head(step.word("path"), step.word("value"));
    } else if (what == "place") {
      edit.place(step.places());
    } else if (what == "show") {
      edit.show(step.word("output"), step.word("signal"));
    } else {
      refuse_step(fmt::format("an edit has no step '{}'", what),
                  "add, remove, rename, connect, disconnect, weigh, set, head, place or show");
    }
  }
  json["text"] = edit.text();
  return json;
}

}  // namespace oblique::studio
