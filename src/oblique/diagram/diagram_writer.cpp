// SPDX-License-Identifier: MIT
#include <oblique/diagram/diagram_writer.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/diagram/expectations.h>
#include <oblique/diagram/lesson.h>
#include <oblique/diagram/published.h>
#include <oblique/diagram/timeline.h>
#include <oblique/text/toml_text.h>

namespace oblique::diagram {
namespace {

/// Control characters have no place in a TOML text.
bool is_control(char c) {
  return (c >= 0 && c < 0x20) || c == 0x7F;
}

/// The value of a setting: a number, a string, or lists and tables of these.
std::string value_text(const text::Value& value) {
  if (value.kind == text::Value::Kind::string) return text::toml_string(value.text);
  if (value.kind == text::Value::Kind::table) {
    std::string out = "{ ";
    for (const text::Entry& entry : value.entries)
      out += (out.size() > 2 ? ", " : "") + text::toml_key(entry.key) + " = " + value_text(entry.value);
    return out + " }";
  }
  if (value.kind != text::Value::Kind::array) return fmt::format("{}", value.number);
  std::string out = "[";
  for (const text::Value& element : value.elements) out += (out.size() > 1 ? ", " : "") + value_text(element);
  return out + "]";
}

std::string block_text(const BlockInstance& block) {
  std::string out = "{ type = " + text::toml_string(block.type);
  if (!block.label.empty()) out += ", label = " + text::toml_string(block.label);
  for (const text::Entry& setting : block.settings) {
    out += fmt::format(", {} = {}", text::toml_key(setting.key), value_text(setting.value));
  }
  return out + " }";
}

std::string output_text(const OutputSpec& output) {
  const OutputSpec usual;
  if (output.scale == usual.scale && output.unit == usual.unit && output.offset == usual.offset)
    return text::toml_string(output.signal);
  const std::string offset = output.offset == 0 ? "" : fmt::format("offset = {}, ", output.offset);
  return fmt::format("{{ signal = {}, scale = {}, {}unit = {} }}", text::toml_string(output.signal),
                     output.scale, offset, text::toml_string(output.unit));
}

/// Width of a text on a terminal, near enough: code points.
std::size_t width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

struct Line {
  std::string comment;
  std::string key;
  std::string value;
};

void write_comment(std::string_view comment, std::string& out) {
  while (!comment.empty()) {
    const std::size_t end = std::min(comment.find('\n'), comment.size());
    std::string line = "# " + std::string(comment.substr(0, end));
    std::replace_if(line.begin(), line.end(), is_control, ' ');
    while (line.back() == ' ') line.pop_back();
    out += line + "\n";
    comment.remove_prefix(std::min(end + 1, comment.size()));
  }
}

/// A table of one line an entry, the equal signs below each other.
void write_table(std::string_view name, const std::vector<Line>& lines, std::string& out) {
  if (lines.empty()) return;
  std::size_t widest = 0;
  for (const Line& line : lines) widest = std::max(widest, width(line.key));
  out += fmt::format("\n[{}]\n", name);
  for (const Line& line : lines) {
    if (!line.comment.empty()) {
      if (&line != &lines.front()) out += "\n";
      write_comment(line.comment, out);
    }
    out += line.key + std::string(widest - width(line.key), ' ') + " = " + line.value + "\n";
  }
}

}  // namespace

std::string write_layout(const std::vector<BlockPlace>& layout) {
  std::vector<Line> lines;
  lines.reserve(layout.size());
  for (const BlockPlace& place : layout)
    lines.push_back({{}, text::toml_key(place.name), fmt::format("[{}, {}]", place.x, place.y)});
  std::string out;
  write_table("layout", lines, out);
  return out;
}

std::string write_diagram(const Diagram& diagram) {
  std::string out;
  write_comment(diagram.comment, out);
  if (!diagram.comment.empty()) out += "\n";
  out += "format = \"oblique-diagram/1\"\n";
  if (!diagram.title.empty()) out += "title  = " + text::toml_string(diagram.title) + "\n";
  if (!diagram.source.empty()) out += "source = " + text::toml_string(diagram.source) + "\n";

  const RunSettings& run = diagram.run;
  write_table("machine",
              {{{}, "profile", text::toml_string(diagram.machine.profile)},
               {{}, "inverting", diagram.machine.inverting ? "true" : "false"}},
              out);
  std::vector<Line> settings{{{}, "until", fmt::format("{}", run.until)},
                             {{}, "tolerance", fmt::format("{}", run.tolerance)},
                             {{}, "method", text::toml_string(method_name(run.method))},
                             {{}, "samples", fmt::format("{}", run.samples)},
                             {{}, "max_steps", fmt::format("{}", run.max_steps)}};
  if (run.absolute_tolerance)
    settings.push_back({{}, "absolute_tolerance", fmt::format("{}", *run.absolute_tolerance)});
  if (run.max_step) settings.push_back({{}, "max_step", fmt::format("{}", *run.max_step)});
  if (!run.settle) settings.push_back({{}, "settle", "false"});
  if (!run.tolerances.empty()) {
    std::string value = "{ ";
    for (const auto& [block, tolerance] : run.tolerances)
      value += (value.size() > 2 ? ", " : "") + text::toml_string(block) + fmt::format(" = {}", tolerance);
    settings.push_back({{}, "tolerances", value + " }"});
  }
  write_table("run", settings, out);

  std::vector<Line> groups;
  for (const ModeGroup& group : diagram.groups) {
    std::string value = "{ blocks = [";
    for (const std::string& name : group.blocks)
      value += (value.back() == '[' ? "" : ", ") + text::toml_string(name);
    value += "]";
    if (!group.initial.empty()) value += ", initial = " + text::toml_string(group.initial);
    if (!group.hold.empty()) value += ", hold = " + text::toml_string(group.hold);
    groups.push_back({{}, text::toml_key(group.name), value + " }"});
  }
  write_table("groups", groups, out);
  if (!diagram.timeline.phases.empty()) {
    std::string phases = "[\n";
    for (const Phase& phase : diagram.timeline.phases) phases += "  " + to_string(phase) + ",\n";
    write_table("timeline",
                {{{}, "phases", phases + "]"}, {{}, "cycles", fmt::format("{}", diagram.timeline.cycles)}},
                out);
  }

  std::vector<Line> blocks, outputs, expectations;
  for (const BlockInstance& block : diagram.blocks) {
    blocks.push_back({block.comment, text::toml_key(block.name), block_text(block)});
  }
  for (const OutputSpec& output : diagram.outputs)
    outputs.push_back({{}, text::toml_key(output.name), output_text(output)});
  for (const auto& [key, value] : expectation_lines(diagram.expectations))
    expectations.push_back({{}, key, value});
  write_table("blocks", blocks, out);
  write_table("outputs", outputs, out);
  write_table("expect", expectations, out);
  if (diagram.published) out += write_published(*diagram.published);
  if (diagram.lesson) out += write_lesson(*diagram.lesson);
  out += write_layout(diagram.layout);
  return out;
}

}  // namespace oblique::diagram
