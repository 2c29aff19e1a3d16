// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/parameter_numbers.h>

namespace oblique::network {

ParameterNumbers::ParameterNumbers(const diagram::FlatDiagram& flat) {
  first_.reserve(flat.blocks.size());
  first_input_.reserve(flat.blocks.size());
  for (const diagram::FlatBlock& block : flat.blocks) {
    first_.push_back(size_);
    first_input_.push_back(static_cast<std::uint32_t>(first_wire_.size()));
    size_ += static_cast<std::uint32_t>(block.parameters.size());
    for (const diagram::FlatInput& input : block.inputs) {
      first_wire_.push_back(size_);
      size_ += static_cast<std::uint32_t>(input.terms.size());
    }
  }
}

std::vector<double> parameter_values(const diagram::FlatDiagram& flat) {
  std::vector<double> values;
  for (const diagram::FlatBlock& block : flat.blocks) {
    values.insert(values.end(), block.parameters.begin(), block.parameters.end());
    for (const diagram::FlatInput& input : block.inputs) {
      for (const diagram::FlatTerm& term : input.terms) values.push_back(term.weight);
    }
  }
  return values;
}

}  // namespace oblique::network
