// SPDX-License-Identifier: MIT
#include <oblique/machine/own_drains.h>

#include <algorithm>

#include <fmt/format.h>

#include <oblique/machine/realise.h>
#include <oblique/machine/role.h>

namespace oblique::machine {
namespace {

bool may_hold(const diagram::FlatTimeline& timeline, std::size_t group) {
  if (group < timeline.groups.size() && timeline.groups[group].hold) return true;
  return std::any_of(timeline.phases.begin(), timeline.phases.end(), [&](const diagram::FlatPhase& phase) {
    return group < phase.modes.size() && phase.modes[group] == diagram::OperatingMode::hold;
  });
}

}  // namespace

void wire_drains(diagram::FlatDiagram& flat) {
  text::Diagnostics diagnostics;
  for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
    diagram::FlatBlock& block = flat.blocks[b];
    if (block.definition->role != Role::integrator) continue;
    const auto value = [&](const char* name) {  // a user's own integrator may have none of them
      const auto parameter = block.definition->find_parameter(name);
      return parameter ? block.parameters[*parameter] : 0;
    };
    const double leakage = value("leakage"), drift = value("drift");
    if (leakage == 0 && drift == 0) continue;
    if (may_hold(flat.timeline, block.group)) {
      diagnostics.add(
          {block.place, fmt::format("integrator '{}' leaks or drifts while it holds too", block.path),
           "what can be wired", "take 'leakage' and 'drift' out, and feed it with what they stand for"});
      continue;
    }
    // d out/dt = polarity · rate · (1 + tolerance)/(1 + capacitor tolerance) · Σ in + drift − leakage · out
    const double fed = block.polarity * parameter_of(block, "rate") * (1 + value("tolerance")) /
                       (1 + value("capacitor_tolerance"));
    for (std::size_t port = 0; port < block.inputs.size(); ++port) {
      if (!block.definition->inputs[port].sum) continue;
      if (leakage != 0) block.inputs[port].terms.push_back({-leakage / fed, {b, 0}});
      block.inputs[port].constant += drift / fed;
    }
    for (const char* const name : {"leakage", "drift"}) {
      if (const auto parameter = block.definition->find_parameter(name)) block.parameters[*parameter] = 0;
    }
    block.choose_behaviour();
  }
  diagnostics.throw_if_any<RealiseError>();
}

}  // namespace oblique::machine
