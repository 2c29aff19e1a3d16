// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
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

 private:
  std::vector<std::uint32_t> first_, first_input_;  ///< of each block
  std::vector<std::uint32_t> first_wire_;           ///< of each input of each block
  std::uint32_t size_ = 0;
};

/// The values of all of them.
std::vector<double> parameter_values(const diagram::FlatDiagram& flat);

}  // namespace oblique::network
