// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <oblique/diagram/flat_diagram.h>

namespace oblique::network {

/// The numbers by which a network knows the parameters of its diagram: those of each block in the order of
/// its definition, then the weights of the wires at its inputs.
class ParameterNumbers {
 public:
  explicit ParameterNumbers(const diagram::FlatDiagram& flat);

  std::uint32_t parameter(std::size_t block, std::size_t index) const {
    return first_[block] + static_cast<std::uint32_t>(index);
  }
  std::uint32_t weight(std::size_t block, std::size_t input, std::size_t wire) const {
    return first_wire_[first_input_[block] + input] + static_cast<std::uint32_t>(wire);
  }
  std::size_t size() const { return size_; }
  /// The block that a parameter or weight belongs to.
  std::size_t block_of(std::uint32_t number) const;

 private:
  std::vector<std::uint32_t> first_, first_input_;  ///< of each block
  std::vector<std::uint32_t> first_wire_;           ///< of each input of each block
  std::uint32_t size_ = 0;
};

/// A parameter of a flat block, or the weight of a wire at an input of one.
struct NamedParameter {
  std::size_t block = 0;
  std::optional<std::size_t> parameter;  ///< in the block's definition; nothing of a weight
  std::uint32_t number = 0;
  double value = 0;
  std::string unit;
};

/// What "c.gain" or "c.in[2]" means; nothing where no flat block has such a parameter that is a number, or
/// such a wire.
std::optional<NamedParameter> find_parameter(const diagram::FlatDiagram& flat,
                                             const ParameterNumbers& numbers, std::string_view name);

/// The values of all of them.
std::vector<double> parameter_values(const diagram::FlatDiagram& flat);

/// Gives the parameters and weights of these numbers these values; blocks may become other cases of their
/// definitions.
void set_parameters(diagram::FlatDiagram& flat, const ParameterNumbers& numbers,
                    std::span<const std::uint32_t> which, std::span<const double> values);

}  // namespace oblique::network
