// SPDX-License-Identifier: MIT
#include <oblique/machine/mode_control.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>
#include <oblique/network/assembly/network.h>
#include <oblique/network/program/program.h>
#include <oblique/solve/static_test.h>

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

/// Appends a comparator of `what` with a half; its output.
diagram::SignalRef compare_with_half(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library,
                                     const std::string& name, diagram::FlatInput what,
                                     const text::Place& place) {
  diagram::FlatBlock line = element(library, Role::comparator, free_name(name, paths_of(flat)), place);
  what.constant -= 0.5;
  for (std::size_t port = 0; port < line.inputs.size(); ++port) {
    if (line.definition->inputs[port].sum) line.inputs[port] = what;
  }
  flat.blocks.push_back(std::move(line));
  return {flat.blocks.size() - 1, 0};
}

/// Each line that is no logic gets a comparator, one for all groups that it controls.
void wire_mode_lines(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library) {
  std::map<std::pair<std::size_t, std::size_t>, diagram::SignalRef> made;
  for (diagram::FlatGroup& group : flat.timeline.groups) {
    for (const auto& [line, what] : {std::pair(&group.initial, "initial"), std::pair(&group.hold, "hold")}) {
      if (!*line || is_mode_line(flat.blocks[(*line)->block])) continue;
      const text::Place place = flat.blocks[(*line)->block].place;
      const auto [compared, is_new] = made.try_emplace({(*line)->block, (*line)->output}, **line);
      if (is_new)
        compared->second =
            compare_with_half(flat, library, group.name + "_" + what, {{{1, **line}}, 0}, place);
      *line = compared->second;
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

/// What a store holds from the start on, until it tracks, where that is something else than its input then,
/// which is where an integrator starts that is to follow it. Throws RealiseError for one that charges its
/// capacitor at the start, from nothing, and is to begin elsewhere.
std::optional<double> held_at_start(const diagram::FlatDiagram& flat, const diagram::FlatBlock& store,
                                    const std::unordered_map<std::string, double>& at_start) {
  const auto value = [&](const diagram::FlatInput& input) {
    double sum = input.constant;
    for (const diagram::FlatTerm& term : input.terms)
      sum += term.weight * at_start.at(flat.signal_name(term.signal));
    return sum;
  };
  const double in = value(store.inputs[0]), initial = parameter_of(store, "initial");
  const bool tracks = value(store.inputs[1]) > 0.5;
  if (tracks && parameter_of(store, "acquisition_time") == 0) return std::nullopt;
  const double starts = tracks ? 0 : in;
  constexpr double kEqual = 1e-9;
  if (std::abs(starts - initial) <= kEqual * std::max(std::abs(in), std::abs(initial))) return std::nullopt;
  if (!tracks) return initial;
  throw RealiseError(text::Diagnostic{
      store.place,
      fmt::format("'{}' starts at {:.6g}, and an integrator that charges its capacitor would start at 0",
                  store.path, initial),
      "a start that an integrator in track and store has", "give it initial = 0"});
}

/// Appends a comparator that the first rise of a mode line turns over, and nothing back; its output.
diagram::SignalRef latch(diagram::SignalRef line, const std::string& name, const text::Place& place,
                         diagram::FlatDiagram& flat, const diagram::BlockLibrary& library) {
  diagram::FlatBlock latched = element(library, Role::comparator, free_name(name, paths_of(flat)), place);
  latched.parameters[latched.definition->find_parameter("hysteresis").value()] = 1;
  latched.choose_behaviour();
  for (std::size_t port = 0; port < latched.inputs.size(); ++port) {
    if (latched.definition->inputs[port].sum) latched.inputs[port] = {{{1, line}}, -0.4};
  }
  flat.blocks.push_back(std::move(latched));
  return {flat.blocks.size() - 1, 0};
}

/// What is at `initial` while the latch is low, and at `input` from then on: the latch times their
/// difference.
diagram::FlatInput beginning_with(double initial, diagram::FlatInput input, diagram::SignalRef latched,
                                  const std::string& name, const text::Place& place,
                                  diagram::FlatDiagram& flat, const diagram::BlockLibrary& library) {
  diagram::FlatBlock change = element(library, Role::multiplier, free_name(name, paths_of(flat)), place);
  input.constant -= initial;
  change.inputs = {{{{1, latched}}, 0}, std::move(input)};
  flat.blocks.push_back(std::move(change));
  return {{{1, {flat.blocks.size() - 1, 0}}}, initial};
}

/// Whether it is a store that tracks its first input while the second, `track`, is high, unless a user has
/// put a block of that kind in its place.
bool may_be_store(const diagram::FlatBlock& block) {
  const diagram::BlockDefinition& definition = *block.definition;
  return definition.needs.size() == 1 && definition.needs.front().kind == diagram::ElementKind::store &&
         definition.find_input("track") == std::optional<std::size_t>(1);
}

/// Puts integrators in the place of stores.
void make_stores(diagram::FlatDiagram& flat, const diagram::BlockLibrary& library) {
  if (std::none_of(flat.blocks.begin(), flat.blocks.end(), may_be_store)) return;
  const diagram::BlockLibrary shipped = diagram::BlockLibrary::shipped();
  const auto is_store = [&](const diagram::FlatBlock& block) {
    const diagram::BlockDefinition* const original = shipped.find(block.definition->name);
    return may_be_store(block) && original != nullptr && original->text == block.definition->text;
  };
  std::unordered_map<std::string, double> at_start;
  for (const solve::StaticReading& reading :
       solve::static_test(network::Program(network::assemble(flat)), flat.file))
    at_start[reading.signal] = reading.output;
  std::set<std::string> names{"main", "mode", "for", "until"};
  for (const diagram::FlatGroup& group : flat.timeline.groups) names.insert(group.name);
  if (flat.timeline.groups.empty()) flat.timeline.groups.push_back({"main", {}, {}});
  std::map<std::pair<std::size_t, std::size_t>, diagram::SignalRef> latches;  // of each mode line
  const std::size_t n = flat.blocks.size();
  for (std::size_t b = 0; b < n; ++b) {
    if (!is_store(flat.blocks[b])) continue;
    const diagram::FlatBlock store = flat.blocks[b];
    const std::optional<double> held = held_at_start(flat, store, at_start);
    std::string name = store.path;
    std::replace(name.begin(), name.end(), '.', '_');
    name = free_name(name, names);
    names.insert(name);
    diagram::FlatBlock integrator = element(library, Role::integrator, store.path, store.place);
    integrator.tolerance = store.tolerance;
    integrator.group = flat.timeline.groups.size();
    integrator.parameters[integrator.definition->find_parameter("charging").value()] =
        parameter_of(store, "acquisition_time");
    integrator.choose_behaviour();
    integrator.inputs[integrator.definition->find_input("start").value()] = store.inputs[0];
    flat.blocks[b] = std::move(integrator);
    const diagram::FlatInput& track = store.inputs[1];
    const bool is_signal = track.constant == 0 && track.terms.size() == 1 && track.terms.front().weight == 1;
    const bool is_line = is_signal && (!held || is_mode_line(flat.blocks[track.terms.front().signal.block]));
    const diagram::SignalRef line =
        is_line ? track.terms.front().signal
                : compare_with_half(flat, library, name + "_initial", track, store.place);
    if (held) {
      const auto [latched, is_new] = latches.try_emplace({line.block, line.output}, line);
      if (is_new) latched->second = latch(line, name + "_tracked", store.place, flat, library);
      diagram::FlatInput input = beginning_with(*held, store.inputs[0], latched->second, name + "_change",
                                                store.place, flat, library);
      flat.blocks[b].inputs[flat.blocks[b].definition->find_input("start").value()] = std::move(input);
    }
    flat.timeline.groups.push_back({name, line, {}});
    for (diagram::FlatPhase& phase : flat.timeline.phases)
      phase.modes.push_back(diagram::OperatingMode::operate);
  }
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
  std::vector<std::string> sources;
  const bool has_groups = !flat.timeline.groups.empty();
  if (has_groups) sources = keep_operating(flat, own);
  make_stores(flat, library);
  if (flat.timeline.groups.empty()) return;
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
        has_groups ? "choose another machine, or take [groups] or the [timeline] out"
                   : "choose another machine: a store is an integrator that has modes of its own"});
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
