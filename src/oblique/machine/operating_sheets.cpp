// SPDX-License-Identifier: MIT
#include <oblique/machine/operating_sheets.h>

#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

std::string unit_of(const diagram::MachineProfile& machine) {
  return machine.unit ? "V" : "machine unit";
}

/// "for 0.1 s", "until A1 > 5 V", "for 2 s or until K1 < 5 V"
std::string end_of(const diagram::FlatPhase& phase, const std::vector<std::string>& numbers,
                   const diagram::MachineProfile& machine) {
  std::string text;
  if (std::isfinite(phase.duration)) text = fmt::format("for {:.6g} s", phase.duration);
  if (!phase.until) return text;
  return text + fmt::format("{}until {} {} {:.4g} {}", text.empty() ? "" : " or ",
                            numbers[phase.until->signal.block], phase.until->above ? '>' : '<',
                            phase.until->threshold * machine.unit.value_or(1), unit_of(machine));
}

}  // namespace

Sheet output_sheet(const diagram::FlatDiagram& diagram, const diagram::MachineProfile& machine) {
  const std::string unit = unit_of(machine);
  const std::vector<std::string> numbers = element_numbers(diagram);
  Sheet sheet{
      "outputs",
      {"output", "element", "signal", fmt::format("1 {} is", unit), fmt::format("0 {} is", unit), "unit"},
      {}};
  for (const diagram::FlatOutput& output : diagram.outputs) {
    const double scale = output.scale / machine.unit.value_or(1);
    sheet.rows.push_back({output.name, numbers[output.signal.block], diagram.signal_name(output.signal),
                          fmt::format("{:.6g}", scale + output.offset), fmt::format("{:.6g}", output.offset),
                          output.unit});
  }
  return sheet;
}

Sheet mode_sheet(const diagram::FlatDiagram& diagram, double until, const diagram::MachineProfile& machine) {
  const std::vector<std::string> numbers = element_numbers(diagram);
  const diagram::FlatTimeline& timeline = diagram.timeline;
  Sheet sheet{"modes of operation", {"group", "integrators", "initial by", "hold by"}, {}};
  for (const diagram::FlatPhase& phase : timeline.phases)
    sheet.columns.push_back(end_of(phase, numbers, machine));
  if (timeline.phases.empty()) sheet.columns.push_back(fmt::format("for {:.6g} s", until));
  const bool repeats = timeline.cycles != 1;
  if (repeats) {
    sheet.title += fmt::format(", {:g} cycles", timeline.cycles);
    sheet.columns.emplace_back("cycles");
  }

  const auto line = [&](const std::optional<diagram::SignalRef>& signal) {
    return signal ? numbers[signal->block] : std::string();
  };
  for (std::size_t g = 0; g < std::max<std::size_t>(1, timeline.groups.size()); ++g) {
    const bool all = timeline.groups.size() <= 1;
    std::vector<std::string> members;
    for (std::size_t b = 0; b < diagram.blocks.size(); ++b) {
      if (diagram.blocks[b].group == g && diagram.blocks[b].definition->role == Role::integrator)
        members.push_back(numbers[b]);
    }
    std::vector<std::string> row{
        all ? "all" : timeline.groups[g].name, fmt::format("{}", fmt::join(members, ", ")),
        all ? "" : line(timeline.groups[g].initial), all ? "" : line(timeline.groups[g].hold)};
    for (const diagram::FlatPhase& phase : timeline.phases)
      row.emplace_back(diagram::mode_name(phase.modes[g]));
    if (timeline.phases.empty()) row.emplace_back("operate");
    if (repeats) row.push_back(fmt::format("{:g}", timeline.cycles));
    sheet.rows.push_back(std::move(row));
  }
  return sheet;
}

}  // namespace oblique::machine
