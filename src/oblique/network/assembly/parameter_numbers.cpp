// SPDX-License-Identifier: MIT
#include <oblique/network/assembly/parameter_numbers.h>

#include <algorithm>

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

std::size_t ParameterNumbers::block_of(std::uint32_t number) const {
  return static_cast<std::size_t>(std::upper_bound(first_.begin(), first_.end(), number) - first_.begin()) -
         1;
}

namespace {

/// The number in "in[2]"; 0 where that is none.
std::size_t number_in_brackets(std::string_view text) {
  constexpr std::size_t kMost = 1'000'000;
  std::size_t number = 0;
  for (const char digit : text) {
    if (digit < '0' || digit > '9' || number > kMost) return 0;
    number = 10 * number + static_cast<std::size_t>(digit - '0');
  }
  return number;
}

}  // namespace

std::optional<NamedParameter> find_parameter(const diagram::FlatDiagram& flat,
                                             const ParameterNumbers& numbers, std::string_view name) {
  const std::size_t bracket = name.find('[');
  const std::size_t dot = name.rfind('.', bracket);
  if (dot == std::string_view::npos) return std::nullopt;
  const std::string_view rest = name.substr(dot + 1);
  for (std::size_t b = 0; b < flat.blocks.size(); ++b) {
    const diagram::FlatBlock& block = flat.blocks[b];
    if (block.path != name.substr(0, dot)) continue;
    if (bracket == std::string_view::npos) {
      const auto parameter = block.definition->find_parameter(rest);
      if (!parameter) return std::nullopt;
      const diagram::ParameterDefinition& known = block.definition->parameters[*parameter];
      if (known.points || known.formula) return std::nullopt;
      return NamedParameter{b, parameter, numbers.parameter(b, *parameter), block.parameters[*parameter],
                            known.unit};
    }
    if (!rest.ends_with(']')) return std::nullopt;
    const std::string_view port = rest.substr(0, rest.find('['));
    std::size_t number = number_in_brackets(rest.substr(port.size() + 1, rest.size() - port.size() - 2));
    // As for settings: of a block of several inputs none of which is called "in", that counts them all.
    const auto own = block.definition->find_input(port);
    for (std::size_t input = 0; input < block.inputs.size(); ++input) {
      if (own ? input != *own : port != "in") continue;
      for (std::size_t wire = 0; wire < block.inputs[input].terms.size(); ++wire) {
        if (number-- == 1)
          return NamedParameter{
              b, {}, numbers.weight(b, input, wire), block.inputs[input].terms[wire].weight, "1"};
      }
    }
    return std::nullopt;
  }
  return std::nullopt;
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

void set_parameters(diagram::FlatDiagram& flat, const ParameterNumbers& numbers,
                    std::span<const std::uint32_t> which, std::span<const double> values) {
  for (std::size_t k = 0; k < which.size(); ++k) {
    const std::size_t place = numbers.block_of(which[k]);
    diagram::FlatBlock& block = flat.blocks[place];
    std::size_t index = which[k] - numbers.parameter(place, 0);
    if (index < block.parameters.size()) {
      block.parameters[index] = values[k];
      block.choose_behaviour();
      continue;
    }
    index -= block.parameters.size();
    for (diagram::FlatInput& input : block.inputs) {
      if (index < input.terms.size()) {
        input.terms[index].weight = values[k];
        break;
      }
      index -= input.terms.size();
    }
  }
}

}  // namespace oblique::network
