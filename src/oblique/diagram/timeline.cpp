// SPDX-License-Identifier: MIT
#include <oblique/diagram/timeline.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <oblique/diagram/machine_profile.h>
#include <oblique/diagram/names.h>
#include <oblique/text/expression_parser.h>

namespace oblique::diagram {
namespace {

constexpr std::array kModes{OperatingMode::potset, OperatingMode::initial, OperatingMode::operate,
                            OperatingMode::hold};

/// The name of the group of all blocks that stand in no other.
constexpr std::string_view kMain = "main";

std::optional<OperatingMode> mode_of(const text::Value& value, const std::string& file,
                                     const std::string& what, text::Diagnostics& diagnostics) {
  std::vector<std::string> names;
  for (const OperatingMode mode : kModes) {
    if (value.kind == text::Value::Kind::string && value.text == mode_name(mode)) return mode;
    names.emplace_back(mode_name(mode));
  }
  diagnostics.add(
      {{file, value.position},
       fmt::format("{}: {} is no mode of operation", what,
                   value.kind == text::Value::Kind::string ? "'" + value.text + "'"
                                                           : std::string(text::kind_name(value.kind))),
       "potset, initial, operate or hold",
       text::suggest(value.text, names)});
  return std::nullopt;
}

/// "signal > number", taken apart.
struct Comparison {
  std::string signal;
  bool above = true;
  double threshold = 0;
};

std::optional<Comparison> read_comparison(const std::string& text, const text::Place& place,
                                          const std::string& what, const std::string& machine,
                                          text::Diagnostics& diagnostics) {
  try {
    std::size_t rest = 0;
    const text::Expression e = text::parse_expression_prefix(text, rest);
    const double unit = text::unit_factor(text, rest, unit_on(machine, "machine unit"));
    const bool above = e.kind == text::Expression::Kind::greater;
    if ((above || e.kind == text::Expression::Kind::less) &&
        e.operands[0].kind == text::Expression::Kind::name) {
      return Comparison{e.operands[0].name, above, unit * text::evaluate(e.operands[1])};
    }
    diagnostics.add({place, fmt::format("{}: '{}' does not compare a signal with a number", what, text),
                     "'SIGNAL > NUMBER' or 'SIGNAL < NUMBER'",
                     "let blocks decide what is more complicated, and compare their output with 0.5"});
  } catch (const text::ExpressionError& error) {
    diagnostics.add({place, fmt::format("{}: {}", what, error.what), error.expected, error.remedy});
  }
  return std::nullopt;
}

Phase read_phase(const std::string& file, const text::Value& value, const std::string& what,
                 const std::vector<ModeGroup>& groups, const std::string& machine,
                 text::Diagnostics& diagnostics) {
  Phase phase;
  phase.place = {file, value.position};
  text::TableReader reader(file, value, what, diagnostics);
  if (value.kind != text::Value::Kind::table) return phase;
  if (const text::Value* const mode = reader.find("mode")) {
    phase.mode = mode_of(*mode, file, what, diagnostics).value_or(phase.mode);
  } else {
    reader.report("mode", fmt::format("{} has no 'mode'", what), "potset, initial, operate or hold");
  }
  for (const ModeGroup& group : groups) {
    if (const text::Value* const mode = reader.find(group.name)) {
      if (const auto read = mode_of(*mode, file, what, diagnostics))
        phase.modes.emplace_back(group.name, *read);
    }
  }
  if (const auto until = reader.string("until")) {
    phase.until = *until;
    read_comparison(phase.until, phase.place, what, machine, diagnostics);
  }
  const auto duration = reader.quantity("for", "s");
  phase.duration = duration.value_or(std::numeric_limits<double>::infinity());
  if (duration && !(*duration > 0)) {
    reader.report("for", fmt::format("{} lasts {} s", what, *duration), "a time above 0 [s]");
  } else if (std::isinf(phase.duration) && phase.until.empty()) {
    reader.report("for", fmt::format("{} has no end", what), "'for', a time, or 'until', a condition");
  }
  reader.finish();
  return phase;
}

}  // namespace

std::vector<ModeGroup> read_groups(const std::string& file, const text::Value& table,
                                   text::Diagnostics& diagnostics) {
  std::vector<ModeGroup> groups;
  for (const text::Entry& entry : table.entries) {
    const std::string what = fmt::format("group '{}'", entry.key);
    ModeGroup group;
    group.name = entry.key;
    group.place = {file, entry.position};
    for (const std::string_view taken :
         {kMain, std::string_view("mode"), std::string_view("for"), std::string_view("until")}) {
      if (entry.key != taken) continue;
      diagnostics.add({group.place,
                       fmt::format("{}: a phase uses that key itself", what),
                       "another name than main, mode, for, until",
                       {}});
    }
    check_name(entry.key, "a group", group.place, diagnostics);
    text::Value list;  // a bare list is short for { blocks = list }
    list.kind = text::Value::Kind::table;
    list.position = entry.value.position;
    list.entries.push_back({"blocks", entry.position, entry.value});
    text::TableReader reader(file, entry.value.kind == text::Value::Kind::table ? entry.value : list, what,
                             diagnostics);
    group.blocks = reader.strings("blocks", true).value_or(std::vector<std::string>{});
    if (group.blocks.empty() && reader.table().find("blocks") == nullptr)
      reader.report("blocks", fmt::format("{} has no 'blocks'", what), "the names of blocks");
    group.initial = reader.string("initial").value_or("");
    group.hold = reader.string("hold").value_or("");
    reader.finish();
    groups.push_back(std::move(group));
  }
  return groups;
}

Timeline read_timeline(const std::string& file, const text::Value& table,
                       const std::vector<ModeGroup>& groups, const std::string& machine,
                       text::Diagnostics& diagnostics) {
  Timeline timeline;
  text::TableReader reader(file, table, "[timeline]", diagnostics);
  const text::Value* const phases = reader.find("phases");
  if (phases == nullptr || phases->kind != text::Value::Kind::array || phases->elements.empty()) {
    reader.report("phases", "[timeline] has no list of 'phases'",
                  R"(phases = [{ mode = "operate", for = "1 s" }])");
  } else {
    for (std::size_t i = 0; i < phases->elements.size(); ++i) {
      timeline.phases.push_back(read_phase(file, phases->elements[i], fmt::format("phase {}", i + 1), groups,
                                           machine, diagnostics));
    }
  }
  if (const auto cycles = reader.quantity("cycles", "1")) {
    timeline.cycles = *cycles;
    if (!(*cycles >= 1) || *cycles != std::floor(*cycles)) {
      reader.report("cycles", fmt::format("'cycles' of [timeline] is {}", *cycles),
                    "a whole number from 1 on, or inf");
    }
  }
  reader.finish();
  return timeline;
}

double duration_of(const Timeline& timeline) {
  double sum = 0;
  for (const Phase& phase : timeline.phases) sum += phase.duration;
  return sum * timeline.cycles;
}

std::string to_string(const Phase& phase) {
  std::string text = fmt::format("{{ mode = \"{}\"", mode_name(phase.mode));
  for (const auto& [group, mode] : phase.modes) text += fmt::format(", {} = \"{}\"", group, mode_name(mode));
  if (std::isfinite(phase.duration)) text += fmt::format(", for = {}", phase.duration);
  if (!phase.until.empty()) text += fmt::format(", until = \"{}\"", phase.until);
  return text + " }";
}

void lay_out_timeline(const Diagram& diagram, FlatDiagram& flat, const FindSignal& find_signal,
                      text::Diagnostics& diagnostics) {
  if (diagram.groups.empty() && diagram.timeline.phases.empty()) return;
  FlatTimeline& timeline = flat.timeline;
  timeline.cycles = diagram.timeline.cycles;
  timeline.groups.push_back({std::string(kMain), {}, {}});
  for (const ModeGroup& group : diagram.groups) {
    FlatGroup& made = timeline.groups.emplace_back();
    made.name = group.name;
    const std::string what = fmt::format("group '{}'", group.name);
    if (!group.initial.empty()) made.initial = find_signal(group.initial, group.place, what);
    if (!group.hold.empty()) made.hold = find_signal(group.hold, group.place, what);
    for (const std::string& name : group.blocks) {
      bool found = false;
      for (FlatBlock& block : flat.blocks) {
        if (block.path != name && !block.path.starts_with(name + ".")) continue;
        found = true;
        if (block.group != 0) {
          diagnostics.add({group.place,
                           fmt::format("{}: '{}' is in group '{}' already", what, name,
                                       timeline.groups[block.group].name),
                           "each block in one group",
                           {}});
          break;
        }
        block.group = timeline.groups.size() - 1;
      }
      if (found) continue;
      std::vector<std::string> names;
      for (const BlockInstance& block : diagram.blocks) names.push_back(block.name);
      diagnostics.add({group.place,
                       fmt::format("{}: there is no block '{}'", what, name),
                       {},
                       text::suggest(name, names)});
    }
  }
  for (std::size_t i = 0; i < diagram.timeline.phases.size(); ++i) {
    const Phase& phase = diagram.timeline.phases[i];
    FlatPhase& made = timeline.phases.emplace_back();
    made.duration = phase.duration;
    made.modes.assign(timeline.groups.size(), phase.mode);
    for (const auto& [name, mode] : phase.modes) {
      for (std::size_t g = 0; g < timeline.groups.size(); ++g) {
        if (timeline.groups[g].name == name) made.modes[g] = mode;
      }
    }
    if (phase.until.empty()) continue;
    const std::string what = fmt::format("phase {}", i + 1);
    const auto comparison =
        read_comparison(phase.until, phase.place, what, diagram.machine.profile, diagnostics);
    if (!comparison) continue;
    if (const auto signal = find_signal(comparison->signal, phase.place, what))
      made.until = FlatCondition{*signal, comparison->above, comparison->threshold};
  }
}

}  // namespace oblique::diagram
