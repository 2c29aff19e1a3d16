// SPDX-License-Identifier: MIT
#include <oblique/machine/mode_control.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

/// `name`, or the next one that none of `taken` is.
std::string free_name(std::string name, const std::set<std::string>& taken) {
  while (taken.contains(name)) name += "_";
  return name;
}

std::set<std::string> paths_of(const diagram::FlatDiagram& flat) {
  std::set<std::string> paths;
  for (const diagram::FlatBlock& block : flat.blocks) paths.insert(block.path);
  return paths;
}

/// Whether a signal is that of a comparator whose larger level is 1, which no scaling moves.
bool is_mode_line(const diagram::FlatBlock& block) {
  if (block.definition->role != Role::comparator) return false;
  if (!block.definition->find_parameter("low") || !block.definition->find_parameter("high")) return false;
  return std::max(std::abs(parameter_of(block, "low")), std::abs(parameter_of(block, "high"))) == 1;
}

/// Appends a comparator of `signal` with a half, and lets `signal` be its output.
void compare_with_half(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library,
                       const std::string& name, diagram::SignalRef& signal) {
  diagram::FlatBlock line;
  line.definition = &element_block(library, Role::comparator);
  line.path = free_name(name, paths_of(flat));
  line.place = flat.blocks[signal.block].place;
  for (const diagram::ParameterDefinition& parameter : line.definition->parameters)
    line.parameters.push_back(parameter.default_value);
  line.choose_behaviour();
  for (const diagram::InputPort& input : line.definition->inputs) {
    line.inputs.push_back({{}, input.default_value.value_or(0)});
    if (input.sum) line.inputs.back() = {{{1, signal}}, -0.5};
  }
  signal = {flat.blocks.size(), 0};
  flat.blocks.push_back(std::move(line));
}

void wire_mode_lines(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library) {
  for (diagram::FlatGroup& group : flat.timeline.groups) {
    for (const auto& [line, what] : {std::pair(&group.initial, "initial"), std::pair(&group.hold, "hold")}) {
      if (*line && !is_mode_line(flat.blocks[(*line)->block]))
        compare_with_half(flat, library, group.name + "_" + what, **line);
    }
  }
}

/// The integrators of circuits that stand for blocks without modes go on operating.
std::vector<std::string> keep_operating(diagram::FlatDiagram& flat, const diagram::FlatDiagram& own) {
  const std::set<std::string> known = paths_of(own);
  std::vector<std::string> found;
  diagram::FlatTimeline& timeline = flat.timeline;
  for (diagram::FlatBlock& block : flat.blocks) {
    if (block.definition->role != Role::integrator || known.contains(block.path)) continue;
    block.group = timeline.groups.size();
    found.push_back(block.path);
  }
  const auto stops = [](const diagram::FlatPhase& phase) {
    return std::any_of(phase.modes.begin(), phase.modes.end(),
                       [](diagram::OperatingMode mode) { return mode != diagram::OperatingMode::operate; });
  };
  const bool lines = std::any_of(timeline.groups.begin(), timeline.groups.end(),
                                 [](const auto& group) { return group.initial || group.hold; });
  const bool needed = lines || std::any_of(timeline.phases.begin(), timeline.phases.end(), stops);
  if (found.empty() || !needed) {
    for (diagram::FlatBlock& block : flat.blocks) {
      if (block.group == timeline.groups.size()) block.group = 0;
    }
    return {};
  }
  std::set<std::string> names{"main", "mode", "for", "until"};
  for (const diagram::FlatGroup& group : timeline.groups) names.insert(group.name);
  timeline.groups.push_back({free_name("sources", names), {}, {}});
  for (diagram::FlatPhase& phase : timeline.phases) phase.modes.push_back(diagram::OperatingMode::operate);
  return found;
}

}  // namespace

std::optional<bool> has_mode_groups(const diagram::MachineProfile& machine) {
  for (const diagram::MachineFigure& figure : machine.figures) {
    if (figure.name != "integrators, modes") continue;
    if (figure.value.starts_with("individual")) return true;
    if (figure.value.starts_with("common")) return false;
  }
  return std::nullopt;
}

void prepare_modes(diagram::FlatDiagram& flat, const diagram::FlatDiagram& own,
                   const diagram::BlockLibrary& library, const diagram::MachineProfile& machine) {
  if (flat.timeline.groups.empty()) return;
  const std::vector<std::string> sources = keep_operating(flat, own);
  if (has_mode_groups(machine) == std::optional(false) && flat.timeline.groups.size() > 1) {
    std::vector<std::string> groups;
    for (std::size_t g = 1; g < flat.timeline.groups.size(); ++g)
      groups.push_back("'" + flat.timeline.groups[g].name + "'");
    const std::string why =
        sources.empty()
            ? fmt::format("the integrators of {} have modes of their own", fmt::join(groups, ", "))
            : fmt::format("'{}' go on while others do not operate", fmt::join(sources, "', '"));
    throw RealiseError(text::Diagnostic{
        {flat.file, {}},
        fmt::format("the machine {} has one mode for all its integrators, and {}", machine.title, why),
        "one mode for all at any time",
        "choose another machine, or take [groups] or the [timeline] out"});
  }
  wire_mode_lines(flat, library);
}

std::vector<diagram::SignalRef> mode_signals(const diagram::FlatTimeline& timeline) {
  std::vector<diagram::SignalRef> signals;
  for (const diagram::FlatGroup& group : timeline.groups) {
    if (group.initial) signals.push_back(*group.initial);
    if (group.hold) signals.push_back(*group.hold);
  }
  for (const diagram::FlatPhase& phase : timeline.phases) {
    if (phase.until) signals.push_back(phase.until->signal);
  }
  return signals;
}

void write_modes(const diagram::FlatTimeline& timeline, const std::vector<std::vector<std::string>>& members,
                 const std::vector<ModeSource>& sources, diagram::Diagram& diagram) {
  auto source = sources.begin();
  for (std::size_t g = 0; g < timeline.groups.size(); ++g) {
    diagram::ModeGroup group;
    group.name = timeline.groups[g].name;
    group.blocks = members[g];
    if (timeline.groups[g].initial) group.initial = (source++)->name;
    if (timeline.groups[g].hold) group.hold = (source++)->name;
    if (g > 0) diagram.groups.push_back(std::move(group));
  }
  diagram.timeline.cycles = timeline.cycles;
  for (const diagram::FlatPhase& flat : timeline.phases) {
    diagram::Phase phase;
    phase.mode = flat.modes.front();
    for (std::size_t g = 1; g < flat.modes.size(); ++g) {
      if (flat.modes[g] != phase.mode) phase.modes.emplace_back(timeline.groups[g].name, flat.modes[g]);
    }
    phase.duration = flat.duration;
    if (flat.until) {
      bool above = flat.until->above == (source->scale > 0);
      double threshold = flat.until->threshold / source->scale + 0.0;
      if (source->scale == 0) {  // the reference stands for a signal of nothing
        above = true;
        threshold = (flat.until->above ? 0 > flat.until->threshold : 0 < flat.until->threshold) ? 0 : 2;
      }
      phase.until = fmt::format("{} {} {}", source->name, above ? '>' : '<', threshold);
      ++source;
    }
    diagram.timeline.phases.push_back(std::move(phase));
  }
}

}  // namespace oblique::machine
