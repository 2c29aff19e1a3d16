// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include <oblique/diagram/flat_diagram.h>
#include <oblique/network/program/program.h>

namespace oblique::solve {

/// Which quantity of a diagram reads which, equation by equation. Where the form of a Program has states and
/// unknowns only, this one still knows the blocks between them.
class SignalFlow {
 public:
  /// Both must outlive this.
  SignalFlow(const diagram::FlatDiagram& diagram, const network::Program& program);
  const diagram::FlatDiagram& diagram() const { return diagram_; }

  /// The blocks on the feedback that the given states close, through elements without memory and each other:
  /// paths, in file order. With one state whose output comes back to it by no way, its own block alone.
  std::vector<std::string> members_of_loop(const std::vector<std::size_t>& states) const;

  /// ∂/∂x of the equation that defines a state or unknown x, its block's inputs held: what the element does
  /// by itself (−2π·bandwidth for a servo amplifier, 1/gain for an ideal one). `signals` are those of the
  /// program at the instant. From differences, exact to rounding where the equation is linear in x. Nothing
  /// where the name is unknown or the equation cannot be evaluated.
  std::optional<double> own_derivative(std::string_view name, double t,
                                       std::span<const double> signals) const;

 private:
  struct Quantity {
    std::size_t block;
    const diagram::Equation* equation;
    std::optional<std::size_t> state;  ///< of the program
  };

  std::optional<std::size_t> find(std::size_t block, std::string_view target) const;
  void collect_read(std::size_t quantity, const text::Expression& expression,
                    std::vector<std::uint32_t>& row) const;
  double input_value(const diagram::FlatInput& input, std::span<const double> signals) const;

  const diagram::FlatDiagram& diagram_;
  const network::Program& program_;
  std::vector<Quantity> quantities_;
  std::vector<std::size_t> first_;                        ///< quantity of each block
  std::unordered_map<std::string, std::size_t> by_name_;  ///< as states and unknowns are named
};

}  // namespace oblique::solve
