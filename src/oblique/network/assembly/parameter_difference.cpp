// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/parameter_difference.h>

namespace oblique::network {
namespace {

bool alike(const diagram::FlatBlock& a, const diagram::FlatBlock& b) {
  return a.path == b.path && a.definition == b.definition && a.saturation == b.saturation &&
         a.points == b.points && a.formulas == b.formulas && a.polarity == b.polarity &&
         a.tolerance == b.tolerance && a.group == b.group && a.inputs.size() == b.inputs.size();
}

bool alike(const diagram::FlatInput& a, const diagram::FlatInput& b) {
  if (a.constant != b.constant || a.terms.size() != b.terms.size()) return false;
  for (std::size_t wire = 0; wire < a.terms.size(); ++wire) {
    if (!(a.terms[wire].signal == b.terms[wire].signal)) return false;
  }
  return true;
}

bool alike(const diagram::FlatTimeline& a, const diagram::FlatTimeline& b) {
  if (a.groups.size() != b.groups.size() || a.phases.size() != b.phases.size() || a.cycles != b.cycles)
    return false;
  for (std::size_t k = 0; k < a.phases.size(); ++k) {
    if (a.phases[k].modes != b.phases[k].modes || a.phases[k].duration != b.phases[k].duration) return false;
  }
  return true;
}

}  // namespace

std::optional<std::vector<std::uint32_t>> parameter_difference(const diagram::FlatDiagram& before,
                                                               const ParameterNumbers& numbers,
                                                               const diagram::FlatDiagram& now) {
  if (before.blocks.size() != now.blocks.size() || !alike(before.timeline, now.timeline)) return std::nullopt;
  std::vector<std::uint32_t> found;
  for (std::size_t b = 0; b < now.blocks.size(); ++b) {
    const diagram::FlatBlock &old = before.blocks[b], &block = now.blocks[b];
    if (!alike(old, block)) return std::nullopt;
    for (std::size_t k = 0; k < block.parameters.size(); ++k) {
      if (old.parameters[k] != block.parameters[k]) found.push_back(numbers.parameter(b, k));
    }
    for (std::size_t input = 0; input < block.inputs.size(); ++input) {
      if (!alike(old.inputs[input], block.inputs[input])) return std::nullopt;
      const auto& terms = block.inputs[input].terms;
      for (std::size_t wire = 0; wire < terms.size(); ++wire) {
        if (old.inputs[input].terms[wire].weight != terms[wire].weight)
          found.push_back(numbers.weight(b, input, wire));
      }
    }
  }
  return found;
}

}  // namespace oblique::network
